"""What a mesh remembers of its registration, and its own names and colours while it shows those of another."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import bpy

from ..messages.user_errors import Refusal
from .part_table import TABLES
from .serialization import UNREADABLE
from .state import REGISTRATION, STATE

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
    """How a mesh was matched with its reference, for the panel and for trying again.

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


def remember(
    mesh: bpy.types.Mesh, tables: dict[str, Any], match: Match, reference: bpy.types.Object | None = None
) -> None:
    """Give an analyzed mesh the names and colours in the tables of its reference, and keep its own and the match."""
    take_back(mesh)
    own = tables_of(mesh)
    _set_tables(mesh, tables)
    mesh[STATE][REGISTRATION] = {**asdict(match), OWN_TABLES: own}
    if reference is not None:
        mesh[STATE][REGISTRATION][REFERENCE_OBJECT] = reference


def take_back(mesh: bpy.types.Mesh) -> None:
    """Forget the registration, if there is one, and give the mesh its own names and colours again."""
    group = _group(mesh)
    if group is None:
        return
    own = group.get(OWN_TABLES)
    _set_tables(mesh, own.to_dict() if hasattr(own, "to_dict") else {})
    del mesh[STATE][REGISTRATION]


def read(mesh: bpy.types.Mesh) -> Match | None:
    """Return how a mesh was matched; None if it was not, or what is stored makes no sense."""
    group = _group(mesh)
    if group is None:
        return None
    reference = reference_object(mesh)
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


def reference_object(mesh: bpy.types.Mesh) -> bpy.types.Object | None:
    """Return the object that a mesh is registered to, whatever its name is by now; None if it is not known."""
    found = (_group(mesh) or {}).get(REFERENCE_OBJECT)
    return found if isinstance(found, bpy.types.Object) else None


def registered_objects(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, Match]]:
    """Yield the objects of the view that show the parts of another, with how they were matched."""
    for obj in context.view_layer.objects:
        match = read(obj.data) if obj.type == "MESH" else None
        if match is not None:
            yield obj, match


def refuse_registered(mesh: bpy.types.Mesh) -> None:
    """Raise a Refusal if the parts that a mesh shows are not those of one of its levels."""
    if _group(mesh) is not None:
        raise Refusal(NOT_ITS_OWN)


def _group(mesh: bpy.types.Mesh) -> Any:
    state = mesh.get(STATE)
    group = state.get(REGISTRATION) if hasattr(state, "to_dict") else None
    return group if hasattr(group, "to_dict") else None


def tables_of(mesh: bpy.types.Mesh) -> dict[str, Any]:
    """Return the names and colours of the parts of an analyzed mesh, as they are stored."""
    state = mesh[STATE]
    return {name: state[name].to_dict() for name in TABLES if hasattr(state.get(name), "to_dict")}


def _set_tables(mesh: bpy.types.Mesh, tables: dict[str, Any]) -> None:
    for name in TABLES:
        if name in tables:
            mesh[STATE][name] = tables[name]
        elif name in mesh[STATE]:
            del mesh[STATE][name]
