"""Self-maps: the ways in which a shape nearly fits itself, turned round or with an arm for the other.

A map of one shape onto another has a rival for every self-map of either, and a search that stops at a good map may
never have seen the rival that is right. So the self-maps are found once for a shape, and every match tries the rivals.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from ...surface.mesh import Floats
from .hypotheses import Effort, find_hypotheses, nearest_orthogonal, spectrum_of
from .map_scoring import SAME_MAP, Candidate, MapScorer, distance_of, distinct_candidates, ranked
from .spectral_shape import SpectralShape

# Many seeds on few functions: half turns of people are seldom among the best of them.
SELF_EFFORT = Effort(levels=(6, 8, 12, 16), beam_width=60, n_seeds=20, n_branches=2, n_kept=10, n_refined=10)
# Self-maps that are kept, the identity left out.
MAX_SELF_MAPS = 5
# Maps whose rivals are tried, and rivals that are refined for one pair of shapes.
MAX_RIVALLED, MAX_RIVALS = 2, 12


def find_self_maps(shape: SpectralShape) -> list[Floats]:
    """Return (k, k) maps of a shape's functions onto themselves, the constant included, best first, the identity not.

    Parameters
    ----------
    shape : SpectralShape
        Of at least one function besides the constant.
    """
    spectrum = spectrum_of(shape)
    hypotheses = find_hypotheses(spectrum, spectrum, SELF_EFFORT).best(SELF_EFFORT.n_refined)
    found = distinct_candidates(ranked(MapScorer(shape, shape).score(hypotheses.maps)), 1 + MAX_SELF_MAPS)
    maps = [candidate.functional_map for candidate in found if not candidate.is_torn]
    return [one for one in maps if distance_of(one, np.eye(len(one))) > SAME_MAP][:MAX_SELF_MAPS]


def find_rivals(best_first: Sequence[Candidate], source: Sequence[Floats], target: Sequence[Floats]) -> Floats:
    """Return (h, K, K) starts for the maps that self-maps of both shapes make of the best candidates, new ones only.

    Parameters
    ----------
    best_first : sequence of Candidate
        Scored for this pair of shapes.
    source, target : sequence of (k, k) float64
        Self-maps of the two shapes, best first.
    """
    tried = [candidate.functional_map for candidate in best_first]
    level, size = len(best_first[0].start), len(tried[0])
    rivalled = [candidate.functional_map for candidate in distinct_candidates(best_first, MAX_RIVALLED)]
    before, after = ([np.eye(size), *(one[:size, :size] for one in self_maps)] for self_maps in (source, target))
    rivals: list[Floats] = []
    ways = product(range(len(before)), range(len(after)), range(len(rivalled)))
    for first, last, number in sorted(ways, key=lambda way: (way[0] + way[1], way[2])):
        rival = after[last] @ rivalled[number] @ before[first]
        if len(rivals) < MAX_RIVALS and all(distance_of(rival, other) > SAME_MAP for other in tried):
            tried.append(rival)
            rivals.append(rival[1 : level + 1, 1 : level + 1])
    return nearest_orthogonal(np.reshape(rivals, (-1, level, level)))
