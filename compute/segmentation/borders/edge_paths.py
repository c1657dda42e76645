"""Borders of parts along short lines of edges near their level sets, at all levels at once.

A part is a subtree at every level, so the border of each subtree that is ever cut off is moved once, and the faces
between get another arc. The inner ones come first, and stay inside of what is around them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...fields.scalar_field import ScalarField, steepness
from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Floats, Ints, sum_by
from ..faces.arc_areas import ArcAreas
from ..faces.branches import connected_branches
from ..faces.face_graph import FaceGraph
from ..faces.part_tree import PartTree
from ..hierarchy.arc_tree import NO_ARC, ArcTree
from .creases import crease_costs
from .least_cut import STRAYING, least_cut

# How many rings of faces a border may move.
N_RINGS = 12
# A border that would take more than this share of a part away, as of a blunt one on which it is the shorter the higher
# it lies, is held back by these factors, and stays at the level set if none is enough.
MOST_LOST, HOLDS = 1 / 3, (1, 2, 4)
# How much more an edge costs that runs straight up or down the field than one along a level set: one line of edges
# costs less than a staircase.
SLANT = 2.0


@dataclass(frozen=True, eq=False)
class _FaceRows:
    """Rows of a table, by the face that each belongs to."""

    face: Ints
    n_faces: int

    @cached_property
    def _order(self) -> Ints:
        return np.argsort(self.face, kind="stable")

    @cached_property
    def _start(self) -> Ints:
        return np.concatenate([[0], np.cumsum(np.bincount(self.face, minlength=self.n_faces))])

    def of(self, faces: Ints) -> tuple[Ints, Ints]:
        """Return the rows of some faces, and which of these each belongs to."""
        counts = self._start[faces + 1] - self._start[faces]
        owner = np.repeat(np.arange(len(faces)), counts)
        step = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        return self._order[self._start[faces][owner] + step], owner


def border_costs(surface: Surface, field: ScalarField) -> Floats:
    """Return (P,) the length of the edge that each pair of neighbouring triangles shares, as far as a border counts it.

    It is longer across level sets, and shorter in creases.

    Parameters
    ----------
    surface : Surface
    field : ScalarField
        On the surface.
    """
    mesh, heights = surface.mesh, field.values[: len(surface.mesh.vertices)]
    ends = mesh.edges.vertices[mesh.edges.shared]
    length = np.linalg.norm(mesh.vertices[ends[:, 1]] - mesh.vertices[ends[:, 0]], axis=1)
    slope = steepness(mesh.vertices[mesh.triangles], heights[mesh.triangles])
    steepest = length * slope[mesh.edges.neighbours].mean(axis=1)
    rise = np.abs(heights[ends[:, 1]] - heights[ends[:, 0]])
    slant = np.minimum(1.0, np.divide(rise, steepest, out=np.zeros_like(rise), where=steepest > 0))
    return length * (1 + SLANT * slant**2) * crease_costs(surface, N_RINGS)


def along_edges(part_tree: PartTree, shares: list[ArcAreas], graph: FaceGraph, cost: Floats) -> PartTree:
    """Return a part tree whose parts end at short lines of edges near their level sets.

    Every part keeps the faces that are farthest from its borders.

    Parameters
    ----------
    part_tree : PartTree
        With the arc of each face by the greater half of it.
    shares : list of ArcAreas
        For each tree, the exact shares of the faces.
    graph : FaceGraph
    cost : (P,) float64
        What it costs if a border runs between two neighbours of the graph.

    References
    ----------
    .. [1] Chan, Esedoglu, "Aspects of Total Variation Regularized L1 Function Approximation", SIAM J. Appl. Math. 2005:
       the least sum of a set's perimeter and of its difference from a given one.
    """
    shown = [
        _moved_arcs(tree, is_end & tree.has_saddle, arc, share, graph, cost)[graph.stands_for]
        for tree, is_end, arc, share in zip(
            part_tree.trees, part_tree.ends, part_tree.arcs_of_faces, shares, strict=True
        )
    ]
    return replace(part_tree, branches=connected_branches(part_tree.arcs_of_faces, graph, shown))


def _moved_arcs(tree: ArcTree, is_end: Bools, arc: Ints, shares: ArcAreas, graph: FaceGraph, cost: Floats) -> Ints:
    """Return the arc (F,) that each face is shown in; borders at necks come last, and leave the others as they are."""
    no_end = np.zeros_like(is_end)
    moved = _Borders(tree, is_end & ~tree.is_neck, no_end, arc.copy(), shares, graph, cost).moved()
    return _Borders(tree, is_end & tree.is_neck, is_end & ~tree.is_neck, moved, shares, graph, cost).moved()


@dataclass(frozen=True, eq=False)
class _Borders:
    """The borders of the parts of a tree while they are moved; ``arc`` changes.

    Those at ``is_end`` are moved, between those at ``is_kept``, which stay.
    """

    tree: ArcTree
    is_end: Bools
    is_kept: Bools
    arc: Ints
    shares: ArcAreas
    graph: FaceGraph
    cost: Floats

    @cached_property
    def _neighbours(self) -> _FaceRows:
        return _FaceRows(self.graph.neighbours.ravel(), len(self.arc))

    @cached_property
    def _shares_of_face(self) -> _FaceRows:
        return _FaceRows(self.shares.face, len(self.arc))

    def moved(self) -> Ints:
        """Move all borders, those that are next to each other at once: what is symmetric stays so."""
        is_core, is_done = self._cores(), np.zeros(len(self.tree.parent), dtype=bool)
        depth, kept = self._depth(), self._regions(self.is_kept)
        for number in range(1, 1 + int(depth.max(initial=0))):
            ends = np.flatnonzero(depth == number).tolist()
            insides = [self.tree.subtree(end) for end in ends]
            is_taken = is_done | np.logical_or.reduce(insides)
            # What a part wins belongs to no other that is as deep; what it loses was its own.
            fixed = [
                is_done | (is_taken & ~inside) | (kept != kept[end]) for end, inside in zip(ends, insides, strict=True)
            ]
            moves = [self._move(inside, arcs, is_core) for inside, arcs in zip(insides, fixed, strict=True)]
            self._apply(ends, moves)
            is_done = is_taken
        return self.arc

    def _regions(self, is_end: Bools) -> Ints:
        """Return (A,) the number of what some ends do not divide that each arc lies in."""
        return self.tree.spread(np.where(is_end, 1 + np.arange(len(is_end)), 0))

    def _depth(self) -> Ints:
        """Return (A,) how deep the ends inside each end are nested, itself counted; 0 where none is."""
        inside, depth = np.zeros((2, len(self.is_end)), dtype=np.int64)
        for arc, parent in enumerate(self.tree.parent.tolist()):
            if self.is_end[arc]:
                depth[arc] = inside[arc] = inside[arc] + 1
            if parent != NO_ARC:
                inside[parent] = max(inside[parent], inside[arc])
        return depth

    def _apply(self, ends: list[int], moves: list[tuple[Ints, Ints]]) -> None:
        """Give faces to the parts that they were won for, where it is one alone, and take away those that were lost."""
        winners = np.bincount(np.concatenate([won for won, _ in moves]), minlength=len(self.arc))
        for end, (won, lost) in zip(ends, moves, strict=True):
            self.arc[won[winners[won] == 1]] = end
            self.arc[lost] = self.tree.parent[end]

    def _crossing(self, mark: Ints | Bools) -> Ints:
        """Return the pairs of neighbours whose arcs have different marks."""
        marks = mark[self.arc][self.graph.neighbours]
        return np.flatnonzero(marks[:, 0] != marks[:, 1])

    def _cores(self) -> Bools:
        """Mask (F,) of the faces that stay: those farthest from the borders of what is never divided."""
        region = self._regions(self.is_end | self.is_kept)
        faces, ring = self._rings(self._crossing(region))
        far = np.full(len(self.arc), N_RINGS + 1)
        far[faces] = ring
        # Faces that were not analyzed follow others, so no part can rest on them.
        far[self.graph.stands_for != np.arange(len(far))] = -1
        farthest = np.zeros(len(region) + 1, dtype=np.int64)
        np.maximum.at(farthest, region[self.arc], far)
        return np.asarray(far == farthest[region[self.arc]])

    def _rings(self, crossing: Ints) -> tuple[Ints, Ints]:
        """Return the faces near some pairs of neighbours, and how many faces lie between each and the nearest pair."""
        ring = np.full(len(self.arc), -1, dtype=np.int8)
        front, bands = np.unique(self.graph.neighbours[crossing]), []
        for number in range(N_RINGS + 1):
            ring[front] = number
            bands.append(front)
            rows, _ = self._neighbours.of(front)
            front = np.unique(self.graph.neighbours[rows // 2])
            front = front[ring[front] < 0]
        faces = np.concatenate(bands)
        return faces, ring[faces].astype(np.int64)

    def _move(self, inside: Bools, is_fixed: Bools, is_core: Bools) -> tuple[Ints, Ints]:
        """Return the faces that a subtree of arcs wins and loses where its border is short."""
        crossing = self._crossing(inside)
        if not len(crossing):
            return crossing, crossing
        band, ring = self._rings(crossing)
        arcs = self.arc[band]
        is_inside, stays = inside[arcs], is_core[band] | is_fixed[arcs] | (ring == N_RINGS)
        place = np.full(len(self.arc), -1)
        place[band] = np.arange(len(band))
        rows, _ = self._neighbours.of(band)
        pairs = rows[(rows % 2 == 0) & (place[self.graph.neighbours[rows // 2, 1]] >= 0)] // 2
        radius = self.graph.length[crossing].sum() / (2 * np.pi)
        gain = STRAYING / radius * self.graph.area[band] * (2 * self._share_inside(band, inside) - 1)
        most_lost = MOST_LOST * self.graph.area @ (inside & ~is_fixed)[self.arc]
        ends, cost = place[self.graph.neighbours[pairs]], self.cost[pairs]
        for hold in HOLDS:
            new = least_cut(ends, cost, stays & is_inside, stays & ~is_inside, hold * gain)
            if self.graph.area[band] @ (is_inside & ~new) <= most_lost:
                return band[new & ~is_inside], band[is_inside & ~new]
        return crossing[:0], crossing[:0]

    def _share_inside(self, band: Ints, inside: Bools) -> Floats:
        """Return the share of some faces that lies on the arcs inside."""
        rows, owner = self._shares_of_face.of(band)
        area = self.shares.area[rows]
        whole = sum_by(owner, area, len(band))
        part = sum_by(owner, area * inside[self.shares.arc[rows]], len(band))
        # A face of collapsed triangles has no shares that could be measured.
        return np.divide(part, whole, out=inside[self.arc[band]].astype(float), where=whole > 0)
