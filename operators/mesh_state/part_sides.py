"""The left and right parts of a mesh, kept with its analysis so that registered meshes get the same sides."""

from typing import Any

from .schema import PART_SIDES

Sides = dict[int, tuple[int, int]]


def packed_sides(sides: Sides) -> dict[str, Any]:
    """Return the sides of the parts that a mesh shows as a group of the state."""
    return {PART_SIDES: {str(part): list(pair) for part, pair in sides.items()}}


def unpacked_sides(group: Any) -> Sides:
    """Return the sides in a group, as far as they can be understood."""
    if not hasattr(group, "to_dict"):
        return {}
    rows = {part: group[part] for part in group if part.isdecimal()}
    whole = {part: tuple(row) for part, row in rows.items() if getattr(row, "typecode", None) == "i" and len(row) == 2}
    return {int(part): row for part, row in whole.items() if row[1] in (-1, 1)}
