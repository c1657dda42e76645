"""Branches: connected pieces of the arcs on the faces of the input, what every level is labelled by."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...surface.mesh import Bools, Floats, Ints, connected_pieces, sum_by
from ...surface.ties import evened
from .arc_areas import HALVED, ArcAreas
from .face_graph import FaceGraph


@dataclass(frozen=True, eq=False)
class Branches:
    """The faces of every arc of a tree, in connected pieces; B branches.

    The borders of parts that are shown may run along edges near the level sets. All else is read from the arc itself.

    Attributes
    ----------
    of_face : (F,) int32
        The branch of each face.
    arc : (B,) int64
        The arc of the tree that each branch is a piece of.
    shown : (B,) int64
        The arc whose part each branch is shown in.
    area : (B,) float64
        In the mesh's unit of length, squared.
    n_faces : (B,) int64
    borders : (P, 2) int64
        Pairs of branches that touch, each once.
    border_length : (P,) float64
    """

    of_face: NDArray[np.int32]
    arc: Ints
    shown: Ints
    area: Floats
    n_faces: Ints
    borders: Ints
    border_length: Floats


def build_branches(parents: list[Ints], shares: list[ArcAreas], graph: FaceGraph) -> tuple[Branches, ...]:
    """Give each face the deepest arc of which it has the greater half, and number the connected pieces.

    A face lies in a part if and only if more than half of its area does, at every level at once: the subtrees that
    hold more than half of a face are nested, and the face is given to the innermost.

    Parameters
    ----------
    parents : list of (A,) int64
        Parent of each arc, for each tree.
    shares : list of ArcAreas
        For each tree.
    graph : FaceGraph

    Returns
    -------
    tuple of Branches
        For each tree. The pieces are the same in all: connected faces that lie on the same arc of every tree.
    """
    n_faces = len(graph.area)
    arcs = [
        _majority_arc(parent, share, n_faces)[graph.stands_for] for parent, share in zip(parents, shares, strict=True)
    ]
    return connected_branches(arcs, graph)


def connected_branches(arcs: list[Ints], graph: FaceGraph, shown: list[Ints] | None = None) -> tuple[Branches, ...]:
    """Divide faces into connected branches, each on one arc of every tree.

    Parameters
    ----------
    arcs : list of (F,) int64
        For each tree, the arc of each face.
    graph : FaceGraph
    shown : list of (F,) int64, optional
        For each tree, the arc whose part each face is shown in; the same if None.
    """
    shown = shown or arcs
    left, right = graph.neighbours.T
    same = np.logical_and.reduce([arc[left] == arc[right] for arc in (*arcs, *shown)])
    _, first, piece = np.unique(_pieces(graph, same)[graph.stands_for], return_index=True, return_inverse=True)
    piece = piece.reshape(-1)
    borders, length = _sum_pairs(piece[graph.neighbours[~same]], graph.length[~same], len(first))
    of_face, area, count = piece.astype(np.int32), sum_by(piece, graph.area), np.bincount(piece)
    return tuple(
        Branches(of_face, arc[first], of_parts[first], area, count, borders, length)
        for arc, of_parts in zip(arcs, shown, strict=True)
    )


def divided_branches(branches: tuple[Branches, ...], code: Ints, graph: FaceGraph) -> tuple[tuple[Branches, ...], Ints]:
    """Divide branches further, so that all faces of one have the same code.

    Parameters
    ----------
    branches : tuple of Branches
    code : (F,) int64
        From 0, for each face; faces that are not analyzed stay with what they lie on as far as their code is the same.
    graph : FaceGraph

    Returns
    -------
    branches : tuple of Branches
    face : (B,) int64
        A face of each branch.
    """
    of_face = branches[0].of_face
    left, right = graph.neighbours.T
    same = (of_face[left] == of_face[right]) & (code[left] == code[right])
    piece = _pieces(graph, same)[graph.stands_for] * (1 + int(code.max(initial=0))) + code
    _, face, piece = np.unique(piece, return_index=True, return_inverse=True)
    piece = piece.reshape(-1)
    apart = piece[left] != piece[right]
    borders, length = _sum_pairs(piece[graph.neighbours[apart]], graph.length[apart], len(face))
    area, count = sum_by(piece, graph.area), np.bincount(piece)
    of_face, branch = piece.astype(np.int32), branches[0].of_face[face]
    divided = tuple(
        Branches(of_face, old.arc[branch], old.shown[branch], area, count, borders, length) for old in branches
    )
    return divided, face


def repaired_labels(labels: Ints, branches: Branches, bodies: tuple[int, ...] = (0,)) -> Ints:
    """Make every part connected: its largest piece stays, the others join the neighbour they share most border with.

    Parameters
    ----------
    labels : (B,) int64
        Label of each branch.
    branches : Branches
    bodies : tuple of int
        Parts that may be in pieces: what is left of each shell.
    """
    labels = labels.copy()
    # A piece may join another stray piece, so this is repeated; every round leaves fewer pieces.
    for _ in range(len(labels)):
        piece, is_stray = _stray_pieces(labels, branches, bodies)
        joined = _best_neighbour(labels, piece, is_stray, branches)
        if not len(joined[0]):
            break
        labels[joined[0]] = joined[1]
    return labels


def _majority_arc(parent: Ints, shares: ArcAreas, n_faces: int) -> Ints:
    """Return for each face the innermost arc whose subtree holds more than half of it; -1 for faces without shares."""
    arc_of_face = np.full(n_faces, -1)
    # A face that symmetry halves is on neither side.
    half = sum_by(shares.face, shares.area, n_faces) * (0.5 + HALVED)
    face, arc, area = shares.face, shares.arc, shares.area
    while len(face):
        (face, arc), area = _sum_rows(face, arc, area, len(parent))
        # The arc of smallest index has nothing of the face above it any more: the face is its, or it is pushed down.
        innermost = np.append(True, face[1:] != face[:-1])
        decided = innermost & ((area > half[face]) | (half[face] == 0) | (parent[arc] < 0))
        arc_of_face[face[decided]] = arc[decided]
        open_rows = arc_of_face[face] < 0
        arc = np.where(innermost, parent[arc], arc)[open_rows]
        face, area = face[open_rows], area[open_rows]
    return arc_of_face


def _sum_rows(face: Ints, arc: Ints, area: Floats, n_arcs: int) -> tuple[tuple[Ints, Ints], Floats]:
    keys, row = np.unique(face * n_arcs + arc, return_inverse=True)
    return (keys // n_arcs, keys % n_arcs), sum_by(row.reshape(-1), area)


def _sum_pairs(pairs: Ints, weight: Floats, n: int) -> tuple[Ints, Floats]:
    keys, row = np.unique(pairs.min(axis=1) * n + pairs.max(axis=1), return_inverse=True)
    return np.stack([keys // n, keys % n], axis=1), sum_by(row.reshape(-1), weight, len(keys))


def _pieces(graph: FaceGraph, same: Bools) -> Ints:
    left, right = graph.neighbours[same].T
    return connected_pieces(left, right, len(graph.area))


def _stray_pieces(labels: Ints, branches: Branches, bodies: tuple[int, ...]) -> tuple[Ints, Bools]:
    """Return the connected piece of each branch among those of its label, and which pieces are not the largest."""
    left, right = branches.borders[labels[branches.borders[:, 0]] == labels[branches.borders[:, 1]]].T
    n = len(labels)
    joined = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n))
    n_pieces, piece = connected_components(joined, directed=False)
    area = sum_by(piece, branches.area, n_pieces)
    label = np.zeros(n_pieces, dtype=np.int64)
    label[piece] = labels
    order = np.lexsort((evened(area), label))
    is_largest = np.append(label[order][1:] != label[order][:-1], True)
    is_stray = np.zeros(n_pieces, dtype=bool)
    is_stray[order[~is_largest]] = True
    return piece, is_stray & ~np.isin(label, bodies)


def _best_neighbour(labels: Ints, piece: Ints, is_stray: Bools, branches: Branches) -> tuple[Ints, Ints]:
    """Return the branches of stray pieces that have neighbours, and the label each is to take."""
    sides = np.concatenate([branches.borders, branches.borders[:, ::-1]])
    length = np.tile(branches.border_length, 2)
    outward = is_stray[piece[sides[:, 0]]] & (labels[sides[:, 0]] != labels[sides[:, 1]])
    n_labels = int(labels.max(initial=0)) + 1
    (stray, label), total = _sum_rows(piece[sides[outward, 0]], labels[sides[outward, 1]], length[outward], n_labels)
    # For each piece the row with the longest border; the smaller label among equals.
    order = np.lexsort((-label, evened(total), stray))
    best = order[np.append(stray[order][1:] != stray[order][:-1], True)] if len(order) else order
    label_of_piece = np.full(len(is_stray), -1)
    label_of_piece[stray[best]] = label[best]
    moved = np.flatnonzero(label_of_piece[piece] >= 0)
    return moved, label_of_piece[piece[moved]]
