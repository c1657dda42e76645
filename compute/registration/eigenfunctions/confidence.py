"""Confidence: the probability that a map is right, among its rivals and the chance that none of them is."""

from collections.abc import Sequence

import numpy as np

from ...surface.mesh import Floats
from .map_scoring import Candidate

# What speaks for one map against another: for each factor e that it costs less, and for fine curvature that agrees
# better. Fitted, like the cost below, to pairs whose truth is known (docs/registration.md, "Confidence").
COST_WEIGHT, CURVATURE_WEIGHT = 2.5, 20.0
# Cost at which it is as likely that no map is right as that the best is.
DOUBTFUL_COST = 1e-5
# Costs below this say nothing: a shape fits itself in all ways its symmetry allows, up to the triangulation.
LEAST_COST = 2e-9


def probabilities(candidates: Sequence[Candidate], curvature: Sequence[float]) -> Floats:
    """Return (n,) how likely each of some different maps is the right one; what is left of 1 is for none of them.

    Parameters
    ----------
    candidates : sequence of Candidate
        At least one, and no two of them the same map.
    curvature : sequence of float
        Agreement of the fine curvature under each, from -1 to 1.
    """
    cost = np.array([candidate.cost for candidate in candidates])
    evidence = CURVATURE_WEIGHT * np.asarray(curvature) - COST_WEIGHT * np.log(cost + LEAST_COST)
    is_whole = np.array([not candidate.is_torn for candidate in candidates])
    if not is_whole.any():
        return np.zeros(len(candidates))
    odds = np.where(is_whole, np.exp(np.minimum(evidence - evidence[is_whole].max(), 0.0)), 0.0)
    fit = 1 / (1 + cost[odds.argmax()] / DOUBTFUL_COST)
    return fit * odds / odds.sum()
