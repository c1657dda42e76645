"""How far the eigenvalues of linear elements are from those of richer ones, from the linear functions alone."""

import numpy as np

from ..surface.mesh import Floats, Ints
from .assembly import element_stiffness
from .eigensolver import EigenProblem
from .lagrange import reference_element


def relative_excess(problem: EigenProblem, values: Floats, functions: Floats) -> Floats:
    """Return (k,) about how much eigenvalues of linear elements exceed those of quadratic ones, relatively.

    Quadratic elements add to the linear ones a bubble on each edge that is free, 4 times the product of the two hat
    functions of its ends. What each bubble takes off the energy of a function by itself is added up.

    Parameters
    ----------
    problem : EigenProblem
        With linear elements.
    values : (k,) float64
        In units of 1 / area, none of them zero.
    functions : (N, k) float64
        Orthonormal with the area as unit.

    References
    ----------
    .. [1] Bank and Smith, "A posteriori error estimates based on hierarchical bases", SIAM J. Numer. Anal. 1993.
    """
    mesh, shape = problem.space.mesh, problem.metric
    # Corners in rows, which are several times as fast as many rows of three.
    corners = np.ascontiguousarray(mesh.triangles.T)
    stiffness = np.ascontiguousarray(element_stiffness(shape, reference_element(1)).transpose(1, 2, 0))
    # Edges of a triangle are ab, bc, ca; the one that is opposite to a, b, c each.
    opposite = np.ascontiguousarray(mesh.edges.of_triangle[:, [1, 2, 0]].T)
    is_free = (mesh.edges.n_triangles > 1) | problem.is_free[mesh.edges.vertices].any(axis=1)
    energy = _on_edges(np.tile(np.trace(stiffness) * 4 / 3, (3, 1)), opposite)
    excess = np.zeros(len(values))
    for number, (value, function) in enumerate(zip(values.tolist(), functions.T.copy(), strict=True)):
        at_corners = function[corners]
        load = value * shape.doubled_areas / 30 * (2 * at_corners.sum(axis=0) - at_corners)
        residual = _on_edges(load + 4 / 3 * np.einsum("ijt,jt->it", stiffness, at_corners), opposite)
        excess[number] = np.sum(residual[is_free] ** 2 / energy[is_free]) / value
    return excess


def _on_edges(of_corner: Floats, edge_of_corner: Ints) -> Floats:
    """Return the sum on each edge of numbers at the corners that it is opposite to."""
    return np.bincount(edge_of_corner.ravel(), of_corner.ravel()).astype(np.float64)
