"""The places of a file that each operator may change; whatever is not named here, it may not.

All may write what is ours on the meshes that they are about. Patterns are of the last two words of a place, the kind of
data-block and what it is of it: "objects/selected".
"""

from dataclasses import dataclass
from fnmatch import fnmatchcase

from tests.blender.random_steps.belongings import Place

# What the panel lists, and what parts are shown by.
SHOWN = ("rows", "correction rows", "active part", "color")
SELECTION = ("objects/selected", "view/active")
SELECTED_ELEMENTS = ("meshes/layer .select_*",)
# Blender edits all selected objects together.
EDITED = (*SELECTED_ELEMENTS, "objects/mode")
# All that changes on a mesh whose faces are cut; what may not is told by `rules_of_cut`.
GEOMETRY = (
    "meshes/layer *",
    "meshes/faces",
    "meshes/normals",
    "meshes/user's faces",
    "shape_keys/key *",
    "objects/group *",
)


@dataclass(frozen=True)
class Reach:
    """How far an operator reaches.

    Attributes
    ----------
    writes_ours : bool
        Whether it writes what is ours on the active mesh.
    writes_others : bool
        Whether it does so on the other selected meshes too.
    active, others, anywhere : tuple of str
        Places of the user's that it changes: of the active object and its mesh, of the other selected ones, of any.
    makes, removes : tuple of str
        Kinds of data-blocks.
    """

    writes_ours: bool = True
    writes_others: bool = False
    active: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    anywhere: tuple[str, ...] = ()
    makes: tuple[str, ...] = ()
    removes: tuple[str, ...] = ()


REACH = {
    "cut": Reach(active=GEOMETRY),
    "separate": Reach(
        active=("objects/data", "objects/group *", "objects/selected"),
        makes=("objects", "meshes", "shape_keys"),
        removes=("meshes", "shape_keys"),
    ),
    "select_part": Reach(active=EDITED, others=EDITED),
    "paint_part": Reach(active=EDITED, others=EDITED),
    "pick_part": Reach(anywhere=(*SELECTION, *SELECTED_ELEMENTS, "meshes/active part")),
    "create_armature": Reach(
        active=("objects/parent", "objects/matrix", "objects/modifiers", "objects/group *", "objects/active group"),
        anywhere=SELECTION,
        makes=("objects", "armatures"),
    ),
    "create_skeleton_curves": Reach(anywhere=SELECTION, makes=("objects", "curves")),
    "trace_complex": Reach(
        anywhere=("collections/children",),
        makes=("objects", "curves", "meshes", "collections", "materials"),
        removes=("objects", "curves", "meshes"),
    ),
    "plot_diagram": Reach(anywhere=("images/*",), makes=("images",)),
    "register_selected": Reach(writes_others=True),
    **dict.fromkeys(
        ("add_point_pair", "remove_point_pair", "clear_point_pairs"),
        Reach(writes_ours=False, anywhere=("scenes/eigenparts_points",)),
    ),
    "flip_function": Reach(anywhere=("ours",)),
    "next_alternative": Reach(anywhere=("ours",)),
    "transfer": Reach(
        writes_others=True,
        others=(*GEOMETRY, *SELECTED_ELEMENTS, "meshes/slots", "meshes/user's slots", "meshes/map", "meshes/keys"),
        makes=("shape_keys",),
    ),
    # Choosing a part in the list selects its faces.
    "panel": Reach(active=SELECTED_ELEMENTS, anywhere=("scenes/eigenparts*",)),
}


@dataclass(frozen=True)
class Scope:
    """What an operator is about.

    Attributes
    ----------
    active, others : set of tuple of str
        Kind and name of the active and the other selected objects, of their meshes and of all that share these.
    ours : dict of set of str
        What is ours on each mesh and object.
    traced : set of tuple of str
        Objects that are all ours, and their data.
    """

    active: set[tuple[str, str]]
    others: set[tuple[str, str]]
    ours: dict[str, set[str]]
    traced: set[tuple[str, str]]


def beyond(action: str, scope: Scope, before: dict[Place, object], after: dict[Place, object], places: list[Place]):
    """Return those of some changed places that an action may not change."""
    reach = REACH.get(action, Reach())
    return [place for place in places if not _is_in_reach(reach, scope, place, before, after)]


def _is_in_reach(reach: Reach, scope: Scope, place: Place, before, after) -> bool:
    kind, name, what = place
    if (kind, name, "") not in before:
        return kind in reach.makes or _is_own_block(place, after)
    if (kind, name, "") not in after:
        return (kind in reach.removes and not _is_users(place, before)) or _is_own_block(place, before)
    if _is_ours(scope, place, before, after) and _is_written(reach, scope, (kind, name)):
        return True
    path = f"{kind}/{what}"
    patterns = (
        *reach.anywhere,
        *(("*",) if (kind, name) in scope.traced and reach.removes else ()),
        *(reach.active if (kind, name) in scope.active else ()),
        *(reach.others if (kind, name) in scope.others else ()),
    )
    return any(fnmatchcase(path, pattern) for pattern in patterns)


def _is_written(reach: Reach, scope: Scope, block: tuple[str, str]) -> bool:
    return (
        "ours" in reach.anywhere
        or (reach.writes_ours and block in scope.active)
        or (reach.writes_others and block in scope.others)
    )


def _is_ours(scope: Scope, place: Place, before, after) -> bool:
    kind, name, what = place
    if kind == "materials":
        return _is_own_block(place, before)
    if what in SHOWN or what.startswith("property eigenparts_"):
        return kind == "meshes"
    if what in ("slots", "layer material_index"):
        return any((kind, name, "property eigenparts_materials") in one for one in (before, after))
    ours = scope.ours.get(name, set())
    if what == "active group":
        return before[place] is None or f"group {before[place]}" in ours
    return what.removeprefix("layer ") in ours


def _is_own_block(place: Place, among: dict[Place, object]) -> bool:
    """Return whether a material is one of a part."""
    kind, name, _ = place
    return kind == "materials" and (kind, name, "property eigenparts_part") in among


def _is_users(place: Place, among: dict[Place, object]) -> bool:
    """Return whether an object carries the mark that the user gave it."""
    kind, name, _ = place
    return kind == "objects" and (kind, name, "property kept") in among
