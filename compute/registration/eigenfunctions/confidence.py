"""Confidence: the probability that a map is right, among its rivals and the chance that none of them is."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ...surface.mesh import Floats
from .map_scoring import LEAST_COST, Candidate

# Log odds of one map against another: for each factor e that it costs less, and for fine curvature that agrees better.
# Fitted, like the cost below, to pairs whose truth is known (docs/registration.md, "Confidence").
COST_WEIGHT, CURVATURE_WEIGHT = 2.5, 15.0
# Log odds that differ by less say nothing: so do those of maps that are equally right, between two triangulations.
TIE = 0.2
# Cost at which it is as likely that no map is right as that the best is.
DOUBTFUL_COST = 1e-5
# Curvature that agrees better than this says nothing: so it does over the right map between other triangulations.
FULL_AGREEMENT = 0.9


def evidence_of(candidate: Candidate, curvature: float) -> float:
    """Return the log odds of a map, up to a number that is the same for all maps of a pair of shapes.

    Parameters
    ----------
    candidate : Candidate
    curvature : float
        Agreement of the fine curvature under it, from -1 to 1.
    """
    agreement = min(curvature, FULL_AGREEMENT)
    return CURVATURE_WEIGHT * agreement - COST_WEIGHT * float(np.log(max(candidate.cost, LEAST_COST)))


def fit_of(candidate: Candidate) -> float:
    """Return how likely it is, from 0 to 1, that a map or one of its rivals is right."""
    return 0.0 if candidate.is_torn else 1 / (1 + candidate.cost / DOUBTFUL_COST)


def odds_of(evidence: Floats) -> Floats:
    """Return (n,) how likely maps are by their log odds, the likeliest and those that tie with it 1."""
    lead = evidence - evidence.max()
    return np.exp(np.where(lead > -TIE, 0.0, lead))


def probabilities(candidates: Sequence[Candidate], evidence: ArrayLike) -> Floats:
    """Return (n,) how likely each of some different maps is the right one; what is left of 1 is for none of them.

    Parameters
    ----------
    candidates : sequence of Candidate
        At least one, and no two of them the same map.
    evidence : (n,) float64
        Log odds of each.
    """
    is_whole = np.array([not candidate.is_torn for candidate in candidates])
    if not is_whole.any():
        return np.zeros(len(candidates))
    odds = odds_of(np.where(is_whole, evidence, -np.inf))
    return fit_of(candidates[int(odds.argmax())]) * odds / odds.sum()
