"""Choice of the order of elements that a mesh can afford."""

from dataclasses import dataclass

import numpy as np

from ..errors import MeshError
from ..memory import available_memory
from ..surface.mesh import TriangleMesh

# Peak memory of the solver for 30 functions, measured between 10,000 and 160,000 vertices (docs/spectrum.md).
BYTES_PER_UNKNOWN = 3500

# Peak memory of a whole analysis with linear elements, measured at 160,000 and 650,000 vertices.
LEAST_BYTES_PER_VERTEX = 4200

# Reached by cubic elements at 48,000 vertices; solving takes about 15 seconds there.
MEMORY_BUDGET = 1_500_000_000


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
    at_hand = available_memory()
    memory_budget = min(memory_budget, at_hand)
    n_vertices, n_edges, n_triangles = len(np.unique(mesh.triangles)), len(mesh.edges.vertices), len(mesh.triangles)
    if (n_vertices + 2 * n_edges + n_triangles) * BYTES_PER_UNKNOWN <= memory_budget:
        return OrderChoice(3)
    if (n_vertices + n_edges) * BYTES_PER_UNKNOWN <= memory_budget:
        return OrderChoice(2, _warning("quadratic"))
    if n_vertices * LEAST_BYTES_PER_VERTEX > at_hand:
        raise MeshError(
            f"The analysis of {n_vertices:,} vertices takes about {n_vertices * LEAST_BYTES_PER_VERTEX / 1e9:.1f} GB of"
            f" memory, and {at_hand / 1e9:.1f} GB are free; decimate the mesh or close other programs."
        )
    return OrderChoice(1, _warning("linear"))


def _warning(elements: str) -> str:
    return f"The mesh is large, so {elements} elements were used instead of cubic ones; decimate it for a finer result."
