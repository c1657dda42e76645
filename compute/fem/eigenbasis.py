"""Eigenfunctions of the Laplace-Beltrami operator."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ..choices import BOUNDARIES
from ..errors import SpectrumError
from ..memory import told_if_full
from ..progress import Progress, silent
from ..surface.cleaning import Surface, clean_surface
from ..surface.mesh import Bools, Floats, Ints, TriangleMesh
from .assembly import assemble, element_mass
from .degenerate import fixed_basis
from .eigensolver import EigenPairs, EigenProblem, eigen_problem, lowest_eigenpairs
from .order_choice import require_functions
from .shift_invert import WantedPairs
from .space import FunctionSpace, function_space

# In units of 1 / area; smaller eigenvalues are lost in round-off. A needle of proportion 1 to 1e6 has 1e-5.
LEAST_VALUE = 1e-10


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
        The surface that was analyzed, with its place in the input.

    Examples
    --------
    >>> import numpy as np
    >>> from compute import TriangleMesh, solve_eigenbasis
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> basis = solve_eigenbasis(square, 3)
    >>> basis.functions.shape
    (16, 3)
    >>> np.allclose(basis.functions.T @ basis.mass @ basis.functions, np.eye(3))
    True
    """

    values: Floats
    functions: Floats
    mass: csr_array
    nodes: Floats
    elements: Ints
    order: int
    boundary: str
    surface: Surface


@told_if_full
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
        Number of functions, the constant not counted.
    order : int
        Degree of the elements, 1, 2 or 3.
    boundary : str
        "neumann" (free) or "dirichlet" (zero on the boundary).
    component : int, optional
        Which component, by falling area; the largest if None.
    progress : Progress, optional
        ``progress(fraction, text)``; may raise `Cancelled`.

    Returns
    -------
    Eigenbasis
        With eigenvalues in 1/length².

    Raises
    ------
    MeshError
        If the component does not exist or is a single triangle.
    SpectrumError
        If the order, the boundary condition or the number of functions is not possible, or nothing converges.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.1.
    .. [2] Reuter, Wolter, Peinecke, "Laplace-Beltrami Spectra as Shape-DNA of Surfaces and Solids", CAD 2006.

    Examples
    --------
    The unit square has the eigenvalues pi² (m² + n²).

    >>> import numpy as np
    >>> from compute import TriangleMesh, solve_eigenbasis
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> np.round(solve_eigenbasis(square, 2).values / np.pi**2, 2).tolist()
    [1.0, 1.0]
    """
    surface = clean_surface(mesh, component)
    return solve_on_surface(surface, n_functions, order=order, boundary=boundary, progress=progress)


def solve_on_surface(
    surface: Surface,
    n_functions: int,
    *,
    order: int = 3,
    boundary: str = "neumann",
    largest_ratio: float = np.inf,
    progress: Progress | None = None,
) -> Eigenbasis:
    """Return the smoothest eigenfunctions of a surface that is already clean; see `solve_eigenbasis`.

    Parameters
    ----------
    largest_ratio : float
        Functions whose eigenvalue exceeds the first one this many times are left out, and not computed.
    """
    progress = progress or silent
    progress(0.0, "Building the finite elements")
    problem = posed_problem(surface, n_functions, order, boundary)
    wanted = wanted_pairs(n_functions, boundary, largest_ratio)
    return basis_of_pairs(surface, problem, wanted, lowest_eigenpairs(problem, wanted, progress), progress)


def wanted_pairs(n_functions: int, boundary: str, largest_ratio: float) -> WantedPairs:
    """Return which pairs have to be computed, the constant among them where the boundary is free."""
    n_constant = 1 if boundary == "neumann" else 0
    return WantedPairs(n_functions + n_constant, n_constant, largest_ratio)


def posed_problem(surface: Surface, n_functions: int, order: int, boundary: str) -> EigenProblem:
    """Return the eigenvalue problem on a surface, or refuse what cannot be solved; see `solve_eigenbasis`."""
    space = function_space(surface.mesh, order)
    is_free = _free_unknowns(space, boundary)
    _check_count(n_functions, int(is_free.sum()) - (1 if boundary == "neumann" else 0))
    require_functions(surface.mesh, order, n_functions)
    return eigen_problem(space, is_free)


def basis_of_pairs(
    surface: Surface, problem: EigenProblem, wanted: WantedPairs, pairs: EigenPairs, progress: Progress
) -> Eigenbasis:
    """Return the functions that were wanted, without the constant, in the units and the vertices of the input."""
    space, area = problem.space, surface.mesh.areas.sum()
    values, functions = pairs[0][wanted.n_constant :], pairs[1][:, wanted.n_constant :]
    if not values[0] > LEAST_VALUE:
        raise SpectrumError("The faces are collapsed or barely hang together; merge the vertices by distance first.")
    kept = values <= wanted.largest_ratio * values[0]
    mass = assemble(space.elements, element_mass(problem.metric, space.element), space.n_unknowns)
    functions = fixed_basis(values[kept], functions[:, kept], mass, space.nodes / np.sqrt(area))
    progress(1.0, "Eigenfunctions found")
    n_vertices = len(surface.vertex_of_input)
    functions[:n_vertices] = functions[surface.vertex_of_input]
    functions /= np.sqrt(area)
    return Eigenbasis(
        values=values[kept] / area,
        functions=functions,
        mass=mass * area,
        nodes=space.nodes,
        elements=space.elements,
        order=space.element.order,
        boundary="neumann" if wanted.n_constant else "dirichlet",
        surface=surface,
    )


def _free_unknowns(space: FunctionSpace, boundary: str) -> Bools:
    """Return (N,) the mask of the unknowns that are solved for."""
    if boundary not in BOUNDARIES:
        raise SpectrumError(f'The boundary condition is "neumann" or "dirichlet", not "{boundary}".')
    if boundary == "neumann":
        return space.has_mass
    if not space.on_boundary.any():
        raise SpectrumError("The surface is closed, so there is no boundary to hold at zero; use Neumann.")
    return space.has_mass & ~space.on_boundary


def _check_count(n_functions: int, available: int) -> None:
    if n_functions < 1:
        raise SpectrumError("Ask for at least one eigenfunction.")
    if n_functions > available:
        raise SpectrumError(
            f"The mesh carries only {available} eigenfunctions, not {n_functions}; subdivide it or ask for less."
        )
