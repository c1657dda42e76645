"""What the parts of a mesh are called and which colours they have: kept by part, whatever level is shown.

Until the user gives a part a name it is called after the part it grew out of when it was first seen, so that a name
never changes by itself: "Part 2.1" is the first part that was found in "Part 2".
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

from ... import compute
from .palette import colours_of_labels
from .state import STATE

BODY = "Body"
# Groups of the state, each keyed by the number of the part.
NUMBERS, NAMES, COLOURS = "part_numbers", "part_names", "part_colours"
TABLES = (NUMBERS, NAMES, COLOURS)


def number_parts(mesh: bpy.types.Mesh, parts: compute.Parts) -> None:
    """Give parts that were never seen before their place under the part they grow out of."""
    numbers = _table(mesh, NUMBERS)
    taken = {tuple(place) for place in numbers.values()}
    new = {}
    for part, parent in zip(parts.id.tolist(), parts.parent.tolist(), strict=True):
        if part and str(part) not in numbers:
            place = next(place for place in _places(parent) if place not in taken)
            taken.add(place)
            new[str(part)] = list(place)
    if new or NUMBERS not in mesh[STATE]:
        mesh[STATE][NUMBERS] = {**{part: list(place) for part, place in numbers.items()}, **new}


def name_of(mesh: bpy.types.Mesh, part: int) -> str:
    """Return the name of a part: the user's, or one that tells where it belongs."""
    return _name(part, _table(mesh, NAMES), _table(mesh, NUMBERS))


def rename(mesh: bpy.types.Mesh, part: int, name: str) -> None:
    """Give a part a name; an empty one brings its first name back, and one that is taken gets a number."""
    names = {other: given for other, given in _table(mesh, NAMES).items() if other != str(part)}
    name = name.strip()
    if name and name != _name(part, names, _table(mesh, NUMBERS)):
        names[str(part)] = _free_name(name, {name_of(mesh, other) for other in _known(mesh) if other != part})
    mesh[STATE][NAMES] = names


def colours(mesh: bpy.types.Mesh, n_labels: int) -> np.ndarray:
    """Return (n_labels, 4) float32 linear RGBA, row 0 the body."""
    table = colours_of_labels(n_labels)
    for part, colour in _table(mesh, COLOURS).items():
        if part.isdecimal() and int(part) < n_labels and len(colour) == 3:
            table[int(part), :3] = colour
    return table


def set_colour(mesh: bpy.types.Mesh, part: int, colour: tuple[float, float, float]) -> None:
    """Give a part a colour of its own, in linear RGB."""
    mesh[STATE][COLOURS] = {**_table(mesh, COLOURS), str(part): list(colour)}


def in_tree_order(parts: compute.Parts) -> Iterator[tuple[int, int]]:
    """Yield (row of the table of parts, depth), every part followed by those that grow out of it."""
    rows_of: dict[int, list[int]] = {}
    known = set(parts.id.tolist())
    for row, (part, parent) in enumerate(zip(parts.id.tolist(), parts.parent.tolist(), strict=True)):
        rows_of.setdefault(parent if part and parent in known else -1, []).append(row)
    # The body's own parts stand beside it, as nobody wants all of them one step in.
    beside_body = [(row, 0) for row in rows_of.pop(-1, []) + rows_of.pop(0, [])]
    waiting = beside_body[::-1]
    while waiting:
        row, depth = waiting.pop()
        yield row, depth
        waiting += [(child, depth + 1) for child in reversed(rows_of.pop(int(parts.id[row]), []))]


def _name(part: int, names: dict[str, str], numbers: dict[str, Any]) -> str:
    suffix = ""
    # Parents are numbered before their children; the limit is for tables that somebody else wrote.
    for _ in range(len(numbers) + 1):
        if str(part) in names:
            return names[str(part)] + suffix
        if part == 0:
            return BODY + suffix
        parent, number = numbers.get(str(part), (0, part))
        if parent == 0:
            return f"Part {number}{suffix}"
        part, suffix = parent, f".{number}{suffix}"
    return f"Part {part}"


def _places(parent: int) -> Iterator[tuple[int, int]]:
    number = 1
    while True:
        yield parent, number
        number += 1


def _free_name(name: str, taken: set[str]) -> str:
    candidates = [name, *(f"{name}.{number:03}" for number in range(1, len(taken) + 2))]
    return next(candidate for candidate in candidates if candidate not in taken)


def _known(mesh: bpy.types.Mesh) -> list[int]:
    return [0, *(int(part) for part in _table(mesh, NUMBERS) if part.isdecimal())]


def _table(mesh: bpy.types.Mesh, name: str) -> dict[str, Any]:
    """Return one of the tables as far as it can be understood."""
    state = mesh.get(STATE)
    group = state.get(name) if hasattr(state, "to_dict") else None
    if not hasattr(group, "to_dict"):
        return {}
    values = {part: group[part] for part in group if part.isdecimal()}
    if name == NAMES:
        return {part: value for part, value in values.items() if isinstance(value, str)}
    # Lists of numbers are read back as arrays, and nothing else is.
    n_numbers, kinds = (2, "i") if name == NUMBERS else (3, "fd")
    rows = {part: value for part, value in values.items() if getattr(value, "typecode", None) in tuple(kinds)}
    return {part: tuple(value) for part, value in rows.items() if len(value) == n_numbers}
