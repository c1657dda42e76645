"""Self-maps: the ways in which a shape nearly fits itself, turned round or with an arm for the other.

A map of one shape onto another has a rival for every self-map of the source, and a search that stops at a good map may
never have seen the rival that is right. So the self-maps are found once for a shape, and every match tries the rivals.
Self-maps of the target make the same rivals; trying both took half as long again and changed none of 188 pairs.
"""

from collections.abc import Sequence

import numpy as np

from ...surface.mesh import Floats
from ...surface.ties import evened
from .hypotheses import Effort, find_hypotheses, nearest_orthogonal, spectrum_of
from .map_scoring import SAME_MAP, Candidate, MapScorer, distance_of, distinct_candidates, ranked
from .spectral_shape import SpectralShape

# Many seeds on few functions: half turns of people are seldom among the best of them.
SELF_EFFORT = Effort(levels=(6, 8, 12, 16), beam_width=60, n_seeds=20, n_branches=2, n_kept=10, n_refined=10)
# Self-maps that are kept, the identity left out.
MAX_SELF_MAPS = 5
# Maps of a pair whose rivals are tried.
MAX_RIVALLED = 2
# Samples of rough maps, and how many rivals are worth more, the least costly of the rough ones.
ROUGH_SAMPLES, MAX_PROMISING = 400, 4


def find_self_maps(shape: SpectralShape) -> list[Floats]:
    """Return (k, k) maps of a shape's functions onto themselves, the constant included, best first, the identity not.

    Parameters
    ----------
    shape : SpectralShape
        Of at least one function besides the constant.
    """
    spectrum = spectrum_of(shape)
    hypotheses = find_hypotheses(spectrum, spectrum, SELF_EFFORT).best(SELF_EFFORT.n_refined)
    scorer = MapScorer(shape, shape, ROUGH_SAMPLES)
    candidates = ranked(scorer.score(hypotheses.maps))
    turned = _other_than_identity(candidates)
    if turned:
        # What two of them make one after the other, of which the search may have missed some.
        twice = scorer.score(find_rivals(turned, [candidate.functional_map for candidate in turned]))
        turned = _other_than_identity(ranked([*candidates, *twice]))
    return [candidate.functional_map for candidate in turned]


def _other_than_identity(best_first: Sequence[Candidate]) -> list[Candidate]:
    """Return the different whole self-maps that are not the identity, as many as are kept."""
    found = distinct_candidates([one for one in best_first if not one.is_torn], 1 + MAX_SELF_MAPS)
    moved = [one for one in found if distance_of(one.functional_map, np.eye(len(one.functional_map))) > SAME_MAP]
    return moved[:MAX_SELF_MAPS]


def promising(rivals: Floats, source: SpectralShape, target: SpectralShape) -> Floats:
    """Return the rivals (h, K, K) that are worth to be refined and scored in full."""
    if len(rivals) <= MAX_PROMISING:
        return rivals
    cost = [candidate.cost for candidate in MapScorer(source, target, ROUGH_SAMPLES).score(rivals)]
    return rivals[np.sort(np.argsort(evened(np.array(cost)), kind="stable")[:MAX_PROMISING])]


def find_rivals(best_first: Sequence[Candidate], self_maps: Sequence[Floats]) -> Floats:
    """Return (h, K, K) starts for the maps that self-maps of the source make of the best candidates, new ones only.

    Parameters
    ----------
    best_first : sequence of Candidate
        Scored for this pair of shapes.
    self_maps : sequence of (k, k) float64
        Of the source, best first. Those of the target make the same rivals, as far as the shapes are alike.
    """
    rivalled = distinct_candidates(best_first, MAX_RIVALLED)
    tried = [candidate.functional_map for candidate in best_first]
    level, size = len(best_first[0].start), len(tried[0])
    rivals: list[Floats] = []
    for turn in self_maps:
        for candidate in rivalled:
            rival = candidate.functional_map @ turn[:size, :size]
            if all(distance_of(rival, other) > SAME_MAP for other in tried):
                tried.append(rival)
                rivals.append(rival[1 : level + 1, 1 : level + 1])
    return nearest_orthogonal(np.reshape(rivals, (-1, level, level)))
