"""The registration of a mesh as it is stored, and its own names and colours while it shows those of another."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.refusals import Refusal
from .part_table import PartTable, packed_table, unpacked_table
from .schema import REGISTRATION
from .serialization import UNREADABLE

# In the registration: the tables of parts that are the mesh's own, and the object they are registered to, which may be
# renamed; its name is kept beside it for files that the object is not in.
OWN_TABLES = "own_tables"
REFERENCE_OBJECT = "reference_object"
# Up to this confidence a matching may well be wrong.
SURE = 0.5
# More than are ever matched.
MOST_FUNCTIONS = 1000

NOT_REGISTERED = "The object is not registered; register it first."
NOT_ITS_OWN = "The mesh shows the parts of another object, which have no borders here; move its level first."


@dataclass(frozen=True)
class Match:
    """The match of a mesh with its reference, for the panel and for trying again.

    Attributes
    ----------
    reference : str
        Name of the object.
    confidence : float
        From 0 to 1; above one half means very likely right.
    order, signs : tuple of int
        For each of the reference's first functions, the one that it is here (from 1), and with which sign.
    flips : dict of str to int
        The signs that the user gave, by the number of the reference's function.
    alternative, n_alternatives : int
        Which matching is shown, 0 for the best, and how many others there are.
    mirrored, same_topology : bool
    settings : dict
        The options of the analysis.
    by_diagrams : tuple of int
        What persistence diagrams alone say of the first functions, 0 where they leave the sign open.
    """

    reference: str
    confidence: float
    order: tuple[int, ...]
    signs: tuple[int, ...]
    flips: dict[str, int]
    alternative: int
    n_alternatives: int
    mirrored: bool
    same_topology: bool
    settings: dict[str, Any]
    by_diagrams: tuple[int, ...] = ()


@dataclass(frozen=True)
class Registration:
    """The registration of a mesh.

    Attributes
    ----------
    match : Match or None
        None if what is stored makes no sense.
    reference : Object or None
        The object that the mesh is registered to, whatever its name is by now; None if it is not known.
    own_parts : PartTable
        Names and colours of the mesh's own parts.
    """

    match: Match | None
    reference: bpy.types.Object | None
    own_parts: PartTable


def packed_registration(match: Match, reference: bpy.types.Object | None, own_parts: PartTable) -> dict[str, Any]:
    """Return a registration as a group of the state; the reference is None if it is in another file."""
    group = {**asdict(match), OWN_TABLES: packed_table(own_parts)}
    return {REGISTRATION: group if reference is None else {**group, REFERENCE_OBJECT: reference}}


def unpacked_registration(group: Any) -> Registration:
    """Return the registration in a group, as far as it can be understood."""
    reference, tables = group.get(REFERENCE_OBJECT), group.get(OWN_TABLES)
    reference = reference if isinstance(reference, bpy.types.Object) else None
    own_parts = unpacked_table(tables.get) if hasattr(tables, "to_dict") else PartTable()
    return Registration(_match(group, reference), reference, own_parts)


def refuse_registered(registration: Registration | None) -> None:
    """Raise a Refusal if the parts that a mesh shows are not those of one of its levels."""
    if registration is not None:
        raise Refusal(NOT_ITS_OWN)


def _match(group: Any, reference: bpy.types.Object | None) -> Match | None:
    try:
        order, signs = (tuple(int(number) for number in group[name]) for name in ("order", "signs"))
        match = Match(
            reference=reference.name if reference is not None else str(group["reference"]),
            confidence=float(group["confidence"]),
            order=order,
            signs=signs,
            flips={str(int(number)): int(sign) for number, sign in group["flips"].to_dict().items()},
            alternative=int(group["alternative"]),
            n_alternatives=int(group["n_alternatives"]),
            mirrored=bool(group["mirrored"]),
            same_topology=bool(group["same_topology"]),
            settings=group["settings"].to_dict(),
            by_diagrams=tuple(int(number) for number in group.get("by_diagrams", ())),
        )
    except UNREADABLE:
        return None
    return match if _makes_sense(match) else None


def _makes_sense(match: Match) -> bool:
    return (
        len(match.order) == len(match.signs) <= MOST_FUNCTIONS
        and len(match.flips) <= MOST_FUNCTIONS
        and len(match.by_diagrams) <= MOST_FUNCTIONS
        and all(sign in (-1, 1) for sign in (*match.signs, *match.flips.values()))
        and 0 <= match.confidence <= 1
        and 0 <= match.alternative <= match.n_alternatives
    )


def remembered_options(match: Match) -> MatchOptions:
    """Return the options that a mesh was registered with."""
    flips = {int(number): sign for number, sign in match.flips.items()}
    return MatchOptions(flips, match.alternative, match.mirrored)
