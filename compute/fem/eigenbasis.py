"""Eigenfunctions of the Laplace-Beltrami operator: the solver."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh, splu

from ..errors import SpectrumError
from ..mesh import Floats, Ints, TriangleMesh
from ..progress import Progress, silent
from ..surface import Surface, clean_surface
from .assembly import mass_matrix, stiffness_matrix
from .ordering import bisect_triangles, elimination_order
from .space import FunctionSpace, function_space

BOUNDARIES = ("neumann", "dirichlet")

# Shift of the factored operator, in units of 1 / area of the mesh: below every eigenvalue, so that the factor exists.
SHIFT = -4.0

# Smaller problems are solved as full matrices.
DENSE_UNKNOWNS = 400


@dataclass(frozen=True, eq=False)
class Eigenbasis:
    """The first k eigenpairs of the Laplace-Beltrami operator, smoothest first, without the constant.

    Attributes
    ----------
    values : (k,) float64
        Eigenvalues in 1/length², ascending.
    functions : (N, k) float64
        One eigenfunction a column, orthonormal in ``mass``; rows 0 to V-1 are the vertices of the input. Vertices
        that are not on the analyzed component have 0, welded doubles the value of the vertex they are welded to.
    mass : (N, N) sparse
        Integrals of the products of basis functions, in length²; rows of unused vertices are empty.
    nodes : (N, 3) float64
        Position of each unknown.
    elements : (T', 3, 6 or 10) int64
        Unknowns of each analyzed triangle, in the node order of `compute.fem.lagrange`.
    order : int
        Degree of the elements.
    boundary : str
        "neumann" or "dirichlet".
    surface : Surface
        What was analyzed, with the way back to the input's triangles.
    """

    values: Floats
    functions: Floats
    mass: csr_array
    nodes: Floats
    elements: Ints
    order: int
    boundary: str
    surface: Surface


def solve_eigenbasis(
    mesh: TriangleMesh,
    n_functions: int = 12,
    *,
    order: int = 3,
    boundary: str = "neumann",
    component: int | None = None,
    progress: Progress | None = None,
) -> Eigenbasis:
    """Return the smoothest eigenfunctions of one component of a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    n_functions : int
        How many functions, the constant not counted.
    order : int
        Degree of the elements, 1, 2 or 3.
    boundary : str
        "neumann" (free) or "dirichlet" (zero on the boundary).
    component : int, optional
        Which component, by falling area; the largest if None.
    progress : Progress, optional
        Told where the work is; may raise `Cancelled`.

    Raises
    ------
    MeshError
        If the component does not exist or is a single triangle.
    SpectrumError
        If the order, the boundary condition or the number of functions is not possible, or nothing converges.
    """
    surface = clean_surface(mesh, component)
    return solve_on_surface(surface, n_functions, order=order, boundary=boundary, progress=progress)


def solve_on_surface(
    surface: Surface,
    n_functions: int,
    *,
    order: int = 3,
    boundary: str = "neumann",
    progress: Progress | None = None,
) -> Eigenbasis:
    """Return the smoothest eigenfunctions of a surface that is already clean; see `solve_eigenbasis`."""
    progress = progress or silent
    progress(0.0, "Building the finite elements")
    space = function_space(surface.mesh, order)
    free = _free_unknowns(space, boundary)
    n_skipped = 1 if boundary == "neumann" else 0
    _check_count(n_functions, len(free) - n_skipped)
    area = surface.mesh.areas.sum()
    stiffness, mass = stiffness_matrix(space), mass_matrix(space)
    progress(0.1, "Factoring")
    values, columns = _smallest_eigenpairs(stiffness, mass, free, space, n_functions + n_skipped, progress)
    functions = np.zeros((space.n_unknowns, n_functions))
    functions[free] = _with_fixed_sign(columns[:, n_skipped:]) / np.sqrt(area)
    n_vertices = len(surface.vertex_of_input)
    functions[:n_vertices] = functions[surface.vertex_of_input]
    progress(1.0, "Eigenfunctions found")
    return Eigenbasis(
        values[n_skipped:] / area, functions, mass * area, space.nodes, space.elements, order, boundary, surface
    )


def _free_unknowns(space: FunctionSpace, boundary: str) -> Ints:
    """Return the unknowns that are solved for, in their order of elimination."""
    if boundary not in BOUNDARIES:
        raise SpectrumError(f'The boundary condition is "neumann" or "dirichlet", not "{boundary}".')
    is_free = space.has_mass
    if boundary == "dirichlet":
        if not space.on_boundary.any():
            raise SpectrumError("The surface is closed, so there is no boundary to hold at zero; use Neumann.")
        is_free = is_free & ~space.on_boundary
    ordered = elimination_order(space.elements, bisect_triangles(space.mesh), space.n_unknowns)
    return ordered[is_free[ordered]]


def _check_count(n_functions: int, available: int) -> None:
    if n_functions < 1:
        raise SpectrumError("Ask for at least one eigenfunction.")
    if n_functions > available:
        raise SpectrumError(
            f"The mesh carries only {available} eigenfunctions, not {n_functions}; subdivide it or ask for less."
        )


def _smallest_eigenpairs(
    stiffness: csr_array, mass: csr_array, free: Ints, space: FunctionSpace, n_pairs: int, progress: Progress
) -> tuple[Floats, Floats]:
    """Return the smallest eigenvalues and their functions on the free unknowns, orthonormal in the mass matrix."""
    stiffness, mass = stiffness[free][:, free], mass[free][:, free]
    if len(free) <= max(DENSE_UNKNOWNS, 4 * n_pairs):
        values, functions = scipy.linalg.eigh(stiffness.toarray(), mass.toarray(), subset_by_index=[0, n_pairs - 1])
        return values, functions
    factor = splu(
        (stiffness - SHIFT * mass).tocsc(),
        permc_spec="NATURAL",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    n_solves = 0

    def solve(column: Floats) -> Floats:
        nonlocal n_solves
        n_solves += 1
        progress(0.5 + 0.5 * n_solves / (n_solves + 3 * n_pairs), "Computing eigenfunctions")
        return factor.solve(column)

    inverse = LinearOperator(stiffness.shape, matvec=solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(len(free))
    try:
        values, functions = eigsh(stiffness, n_pairs, mass, sigma=SHIFT, v0=start, OPinv=inverse)
    except ArpackError as error:
        raise SpectrumError(f"The {n_pairs} eigenfunctions did not converge; repair slivers or remesh.") from error
    by_value = np.argsort(values)
    return values[by_value], functions[:, by_value]


def _with_fixed_sign(functions: Floats) -> Floats:
    """Flip each column so that its entry of largest magnitude is positive."""
    largest = np.abs(functions).argmax(axis=0)
    return functions * np.sign(functions[largest, np.arange(functions.shape[1])])
