"""Memory that it takes to match two shapes, and to map one onto the other."""

from ...fem.matching_basis import MATCHING_FUNCTIONS, matching_order
from ...fem.order_choice import memory_of_functions, n_unknowns
from ...memory import require_memory
from ...surface.cleaning import Surface

# What is kept of each point of both shapes while the functions of one are computed, and the tables of the search, whose
# size does not depend on the shapes: measured at 10,000 to 50,000 vertices (docs/method.md).
BYTES_PER_POINT = 1500
BYTES_OF_SEARCH = 40_000_000
# Tables of the samples of a dense map, likewise.
BYTES_OF_MAP = 60_000_000
TOO_LARGE = (
    "Matching shapes of {:,} and {:,} vertices takes about {} of memory, and {} are free; decimate the meshes or close"
    " other programs."
)


def require_pair(source: Surface, target: Surface, more: float = 0.0) -> None:
    """Refuse to match two shapes that do not fit into the memory at hand, with so many bytes more for what follows.

    Raises
    ------
    MeshError
        If they do not.
    """
    needed = memory_of_matching(source, target) + more
    require_memory(needed, TOO_LARGE, len(source.mesh.used), len(target.mesh.used))


def memory_of_matching(source: Surface, target: Surface) -> float:
    """Return the bytes that matching two shapes takes at most."""
    n_points = [n_unknowns(surface.mesh, matching_order(surface)) for surface in (source, target)]
    largest = memory_of_functions(max(n_points), MATCHING_FUNCTIONS)
    return largest + BYTES_PER_POINT * sum(n_points) + BYTES_OF_SEARCH
