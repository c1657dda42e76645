"""Names and colours of the parts of a mesh: kept by part, whatever level is shown.

Until the user gives a part a name it is called after the part it grew out of when it was first seen, so that a name
never changes by itself: "Part 2.1" is the first part that was found in "Part 2".
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import compute
from .palette import PARTS, colours_of_labels
from .schema import PART_COLOURS, PART_NAMES, PART_NUMBERS, PART_SWATCHES, PIECE_NAMES

BODY = "Body"


@dataclass(frozen=True)
class PartTable:
    """Places, names and colours of the parts of a mesh, by their numbers.

    Attributes
    ----------
    places : dict of int to (int, int)
        For each part that was ever seen, the part that it grew out of and which of its parts it was, from 1.
    names : dict of int to str
        Those that the user gave, as far as their parts are shown or were made by hand.
    piece_names : dict of int to str
        The same for all pieces of the surface, by the places of their arcs: a piece has other numbers at other levels.
    colours : dict of int to (float, float, float)
        Those that the user gave, in linear RGB.
    swatches : dict of int to int
        The place in the palette of the colour that each part has otherwise.
    """

    places: dict[int, tuple[int, int]] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    piece_names: dict[int, str] = field(default_factory=dict)
    colours: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    swatches: dict[int, int] = field(default_factory=dict)

    def name_of(self, part: int) -> str:
        """Return the name of a part: the user's, or one that says where it belongs."""
        suffix = ""
        # Parents are numbered before their children; the limit is for tables that somebody else wrote.
        for _ in range(len(self.places) + 1):
            if part in self.names:
                return self.names[part] + suffix
            if part == 0:
                return BODY + suffix
            parent, number = self.places.get(part, (0, part))
            if parent == 0:
                return f"Part {number}{suffix}"
            part, suffix = parent, f".{number}{suffix}"
        return f"Part {part}"

    def colours_of(self, n_labels: int) -> NDArray[np.float32]:
        """Return (n_labels, 4) float32 linear RGBA, row 0 the body."""
        table = colours_of_labels(n_labels, self.swatches)
        for part, colour in self.colours.items():
            if part < n_labels:
                table[part, :3] = colour
        return table

    def renamed(self, part: int, name: str, piece: int | None = None) -> PartTable:
        """Return the table with a name for a part; an empty one brings its first name back, a taken one gets a number.

        "Arm" becomes "Arm.001" if another part has that name.
        """
        others = {other: given for other, given in self.names.items() if other != part}
        pieces = {other: given for other, given in self.piece_names.items() if other != piece}
        table = replace(self, names=others, piece_names=pieces)
        name = name.strip()
        if not name or name == table.name_of(part):
            return table
        taken = {*pieces.values(), *(self.name_of(other) for other in (0, *self.places) if other != part)}
        name = _free_name(name, taken)
        return replace(
            table, names={**others, part: name}, piece_names=pieces if piece is None else {**pieces, piece: name}
        )

    def with_pieces(self, pieces: Mapping[int, int]) -> PartTable:
        """Return the table with the names of parts that no piece has on theirs, given what piece each part is."""
        given = set(self.piece_names.values())
        names = {pieces[part]: name for part, name in self.names.items() if part in pieces and name not in given}
        return replace(self, piece_names=names | self.piece_names)

    def shown_as(self, pieces: Mapping[int, int], first_own: int) -> PartTable:
        """Return the table with the names of another level: those of the pieces that the parts are there.

        Parameters
        ----------
        pieces : mapping of int to int
            The piece that each part is.
        first_own : int
            Parts with this number and higher ones were made by hand; they keep their names, as the body does.
        """
        own = {part: name for part, name in self.names.items() if part == 0 or part >= first_own}
        names = {part: self.piece_names[piece] for part, piece in pieces.items() if piece in self.piece_names}
        return replace(self, names=own | names)

    def coloured(self, part: int, colour: tuple[float, float, float]) -> PartTable:
        """Return the table with a colour for a part, in linear RGB."""
        return replace(self, colours={**self.colours, part: colour})


def renumbered_table(table: PartTable, tracked: Mapping[int, int], pieces: Mapping[int, int]) -> PartTable:
    """Return a table with the numbers that parts and pieces have in another analysis; what is not there is left out.

    The other analysis has swatches of its own.
    """
    return PartTable(
        places={
            tracked[part]: (tracked[parent], number)
            for part, (parent, number) in table.places.items()
            if part in tracked and parent in tracked
        },
        names={tracked[part]: name for part, name in table.names.items() if part in tracked},
        piece_names={pieces[piece]: name for piece, name in table.piece_names.items() if piece in pieces},
        colours={tracked[part]: colour for part, colour in table.colours.items() if part in tracked},
    )


def number_parts(table: PartTable, parts: compute.Parts) -> PartTable:
    """Return a table in which parts that were never seen before have their place under the part they grow out of."""
    places, taken = dict(table.places), set(table.places.values())
    for part, parent in zip(parts.id.tolist(), parts.parent.tolist(), strict=True):
        if part and part not in places:
            places[part] = next((parent, number) for number in count(1) if (parent, number) not in taken)
            taken.add(places[part])
    return replace(table, places=places)


def with_swatches(table: PartTable, shown: compute.VisibleParts) -> PartTable:
    """Return a table in which no two parts look alike that are shown together, as far as there are colours."""
    return replace(table, swatches=compute.colour_places([shown], len(PARTS), table.swatches))


def with_more_swatches(table: PartTable, parts: compute.Parts) -> PartTable:
    """Return the table of another mesh's parts with swatches for those that are here alone; all others keep theirs."""
    shown = compute.VisibleParts(tuple(parts.id[parts.id > 0].tolist()))
    return replace(table, swatches={**with_swatches(table, shown).swatches, **table.swatches})


def packed_table(table: PartTable, before: PartTable | None = None) -> dict[str, Any]:
    """Return a table as groups of the state, only those that are not as they were before if that is given."""
    columns: dict[str, Mapping[int, Any]] = {
        PART_NUMBERS: table.places,
        PART_NAMES: table.names,
        PIECE_NAMES: table.piece_names,
        PART_COLOURS: table.colours,
    }
    swatches = {PART_SWATCHES: _flat(table.swatches)} if table.swatches else {}
    if before is not None:
        stored = {
            PART_NUMBERS: before.places,
            PART_NAMES: before.names,
            PIECE_NAMES: before.piece_names,
            PART_COLOURS: before.colours,
        }
        columns = {name: column for name, column in columns.items() if column != stored[name]}
        swatches = swatches if table.swatches != before.swatches else {}
    groups = {name: {str(part): _plain(value) for part, value in column.items()} for name, column in columns.items()}
    return {**groups, **swatches}


def unpacked_table(get: Callable[[str], Any]) -> PartTable:
    """Return a table as far as it can be understood, from a call that gives a stored group by its name."""
    places = _rows(get(PART_NUMBERS), 2, ("i",))
    names, piece_names = (
        {part: name for part, name in _by_part(get(group)).items() if isinstance(name, str)}
        for group in (PART_NAMES, PIECE_NAMES)
    )
    return replace(unpacked_colours(get), places=places, names=names, piece_names=piece_names)


def unpacked_colours(get: Callable[[str], Any]) -> PartTable:
    """Return a table with the colours alone, likewise."""
    return PartTable(colours=_rows(get(PART_COLOURS), 3, ("f", "d")), swatches=_pairs(get(PART_SWATCHES)))


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


def _free_name(name: str, taken: set[str]) -> str:
    candidates = [name, *(f"{name}.{number:03}" for number in range(1, len(taken) + 2))]
    return next(candidate for candidate in candidates if candidate not in taken)


def _flat(swatches: Mapping[int, int]) -> list[int]:
    """Return numbers and places in turn: one array is read at every redraw faster than a group is."""
    return [number for pair in swatches.items() for number in pair]


def _pairs(values: Any) -> dict[int, int]:
    """Return numbers and places from an array of both in turn; nothing else is read back."""
    flat = values.to_list() if getattr(values, "typecode", None) == "i" else []
    return dict(zip(flat[::2], flat[1::2], strict=False))


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _by_part(group: Any) -> dict[int, Any]:
    return {int(part): group[part] for part in group if part.isdecimal()} if hasattr(group, "to_dict") else {}


def _rows(group: Any, n_numbers: int, kinds: tuple[str, ...]) -> dict[int, Any]:
    """Return rows of so many numbers; lists of numbers are read back as arrays, and nothing else is."""
    arrays = {part: row for part, row in _by_part(group).items() if getattr(row, "typecode", None) in kinds}
    return {part: tuple(row) for part, row in arrays.items() if len(row) == n_numbers}
