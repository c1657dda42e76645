"""The cells of the Morse-Smale complex, in which everything flows from one minimum to one maximum."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..surface.mesh import Bools, Ints
from .links import Links


@dataclass(frozen=True, eq=False)
class Cells:
    """The pieces between the separatrices, c of them; on a closed surface twice as many as there are simple saddles.

    Attributes
    ----------
    of_triangle : (m,) int64
        The cell of each triangle of the net.
    minimum, maximum : (c,) int64
        Net vertices that the steepest paths of the cell come from and lead to.
    """

    of_triangle: Ints
    minimum: Ints
    maximum: Ints

    def __len__(self) -> int:
        return len(self.minimum)


def cells_of(links: Links, minimum: Ints, maximum: Ints, paths: tuple[Ints, ...]) -> Cells:
    """Cut the net along the paths of the separatrices and return the pieces.

    Parameters
    ----------
    links : Links
    minimum, maximum : (m,) int64
        The net vertices at which the steepest paths from each triangle end. Next to a separatrix these may differ from
        those of the cell, which has the ends of most of its triangles.
    paths : tuple of (q,) int64
        Net vertices of each separatrix.
    """
    edges = links.edges
    is_open = ~_edges_of_paths(links, paths)[edges.shared]
    left, right = edges.neighbours[is_open].T
    n = len(links.triangles)
    graph = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n))
    n_cells, cell = connected_components(graph, directed=False)
    cell = cell.astype(np.int64)
    return Cells(cell, *(_most_frequent(cell, ends, n_cells, links.n_vertices) for ends in (minimum, maximum)))


def _most_frequent(cell: Ints, ends: Ints, n_cells: int, n_vertices: int) -> Ints:
    keys, count = np.unique(cell * n_vertices + ends, return_counts=True)
    cell_of_key, end_of_key = np.divmod(keys, n_vertices)
    chosen = np.empty(n_cells, dtype=np.int64)
    # Of several assignments to one place the last one stays.
    by_count = np.argsort(count, kind="stable")
    chosen[cell_of_key[by_count]] = end_of_key[by_count]
    return chosen


def _edges_of_paths(links: Links, paths: tuple[Ints, ...]) -> Bools:
    """Mask of the edges of the net that are on paths."""
    starts, stops = (
        np.concatenate([path[part] for path in paths] or [np.empty(0, dtype=np.int64)])
        for part in (slice(None, -1), slice(1, None))
    )
    n, ends = links.n_vertices, links.edges.vertices
    on_path = np.zeros(len(ends), dtype=bool)
    keys = np.minimum(starts, stops) * n + np.maximum(starts, stops)
    on_path[(ends[:, 0] * n + ends[:, 1]).searchsorted(keys)] = True
    return on_path
