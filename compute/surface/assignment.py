"""The cheapest pairs of a table of costs."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import min_weight_full_bipartite_matching

from .mesh import Floats, Ints

# The largest cost of an assignment as a whole number: sums of thousands of such are still exact.
WHOLE = 2.0**40


def cheapest_assignment(costs: Floats) -> tuple[Ints, Ints]:
    """Return the rows and columns of the pairs that cost least, as many as the shorter side of (m, n) costs has.

    Infinite costs are taken where there is no other way; costs that differ by 1e-11 of the range of all are equal.
    Not `scipy.optimize.linear_sum_assignment`: a Python with Blender that has loaded scipy.optimize may never end.
    """
    if costs.size == 0:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    finite = np.isfinite(costs)
    lowest, highest = (costs[finite].min(), costs[finite].max()) if finite.any() else (0.0, 0.0)
    forbidden = highest + (1 + min(costs.shape)) * ((highest - lowest) or 1.0)
    raised = np.where(finite, costs, forbidden) - lowest
    # Whole numbers, in which SciPy computes without rounding: with rounding its search may never end.
    whole = np.rint(raised * (WHOLE / (raised.max() or 1.0)))
    # The least cost of each row, or of each column where there are fewer, is paid in any case. With it the search can
    # take seconds instead of milliseconds.
    whole -= whole.min(axis=1 if costs.shape[0] <= costs.shape[1] else 0, keepdims=True)
    # An entry of zero would be no entry.
    rows, columns = min_weight_full_bipartite_matching(csr_array(1 + whole))
    return rows.astype(np.int64), columns.astype(np.int64)
