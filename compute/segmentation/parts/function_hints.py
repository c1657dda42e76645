"""The eigenfunction that suits a shape: its parts hold the protrusions one by one."""

from dataclasses import dataclass

import numpy as np

from ...fem.eigenbasis import Eigenbasis
from ...fields.scalar_field import diffusion_field
from ...memory import told_if_full
from ...msc.links import Links, links_of
from ...msc.morse_smale import FieldTopology
from ...surface.mesh import Floats, Ints
from ...surface.ties import evened
from ..hierarchy.levels import build_hierarchy

# Functions that are judged; the higher ones oscillate on the protrusions themselves.
JUDGED_FUNCTIONS = 8


@dataclass(frozen=True)
class FunctionHint:
    """The division of a shape by an eigenfunction at its default level.

    Attributes
    ----------
    number : int
        Of the eigenfunction, from 1.
    n_parts : int
        Parts, the body left out.
    n_held : int
        Parts that hold a protrusion; several in one part count once.
    n_protrusions : int
        Of the shape: the parts of the diffusion field.
    """

    number: int
    n_parts: int
    n_held: int
    n_protrusions: int


@told_if_full
def judge_eigenfunctions(basis: Eigenbasis, n_functions: int = JUDGED_FUNCTIONS) -> tuple[FunctionHint, ...]:
    """Return how the first eigenfunctions divide the shape, the one that suits best first.

    The first function follows the longest extent and often suits; where a shape is symmetric or compact, it has no
    extremum on many protrusions, and a later one has. The functions are taken on the vertices of the mesh, which is
    enough to count.

    Parameters
    ----------
    basis : Eigenbasis
    n_functions : int
        How many are judged.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 5.1 and Fig. 11.
    """
    mesh = basis.surface.mesh
    n_vertices = len(mesh.vertices)
    links = links_of(mesh.triangles, n_vertices)
    tips = _tips(links, mesh.vertices, diffusion_field(basis).values[:n_vertices])
    hints = [
        _hint(links, mesh.vertices, basis.functions[:n_vertices, number], tips, number + 1)
        for number in range(min(n_functions, basis.functions.shape[1]))
    ]
    return tuple(sorted(hints, key=lambda hint: (-hint.n_held, hint.n_parts, hint.number)))


def _tips(links: Links, vertices: Floats, heat: Floats) -> Ints:
    """Return the vertices at the tips of the protrusions."""
    hierarchy, _ = build_hierarchy(FieldTopology(links, vertices, heat), minima_are_features=False)
    (tree,) = hierarchy.trees
    return tree.extremum[tree.is_feature(hierarchy.default_level)]


def _hint(links: Links, vertices: Floats, values: Floats, tips: Ints, number: int) -> FunctionHint:
    even = evened(values, float(np.ptp(values)))
    hierarchy, arcs = build_hierarchy(FieldTopology(links, vertices, even), minima_are_features=True)
    level = hierarchy.default_level
    held: set[int] = set()
    n_parts = 0
    for tree, arc in zip(hierarchy.trees, arcs, strict=True):
        is_feature = tree.is_feature(level)
        n_parts += int(is_feature.sum())
        held |= set(tree.spread(np.where(is_feature, tree.part, 0))[arc[tips]].tolist()) - {0}
    return FunctionHint(number, n_parts, len(held), len(tips))
