"""Choice of the order of elements that a mesh can afford, and the memory that eigenfunctions take."""

from dataclasses import dataclass

from ..memory import available_memory, require_memory
from ..surface.mesh import TriangleMesh
from .eigensolver import DENSE_SHARE, DENSE_UNKNOWNS
from .lagrange import reference_element

# Peak memory of an analysis, or of 30 functions, with elements of any order: 2.3 to 4.0 kB an unknown, measured on
# bodies and on balls, which fill the factor most, at 10,000 to 50,000 vertices (docs/method.md).
BYTES_PER_UNKNOWN = 4200
# More functions take more: so much for each and each unknown.
USUAL_FUNCTIONS = 30
BYTES_PER_VALUE = 36
# Where functions are many for their unknowns, full matrices are solved: so much for each entry.
BYTES_PER_ENTRY = 40

# Reached by cubic elements at 48,000 vertices; solving takes about 15 seconds there.
MEMORY_BUDGET = 1_800_000_000

TOO_LARGE = (
    "The analysis of {:,} vertices takes about {} of memory, and {} are free; decimate the mesh or close other"
    " programs."
)
TOO_FINE = (
    "With elements of order {}, the analysis of {:,} vertices takes about {} of memory, and {} are free; take a lower"
    " order or decimate the mesh."
)
TOO_MANY = (
    "{:,} eigenfunctions of {:,} vertices take about {} of memory, and {} are free; ask for less, take a lower order or"
    " decimate the mesh."
)


@dataclass(frozen=True)
class OrderChoice:
    """An order of elements, and the sentence for the result if it is not the best one."""

    order: int
    warning: str | None = None


def choose_order(mesh: TriangleMesh, memory_budget: float = MEMORY_BUDGET) -> OrderChoice:
    """Return cubic elements as long as solving stays within a memory budget, then quadratic, then linear.

    Time grows with the same number, that of unknowns: about 9, 4 and 1 for each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface to be analyzed.
    memory_budget : float
        Bytes.

    Raises
    ------
    MeshError
        If not even linear elements fit into the memory at hand.
    """
    memory_budget = min(memory_budget, available_memory())
    for order, warning in ((3, None), (2, _warning("quadratic"))):
        if memory_of_functions(n_unknowns(mesh, order)) <= memory_budget:
            return OrderChoice(order, warning)
    require_memory(memory_of_functions(n_unknowns(mesh, 1)), TOO_LARGE, len(mesh.used))
    return OrderChoice(1, _warning("linear"))


def require_order(mesh: TriangleMesh, order: int) -> None:
    """Refuse elements of an order that do not fit into the memory at hand.

    Raises
    ------
    MeshError
        If they do not.
    """
    needed = memory_of_functions(n_unknowns(mesh, order))
    if order > 1:
        require_memory(needed, TOO_FINE, order, len(mesh.used))
    require_memory(needed, TOO_LARGE, len(mesh.used))


def require_functions(mesh: TriangleMesh, order: int, n_functions: int) -> None:
    """Refuse eigenfunctions that do not fit into the memory at hand.

    Raises
    ------
    MeshError
        If they do not.
    """
    needed = memory_of_functions(n_unknowns(mesh, order), n_functions)
    require_memory(needed, TOO_MANY, n_functions, len(mesh.used))


def n_unknowns(mesh: TriangleMesh, order: int) -> int:
    """Return how many unknowns elements of an order have on a surface.

    Raises
    ------
    SpectrumError
        If the order is not 1, 2 or 3.
    """
    element = reference_element(order)
    in_edges, in_triangles = element.n_inside_edge * len(mesh.edges.vertices), element.n_interior * len(mesh.triangles)
    return len(mesh.used) + in_edges + in_triangles


def memory_of_functions(n_unknowns: int, n_functions: int = USUAL_FUNCTIONS) -> float:
    """Return the bytes that computing eigenfunctions takes at most, and an analysis by them."""
    needed = n_unknowns * (BYTES_PER_UNKNOWN + BYTES_PER_VALUE * max(0, n_functions - USUAL_FUNCTIONS))
    is_dense = n_unknowns <= max(DENSE_UNKNOWNS, n_functions / DENSE_SHARE)
    return float(max(needed, BYTES_PER_ENTRY * n_unknowns**2 * is_dense))


def _warning(elements: str) -> str:
    return f"The mesh is large, so {elements} elements were used instead of cubic ones; decimate it for a finer result."
