"""Paths along the edges of a spectral shape."""

import numpy as np
from scipy.sparse import coo_array, csr_array

from ...surface.mesh import edges_of
from .spectral_shape import SpectralShape


def edge_paths(shape: SpectralShape) -> csr_array:
    """Return (n, n) the lengths of the edges between points, each in one direction."""
    ends = edges_of(shape.triangles, len(shape.positions)).vertices
    lengths = np.linalg.norm(shape.positions[ends[:, 0]] - shape.positions[ends[:, 1]], axis=1)
    n = len(shape.positions)
    # An edge without length would be none for the search.
    return coo_array((np.maximum(lengths, 1e-12), (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr()
