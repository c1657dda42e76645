"""Synchronization: maps from one shape to many, chosen so that the maps among the many that follow from them fit, too.

A pair whose shapes look alike from front and back may be matched turned, and nothing of the pair tells. Others do: the
map from A over B to C is as good as one from A to C that was searched for, if all three are right. So the targets are
matched in a row, each with the next, and every triangle of reference, target and next target is a cycle: what follows
from two of its maps is proposed for the third and scored like what a search finds. Of all that is proposed, those maps
are taken that cost least over all pairs together.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ...progress import Progress, section, silent
from ...surface.mesh import Floats
from ...surface.ties import first_least
from .confidence import COST_WEIGHT, evidence_of, fit_of, odds_of, probabilities
from .map_scoring import LEAST_COST, SAME_MAP, Candidate, MapScorer, distance_of, distinct_candidates, ranked
from .matching import FLIPPABLE, MAX_ALTERNATIVES, Matching
from .spectral_shape import SpectralShape
from .zoomout import with_constant

# Different maps of a pair that are weighed against those of other pairs, and how many times more than its best one they
# may cost: on 56 pairs of scanned persons neither four maps nor a hundred times changed anything.
MOST_RIVALS = 3
SPREAD = 30.0
# A proposal that is this near to a known map leads to it: refinement moved none farther on those pairs.
SAME_START = 0.1
# A pair that is surer than this of a map does not agree with another one.
SURE_OF_ANOTHER = 0.5
COMPARING = "Comparing with the other shapes"


def pairs_in_row(reference: SpectralShape, targets: Sequence[SpectralShape]) -> list[tuple[int, int]]:
    """Return the numbers of targets to be matched with each other: each with the next in a row of the most alike.

    The row begins with the target whose eigenvalues are nearest to the reference's, whatever the order of the targets.
    """
    n_compared = 1 + min(FLIPPABLE, *(shape.n_functions - 1 for shape in (reference, *targets)))
    spectra = np.log([shape.values[1:n_compared] for shape in (reference, *targets)])
    row, left = [0], list(range(1, len(spectra)))
    while left:
        gaps = np.linalg.norm(spectra[left] - spectra[row[-1]], axis=1)
        row.append(left.pop(int(first_least(gaps))))
    return list(pairwise(number - 1 for number in row[1:]))


def synchronized(
    reference: SpectralShape,
    targets: Sequence[SpectralShape],
    matchings: Sequence[Matching],
    links: dict[tuple[int, int], Matching],
    progress: Progress = silent,
) -> list[Matching]:
    """Return the matchings of a reference with its targets that agree best with each other.

    Parameters
    ----------
    reference : SpectralShape
        Its mirror image if that was matched.
    targets : sequence of SpectralShape
        At least two.
    matchings : sequence of Matching
        Of the reference (source) with each target by itself. Those by numbers or with given points stay as they are.
    links : dict of (int, int) to Matching
        Of the targets of `pairs_in_row`, in that order.
    progress : Progress, optional
        May raise `Cancelled`.

    References
    ----------
    .. [1] Nguyen et al., "An Optimization Approach to Improving Collections of Shape Maps", SGP 2011.
    .. [2] Huang and Guibas, "Consistent Shape Maps via Semidefinite Programming", SGP 2013.
    """
    row = [next(iter(links))[0], *(second for _, second in links)]
    spokes = [_Pair(reference, targets[number], matchings[number]) for number in row]
    between = [_Pair(targets[first], targets[second], link) for (first, second), link in links.items()]
    _propose(spokes, between, section(progress, 0, 0.5))
    agreed = _agreed(spokes, between, section(progress, 0.5, 1))
    return [agreed[row.index(number)] for number in range(len(targets))]


class _Pair:
    """Two matched shapes with the maps between them that were found or proposed, each refined and scored."""

    def __init__(self, source: SpectralShape, target: SpectralShape, matching: Matching) -> None:
        self._scorer = MapScorer(source, target)
        self._size = min(FLIPPABLE, source.n_functions - 1, target.n_functions - 1)
        self.matching = matching
        self.is_given = matching.same_topology or len(matching.points) > 0
        self.candidates: list[Candidate] = []
        for found in (matching, *matching.alternatives):
            self.candidate_of(found.map)

    def candidate_of(self, functional_map: Floats) -> Candidate:
        """Return what a map, without the constant, is refined to."""
        start = functional_map[: self._size, : self._size]
        for candidate in self.candidates:
            if distance_of(candidate.functional_map, with_constant(start)) <= SAME_START:
                return candidate
        (candidate,) = self._scorer.score(start[None])
        self.candidates.append(candidate)
        return candidate

    def evidence_of(self, candidate: Candidate) -> float:
        """Return the log odds of a candidate; one that is torn has to be borne by all others."""
        evidence = evidence_of(candidate, self._scorer.fine_curvature(candidate))
        return evidence - COST_WEIGHT * float(np.log(SPREAD)) * candidate.is_torn

    def likely(self, candidates: Sequence[Candidate]) -> Floats:
        """Return the probabilities of different candidates of this pair alone."""
        return probabilities(candidates, [self.evidence_of(candidate) for candidate in candidates])

    def rivals(self) -> list[Candidate]:
        """Return the different maps that may be right, the least costly first."""
        if self.is_given:
            return self.candidates[:1]
        best, *others = distinct_candidates(ranked(self.candidates), MOST_RIVALS)
        dearest = SPREAD * (best.cost + LEAST_COST)
        return [best, *(other for other in others if other.cost <= dearest and not other.is_torn)]

    def is_sure_of_another(self, functional_map: Floats) -> bool:
        """Whether the best map is sure by itself, and another than this one."""
        rivals = self.rivals()
        likely = self.likely(rivals)
        best = int(likely.argmax())
        is_sure = self.is_given or likely[best] > SURE_OF_ANOTHER
        return bool(is_sure) and distance_of(rivals[best].functional_map, with_constant(functional_map)) > SAME_MAP


def _map_of(candidate: Candidate) -> Floats:
    return candidate.functional_map[1:, 1:]


def _in_turn(first: Floats, second: Floats) -> Floats:
    """Return what two maps make one after the other, for the functions that both have."""
    size = min(len(first), len(second))
    return second[:size, :size] @ first[:size, :size]


def _propose(spokes: list[_Pair], links: list[_Pair], progress: Progress) -> None:
    """Give every spoke what follows from its neighbours in the row, forth and back, so that it gets all along."""
    forth = [(place, place + 1) for place in range(len(links))]
    back = [(after, before) for before, after in reversed(forth)]
    for number, (known, place) in enumerate(forth + back):
        progress(number / (2 * len(links)), COMPARING)
        for link in links[min(known, place)].rivals():
            step = _map_of(link) if known < place else _map_of(link).T
            for candidate in spokes[known].rivals():
                spokes[place].candidate_of(_in_turn(_map_of(candidate), step))


def _agreed(spokes: list[_Pair], links: list[_Pair], progress: Progress) -> list[Matching]:
    """Return the matchings of the spokes that cost least together with what follows from them for the links."""
    rivals = [spoke.rivals() for spoke in spokes]
    of_links = []
    for place, link in enumerate(links):
        progress(place / len(links), COMPARING)
        of_links.append(_costs_of_link(link, *rivals[place : place + 2]))
    of_spokes = [
        np.array([-spoke.evidence_of(candidate) for candidate in candidates])
        for spoke, candidates in zip(spokes, rivals, strict=True)
    ]
    chosen, totals = cheapest_in_row(of_spokes, of_links)
    maps = [_map_of(candidates[number]) for candidates, number in zip(rivals, chosen, strict=True)]
    is_broken = [
        link.is_sure_of_another(_in_turn(before.T, after))
        for link, (before, after) in zip(links, pairwise(maps), strict=True)
    ]
    return [
        _with_choice(
            spoke, rivals[place][chosen[place]], float(likely[chosen[place]]), is_broken[max(place - 1, 0) : place + 1]
        )
        for place, (spoke, likely) in enumerate(zip(spokes, map(_shares, totals), strict=True))
    ]


def _costs_of_link(link: _Pair, before: list[Candidate], after: list[Candidate]) -> Floats:
    """Return (b, a) the costs of the link's maps that follow from each map to its source and each to its target."""
    composed = [
        [link.candidate_of(_in_turn(_map_of(first).T, _map_of(second))) for second in after] for first in before
    ]
    return np.array([[-link.evidence_of(candidate) for candidate in row] for row in composed])


def cheapest_in_row(of_places: list[Floats], of_links: list[Floats]) -> tuple[list[int], list[Floats]]:
    """Return a choice for each place of a row that costs least in all, and what the others would cost.

    Parameters
    ----------
    of_places : list of (c,) float64
        Cost of each choice at each place.
    of_links : list of (c, c') float64
        Cost of the choices at two neighbouring places together.

    Returns
    -------
    chosen : list of int
    totals : list of (c,) float64
        For each choice at each place what the cheapest row with it costs.
    """
    before, after = [of_places[0]], [of_places[-1]]
    for place, link in enumerate(of_links):
        before.append(of_places[place + 1] + (before[-1][:, None] + link).min(axis=0))
    for place, link in reversed(list(enumerate(of_links))):
        after.insert(0, of_places[place] + (link + after[0]).min(axis=1))
    chosen = [int(first_least(after[0]))]
    for link, rest in zip(of_links, after[1:], strict=True):
        chosen.append(int(first_least(link[chosen[-1]] + rest)))
    totals = [one + other - own for one, other, own in zip(before, after, of_places, strict=True)]
    return chosen, totals


def _shares(costs: Floats) -> Floats:
    odds = odds_of(-costs)
    return odds / odds.sum()


def _with_choice(spoke: _Pair, best: Candidate, likely: float, is_broken: list[bool]) -> Matching:
    """Return the matching of a spoke by one of its candidates; in doubt where more of its cycles break than hold.

    Parameters
    ----------
    likely : float
        How likely it is among its rivals.
    """
    if spoke.is_given:
        return spoke.matching
    is_consistent = 2 * sum(is_broken) <= len(is_broken)
    confidence = fit_of(best) * likely / (1 if is_consistent else 2)
    others = distinct_candidates([best, *ranked(spoke.candidates)], 1 + MAX_ALTERNATIVES)[1:]
    shares = (1 - confidence) * (spoke.likely(others) if others else np.empty(0))
    likeliest = sorted(zip(shares, others, strict=True), key=lambda share: -share[0])
    alternatives = tuple(_by_candidate(spoke.matching, one, float(share)) for share, one in likeliest)
    matching = _by_candidate(spoke.matching, best, confidence)
    return replace(matching, alternatives=alternatives, is_consistent=is_consistent)


def _by_candidate(matching: Matching, candidate: Candidate, confidence: float) -> Matching:
    return replace(
        matching,
        map=_map_of(candidate),
        confidence=confidence,
        alternatives=(),
        symmetric=candidate.symmetric,
        alternating=candidate.alternating,
    )
