"""The parts of a reference on another shape: transferred point by point, with the borders that the reference has."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from ...analysis.analysis import Analysis
from ...segmentation.faces.branches import connected_branches, repaired_labels
from ...segmentation.faces.face_graph import FaceGraph, face_graph
from ...segmentation.faces.part_tree import PartTree
from ...segmentation.parts.part_labels import BODY, BranchLabels, Parts, label_behind, listed_parents
from ...surface.cleaning import Surface
from ...surface.heat_smoothing import smoothed
from ...surface.mesh import Bools, Floats, Ints, TriangleMesh, sum_by
from ...surface.ties import first_largest
from ..eigenfunctions.spectral_shape import SpectralShape

# Borders are smoothed over this distance, in units of the root of the area: the samples that a map leads to lie so far
# apart.
BORDER_WIDTH = 0.03


@dataclass(frozen=True, eq=False)
class FaceLabels:
    """A label for each face, to be used like the labels of branches.

    Attributes
    ----------
    level : int
        Of the shape.
    faces : (F,) int32
    parts : Parts
        Those of the labels.
    warnings : tuple of str
        Sentences for the user.
    resting : tuple of int
        Corrections that have no effect.
    """

    level: int
    faces: NDArray[np.int32]
    parts: Parts
    warnings: tuple[str, ...] = ()
    resting: tuple[int, ...] = ()

    def of_faces(self, part_tree: PartTree) -> NDArray[np.int32]:
        """Return the label of each face, whatever branch it is on."""
        return self.faces


@dataclass(frozen=True, eq=False)
class Divisible:
    """An analyzed shape in the form in which parts are transferred to and from it; F faces.

    Attributes
    ----------
    surface : Surface
    shape : SpectralShape
    part_tree : PartTree
        Of the faces.
    graph : FaceGraph
    face : (m,) int64
        The face that each of the shape's triangles lies in.
    """

    surface: Surface
    shape: SpectralShape
    part_tree: PartTree
    graph: FaceGraph
    face: Ints

    def shares_at_points(self, labels: Ints, n_labels: int) -> Floats:
        """Return (n, n_labels) the share of the area around each point that has each label (F,)."""
        shares = self.shape.shares_at_points(labels[self.face], n_labels).toarray()
        return np.asarray(shares / np.maximum(self.shape.point_areas, np.finfo(float).tiny)[:, None])


def divisible(analysis: Analysis, shape: SpectralShape, face_of_triangle: Ints | None = None) -> Divisible:
    """Return an analyzed shape in the form in which parts are transferred to and from it.

    Parameters
    ----------
    analysis : Analysis
    shape : SpectralShape
        Of its matching basis.
    face_of_triangle : (T,) int64, optional
        The polygon each triangle of the input belongs to; the triangles themselves if None.
    """
    part_tree = analysis.part_tree(face_of_triangle)
    if face_of_triangle is None:
        face_of_triangle = np.arange(len(analysis.mesh.triangles))
    graph = face_graph(analysis.mesh, analysis.surface, face_of_triangle)
    face = face_of_triangle[shape.input_triangle]
    return Divisible(surface=analysis.surface, shape=shape, part_tree=part_tree, graph=graph, face=face)


@dataclass(frozen=True, eq=False)
class GivenParts:
    """The parts that are transferred; P parts without the body.

    Attributes
    ----------
    labels : (F,) int
        Of the reference's faces.
    id, parent, mirror : (P,) int64
    is_drawn : (P,) bool
        Whether a part was made by hand or ends at a joint: there is no feature that a target must have for it.
    shares : (n, 1 + P) float64
        Share of the area around each of the reference's points that is body, and that is each part.
    """

    labels: Ints
    id: Ints
    parent: Ints
    mirror: Ints
    is_drawn: Bools
    shares: Floats

    @property
    def highest(self) -> int:
        """The highest label."""
        return int(self.id.max(initial=BODY))


def given_parts(labels: Ints, parts: Parts, reference: Divisible) -> GivenParts:
    """Return the parts of a division of the reference's faces."""
    is_part = parts.id != BODY
    ids = parts.id[is_part]
    shares = reference.shares_at_points(labels.astype(np.int64), int(ids.max(initial=BODY)) + 1)
    return GivenParts(
        labels=labels,
        id=ids,
        parent=parts.parent[is_part],
        mirror=parts.mirror[is_part],
        is_drawn=parts.saddle[is_part] < 0,
        shares=shares[:, np.append(BODY, ids)],
    )


def transfer_labels(
    given: GivenParts, target: Divisible, point_map: Ints | None, cuts: list[Ints], level: int
) -> FaceLabels:
    """Label the faces of a target.

    Parameters
    ----------
    given : GivenParts
    target : Divisible
    point_map : (n,) int64, optional
        The reference's point that each of the target's points corresponds to; None if the faces do by their numbers.
    cuts : list of (A,) int64
        For each tree of the target, the part that is cut off at each arc: parts of the reference, which are left out
        if they are not among them, and others with higher numbers, which keep the borders of their arcs.
    level : int
        The target's.
    """
    by_arcs = label_behind(cuts, target.part_tree, level)
    if point_map is None:
        return FaceLabels(level, given.labels.astype(np.int32), _table_of_parts(given, given.labels, by_arcs, target))
    flat = by_arcs.of_faces(target.part_tree).astype(np.int64)
    present = np.append(by_arcs.parts.id, given.id[given.is_drawn])
    labels = np.where(flat > given.highest, flat, _transferred(given, target, point_map, present))
    labels = _connected(labels[target.graph.stands_for], target.graph)
    return FaceLabels(level, labels.astype(np.int32), _table_of_parts(given, labels, by_arcs, target))


def _transferred(given: GivenParts, target: Divisible, point_map: Ints, present: Ints) -> Ints:
    """Return (F,) the label that the greater part of each face has, after smoothing."""
    shape = target.shape
    shares = (given.shares @ _heirs(given, present))[point_map]
    soft = smoothed(TriangleMesh(shape.positions, shape.triangles), shares, BORDER_WIDTH)
    rows = np.repeat(target.face, 3)
    n_faces = len(target.graph.area)
    corners = coo_array((np.repeat(shape.areas, 3), (rows, shape.triangles.ravel())), shape=(n_faces, len(soft)))
    return np.append(BODY, given.id)[first_largest(corners.tocsr() @ soft)]


def _heirs(given: GivenParts, present: Ints) -> Floats:
    """Return (1 + P, 1 + P) the heirs of body and parts: themselves, or for absent ones the part they grow out of."""
    ids = np.append(BODY, given.id)
    stays = np.intersect1d(ids, np.append(BODY, present))
    parent = np.zeros(1 + given.highest, dtype=np.int64)
    parent[given.id] = np.where(np.isin(given.parent, ids), given.parent, BODY)
    heir = listed_parents(parent, stays)
    heir[stays] = stays
    return (heir[ids][:, None] == ids).astype(np.float64)


def _connected(labels: Ints, graph: FaceGraph) -> Ints:
    """Return (F,) labels of which each is in one piece, its largest; the body may be in pieces."""
    (pieces,) = connected_branches([labels], graph)
    return repaired_labels(pieces.arc, pieces)[pieces.of_face]


def _table_of_parts(given: GivenParts, labels: Ints, by_arcs: BranchLabels, target: Divisible) -> Parts:
    """Return the table of parts: origins from the arcs where these are cut off, from the reference otherwise."""
    n = 1 + max(int(labels.max(initial=BODY)), given.highest)
    parent, (extremum, saddle, mirror) = np.zeros(n, dtype=np.int64), np.full((3, n), -1)
    known = by_arcs.parts.id < n
    origin = by_arcs.parts.id[known]
    parent[origin] = by_arcs.parts.parent[known]
    extremum[origin], saddle[origin] = by_arcs.parts.extremum[known], by_arcs.parts.saddle[known]
    mirror[origin] = by_arcs.parts.mirror[known]
    parent[given.id], mirror[given.id] = given.parent, given.mirror
    area, count = sum_by(labels, target.graph.area, n), np.bincount(labels, minlength=n)
    ids = np.flatnonzero(count)
    return Parts(
        id=ids,
        parent=listed_parents(parent, ids)[ids],
        extremum=extremum[ids],
        saddle=saddle[ids],
        area=area[ids],
        n_triangles=count[ids],
        mirror=np.where(np.isin(mirror[ids], ids), mirror[ids], -1),
    )
