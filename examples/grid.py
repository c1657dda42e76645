"""Signed distances on a regular grid, and an inside whose boundary is one closed manifold.

References
----------
.. [1] Latecki, "3D Well-Composed Pictures", Graphical Models and Image Processing 59, 1997: if no two inside and no two
   outside points meet only across an edge or a corner, the boundary is a manifold.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .magnifier import Magnifiers
from .solids import Body

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

# Cells along the side of a block; the field is computed point by point only in blocks that the surface can reach.
BLOCK = 8
# Distances to squashed solids are estimates, so a block counts as reached from this many times its radius.
CAUTION = 1.25
# Each flip takes away one bad meeting and may make another; a body that needs more rounds is thinner than the grid.
MAX_REPAIRS = 50


@dataclass(frozen=True, eq=False)
class Grid:
    """Signed distances on a regular grid that is symmetric about x = 0.

    Attributes
    ----------
    origin : (3,) float64
        The first point.
    cell : float
        The distance between points.
    values : (nx, ny, nz) float32
        Negative inside.
    """

    origin: Floats
    cell: float
    values: NDArray[np.float32]


def sample(body: Body, cell: float, magnifiers: Magnifiers) -> Grid:
    """Return the distances on a grid over the magnified body, exact near its surface, of the right sign elsewhere."""
    origin, blocks = _layout(magnified_bounds(body, magnifiers), cell)
    corners = BLOCK * _lattice(*blocks)
    coarse, _ = body.distance(magnifiers.shrunk(origin + cell * (corners + 0.5 * (BLOCK - 1))))
    reached = np.abs(coarse) < CAUTION * 0.5 * np.sqrt(3.0) * BLOCK * cell
    points = origin + cell * (corners[reached][:, None] + _lattice(BLOCK, BLOCK, BLOCK))
    fine, _ = body.distance(magnifiers.shrunk(points.reshape(-1, 3)), 2.0 * cell)
    values = np.repeat(coarse[:, None].astype(np.float32), BLOCK**3, axis=1)
    values[reached] = fine.reshape(-1, BLOCK**3)
    return Grid(origin, cell, _joined(values, blocks))


def magnified_bounds(body: Body, magnifiers: Magnifiers) -> Floats:
    """(2, 3) lower and upper corner of a box around the magnified body."""
    corners = magnifiers.magnified(body.box_corners)
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def well_composed_inside(values: NDArray[np.float32]) -> Bools:
    """Return which points are inside: one piece without cavities, whose boundary is a manifold.

    Raises
    ------
    ValueError
        If the body is too thin for the grid.
    """
    inside = _largest_piece(values < 0)
    for _ in range(MAX_REPAIRS):
        weak = _weak_points(inside, np.abs(values))
        if not len(weak):
            return inside
        inside[tuple(weak.T)] ^= True
        inside = _largest_piece(inside)
    raise ValueError("Parts of the body are too thin for a mesh this coarse; ask for more vertices.")


def mixed_cells(inside: Bools) -> Bools:
    """Return which cells, one fewer than the points each way, have corners on both sides."""
    corners = [_shifted(inside, step) for step in product((0, 1), repeat=3)]
    return np.logical_or.reduce(corners) & ~np.logical_and.reduce(corners)


def _layout(bounds: Floats, cell: float) -> tuple[Floats, Ints]:
    """Return the first point of the grid and its number of blocks each way."""
    low, high = bounds
    reach = max(-low[0], high[0])
    centre = np.array([0.0, *(0.5 * (low + high))[1:]])
    size = np.array([2.0 * reach, *(high - low)[1:]])
    # Two points to spare on each side; an even number of points along x leaves the plane x = 0 between two of them.
    blocks = np.ceil((size / cell + 4.0) / BLOCK).astype(np.int64)
    return centre - 0.5 * cell * (BLOCK * blocks - 1), blocks


def _lattice(nx: int, ny: int, nz: int) -> Ints:
    """(nx ny nz, 3) all index triples, the last running fastest."""
    return np.stack(np.meshgrid(np.arange(nx), np.arange(ny), np.arange(nz), indexing="ij"), axis=-1).reshape(-1, 3)


def _joined(values: NDArray[np.float32], blocks: Ints) -> NDArray[np.float32]:
    """Return one array out of the blocks."""
    apart = values.reshape(*blocks, BLOCK, BLOCK, BLOCK)
    return np.ascontiguousarray(apart.transpose(0, 3, 1, 4, 2, 5)).reshape(BLOCK * blocks)


def _shifted(points: Bools, step: tuple[int, ...]) -> Bools:
    """Return the points at one corner of all cells."""
    return points[tuple(slice(s, n - 1 + s) for s, n in zip(step, points.shape, strict=True))]


def _largest_piece(inside: Bools) -> Bools:
    """Return the largest piece of the inside, with its cavities filled."""
    label, n_pieces = ndimage.label(inside)
    if n_pieces > 1:
        inside = label == 1 + np.argmax(np.bincount(label.ravel())[1:])
    label, n_pieces = ndimage.label(~inside)
    return label != label[0, 0, 0] if n_pieces > 1 else inside


def _weak_points(inside: Bools, depth: NDArray[np.float32]) -> Ints:
    """(n, 3) for each bad meeting of points the one of them that lies nearest to the surface."""
    meetings = [*_across_edges(inside), *_across_corners(inside)]
    chosen = [group[np.arange(len(group)), depth[tuple(group.T)].T.argmin(axis=1)] for group in meetings]
    return np.unique(np.concatenate(chosen), axis=0)


def _across_edges(inside: Bools) -> list[Ints]:
    """Return the (m, 4, 3) points of squares whose diagonals lie on different sides."""
    squares = []
    for axis in range(3):
        steps = np.delete(np.eye(3, dtype=np.int64), axis, axis=0)
        corners = np.array([0 * steps[0], steps[0], steps[1], steps[0] + steps[1]])
        a, b, c, d = (_corner_of_square(inside, corner, axis) for corner in corners)
        squares.append(np.argwhere((a == d) & (b == c) & (a != b))[:, None] + corners)
    return squares


def _corner_of_square(inside: Bools, corner: Ints, axis: int) -> Bools:
    window = [slice(step, size - 1 + step) for step, size in zip(corner, inside.shape, strict=True)]
    window[axis] = slice(None)
    return inside[tuple(window)]


def _across_corners(inside: Bools) -> list[Ints]:
    """Return the (m, 2, 3) points of cubes in which two opposite corners differ from all others."""
    corner = {step: _shifted(inside, step) for step in product((0, 1), repeat=3)}
    count = np.sum(list(corner.values()), axis=0)
    pairs = []
    for step in [(0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1)]:
        opposite = tuple(1 - s for s in step)
        same = corner[step] == corner[opposite]
        lonely = same & (count == np.where(corner[step], 2, 6))
        pairs.append(np.argwhere(lonely)[:, None] + np.array([step, opposite]))
    return pairs
