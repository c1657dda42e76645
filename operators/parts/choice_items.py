"""The choices of an analysis and of a division as items of lists: words of the engine, named for people."""

from collections.abc import Mapping
from typing import Any, TypeVar

from ... import compute

Item = tuple[str, str, str]
# A word of the engine; orders of elements are numbers, too.
Word = TypeVar("Word", bound=str | int)


def identifier(word: str | int) -> str:
    """Return what Blender calls a word of the engine: "NESTED" for "nested", "1" for 1."""
    return str(word).upper()


def word(words: tuple[Word, ...], chosen: str) -> Word:
    """Return the word of the engine that Blender calls so."""
    return next(word for word in words if identifier(word) == chosen)


def _items(words: tuple[str | int, ...], texts: Mapping[Any, tuple[str, str]]) -> list[Item]:
    return [(identifier(word), *texts[word]) for word in words]


MODE_ITEMS = _items(
    compute.MODES,
    {
        "nested": ("Nested", "Levels overlaid: also what lies between features, and small features inside large ones"),
        "features": ("Features", "Only what protrudes: each feature that is kept is one part, all else is body"),
    },
)
JOINTS = "Cut limbs also where they narrow on both sides, such as at wrists and ankles; nested parts only"
SHELL_ITEMS = _items(
    compute.SHELLS,
    {
        "bridged": ("Bridged", "Loose parts that prolong the largest are analyzed with it, as if they were joined"),
        "largest": ("Largest", "Only the largest is analyzed; the others take the part of what they lie on"),
        "separate": ("Each by Itself", "Each that is no detail is divided on its own, as if it were alone"),
    },
)
BORDER_ITEMS = _items(
    compute.BORDERS,
    {
        "edges": ("Edge Loops", "Parts end at short lines of edges, along edge loops where there are some nearby"),
        "exact": ("Exact", "Each face belongs to the part that holds the greater half of it"),
    },
)
ORDER_ITEMS = _items(
    compute.ORDERS,
    {
        "auto": ("Automatic", "Linear where that gives the same parts, otherwise cubic while memory allows"),
        1: ("Linear", "Fast, for large meshes"),
        2: ("Quadratic", "Between the two"),
        3: ("Cubic", "Most accurate"),
    },
)
BOUNDARY_ITEMS = _items(
    compute.BOUNDARIES,
    {
        "neumann": ("Free", "The function meets open edges at a right angle; right for most meshes"),
        "dirichlet": ("Fixed", "The function is zero at open edges; the mesh must have some"),
    },
)
# What the engine takes by a number or as values has a setting of its own beside the list.
EIGENFUNCTION, ATTRIBUTE = "EIGENFUNCTION", "ATTRIBUTE"
FIELD_ITEMS = [
    *_items(compute.FIELDS, {"diffusion": ("Diffusion", "Finds every protrusion: limbs, heads, fingers, tails")}),
    (EIGENFUNCTION, "Eigenfunction", "One vibration mode; the first runs along the longest extent"),
    (ATTRIBUTE, "Attribute", "Your own values: a float attribute of the vertices"),
]
