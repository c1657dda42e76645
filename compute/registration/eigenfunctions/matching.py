"""Matching: order, sign, mixing and handedness of the eigenfunctions of two shapes, with nothing to click."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ...analysis.analysis import Analysis
from ...errors import RegistrationError
from ...memory import told_if_full
from ...progress import Progress, rising, section, silent
from ...surface.cleaning import Surface
from ...surface.mesh import Floats, Ints
from ...surface.ties import evened
from .confidence import evidence_of, probabilities
from .given_points import (
    LEAST_TRUST,
    SURE_WITHOUT,
    PointFit,
    checked_points,
    point_pairs,
    point_warnings,
    relative_to,
    trust_in,
)
from .hypotheses import Effort, find_hypotheses, spectrum_of
from .map_scoring import SAME_MAP, Candidate, MapScorer, distance_of, distinct_candidates, ranked
from .pair_memory import require_pair
from .self_maps import find_rivals, promising
from .spectral_shape import SpectralShape, prepare_shape, spectral_shape
from .zoomout import MATCHING_SIZES, rounded, with_constant

# Widths of the search; the second effort is made only where the first leaves doubt.
EFFORTS = (Effort(), Effort(n_seeds=30, n_branches=2, n_kept=12, n_refined=10))
# A matching at least this sure is not searched for any further.
SURE = 0.75
MAX_ALTERNATIVES = 3
# Different candidates whose probabilities are compared.
MAX_WEIGHED = 6
# Signs can be given for the functions that hypotheses are made of; the rest follows from them.
FLIPPABLE = max(EFFORTS[0].levels)


@dataclass(frozen=True, eq=False)
class Matching:
    """A map between the eigenfunctions of two shapes, from a source to a target.

    Attributes
    ----------
    map : (kt, ks) float64
        Near-orthogonal, target x source, the constant left out, for functions on surfaces of area 1: the source's
        functions, carried to the target, are the target's functions @ map.
    confidence : float
        The probability, from 0 to 1, that the matching is right.
    alternatives : tuple of Matching
        At most three others, the likeliest first, without alternatives of their own; all probabilities together are
        at most 1, and what is left is for none of them.
    same_topology : bool
        Whether both shapes have the same triangles, so that vertices correspond by their numbers.
    mirrored : bool
        Whether the source's mirror image was matched.
    symmetric, alternating : float
        Agreement of the moment tensors, 1 at best.
    is_consistent : bool
        False where it contradicts the matchings of other shapes that were registered with these.
    points : (p, 2) int64
        Pairs of vertices, of the source and the target, that were given.
    point_gaps : (p,) float64
        Length, in units of the root of the area, from the source's vertex of each pair to where the map of the
        functions puts the target's. Dense maps put it where it was given.
    sure_without_points : float
        The probability of the likeliest map without the points, if they led to another one; 0 if not.

    Examples
    --------
    A function that is the negative of its partner, and two that have changed places:

    >>> import numpy as np
    >>> from compute import Matching
    >>> matching = Matching(np.array([[-1.0, 0, 0], [0, 0, 1], [0, 1, 0]]), confidence=0.9)
    >>> matching.order.tolist(), matching.signs.tolist()
    ([0, 2, 1], [-1, 1, 1])
    """

    map: Floats
    confidence: float
    alternatives: tuple["Matching", ...] = ()
    same_topology: bool = False
    mirrored: bool = False
    symmetric: float = 1.0
    alternating: float = 1.0
    is_consistent: bool = True
    points: Ints = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    point_gaps: Floats = field(default_factory=lambda: np.empty(0))
    sure_without_points: float = 0.0

    @property
    def is_sure(self) -> bool:
        """Whether it is rather right than not."""
        return self.confidence > 0.5

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about given points that contradict the map, or another map that is sure without them."""
        return point_warnings(self.point_gaps, self.sure_without_points)

    @cached_property
    def order(self) -> Ints:
        """(ks,) the target's function (from 0) that each of the source's functions mostly is."""
        return rounded(self.map)[0]

    @cached_property
    def signs(self) -> Ints:
        """(ks,) +1 or -1, the sign with which it is that function."""
        return rounded(self.map)[1]


@told_if_full
def match(
    source: Analysis,
    target: Analysis,
    *,
    points: ArrayLike | None = None,
    flips: Mapping[int, int] | None = None,
    mirrored: bool = False,
    progress: Progress | None = None,
) -> Matching:
    """Match the eigenfunctions of two shapes.

    Parameters
    ----------
    source, target : Analysis
    points : (p, 2) int, optional
        Pairs of vertices, of the source and the target, that belong together. They decide where a symmetry leaves
        several matchings. One that contradicts everything else is told in the matching's ``warnings``, and its
        confidence is low.
    flips : mapping of int to +1 or -1, optional
        The sign that a function of the source (from 1) is to have, whatever fits better; all others follow. Functions
        point where those of ``eigenbasis`` do.
    mirrored : bool
        Match the mirror image of the source: a left hand with a right one.
    progress : callable, optional
        ``progress(fraction, text)``; may raise `Cancelled`.

    Returns
    -------
    Matching
        From the source's functions to the target's.

    Raises
    ------
    RegistrationError
        If points are no pairs of vertices of the two, or one has no face or is in two pairs; if a sign is given for a
        function that has none, or is not +1 or -1; or if a shape was analyzed shell by shell.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.6, on order and signs.
    .. [2] Melzi et al., "ZoomOut: Spectral Upsampling for Efficient Shape Correspondence", SIGGRAPH Asia 2019.

    Examples
    --------
    >>> from compute import TriangleMesh, analyze, match
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> longer = TriangleMesh(square.vertices * [2, 1, 1], square.triangles)
    >>> source, target = (analyze(mesh, field=mesh.vertices[:, 0]) for mesh in (square, longer))
    >>> matching = match(source, target)
    >>> matching.same_topology, matching.confidence
    (True, 1.0)
    """
    require_pair(source.surface, target.surface)
    progress = rising(progress or silent)
    shapes = matching_shape(source, section(progress, 0, 0.2)), matching_shape(target, section(progress, 0.2, 0.4))
    rest = section(progress, 0.4, 1)
    surfaces = source.surface, target.surface
    return match_surfaces(*surfaces, *shapes, points=points, flips=flips, mirrored=mirrored, progress=rest)


@told_if_full
def matching_shape(analysis: Analysis, progress: Progress = silent) -> SpectralShape:
    """Return a shape ready to be matched, with functions that are computed now if they were not before."""
    return spectral_shape(analysis.find_matching_basis(progress))


def match_surfaces(
    source: Surface,
    target: Surface,
    source_shape: SpectralShape,
    target_shape: SpectralShape,
    *,
    points: ArrayLike | None = None,
    flips: Mapping[int, int] | None = None,
    mirrored: bool = False,
    progress: Progress = silent,
) -> Matching:
    """Match two shapes as `match` does, from their surfaces and the spectral shapes of these."""
    signs = _checked_signs(flips or {})
    vertices = checked_points(points, source, target)
    pairs = point_pairs(vertices, source, target, source_shape, target_shape)
    fit = PointFit(pairs, source_shape, target_shape) if len(vertices) else None
    if not signs and not mirrored and share_topology(source, target):
        by_number = match_by_number(source_shape, target_shape)
        held = by_number if fit is None else _held_to_points(by_number, fit)
        if not held.warnings:
            return held
    return match_shapes(source_shape, target_shape, signs, fit=fit, mirrored=mirrored, progress=progress)


def share_topology(source: Surface, target: Surface) -> bool:
    """Whether two surfaces have the same triangles over the same vertices."""
    same_vertices = np.array_equal(source.vertex_of_input, target.vertex_of_input)
    return same_vertices and np.array_equal(source.mesh.triangles, target.mesh.triangles)


def match_by_number(source: SpectralShape, target: SpectralShape) -> Matching:
    """Return the matching of two shapes whose points correspond by their numbers."""
    size = min(*MATCHING_SIZES[-1:], source.n_functions, target.n_functions)
    carried = target.project(source.functions[:, :size])[1:size, 1:]
    return Matching(carried, 1.0, same_topology=True)


def match_shapes(
    source: SpectralShape,
    target: SpectralShape,
    signs: Mapping[int, int] | None = None,
    *,
    fit: PointFit | None = None,
    mirrored: bool = False,
    progress: Progress = silent,
) -> Matching:
    """Match the functions of two shapes; ``signs`` are given by the source's function, from 0."""
    measuring, progress = section(progress, 0, 0.4), section(progress, 0.4, 1)
    prepare_shape(source, section(measuring, 0, 0.8), with_self_maps=not signs)
    prepare_shape(target, section(measuring, 0.8, 1))
    seen = source.mirrored() if mirrored else source
    searching, fitting = section(progress, 0, 1 if fit is None else 0.75), section(progress, 0.75, 1)
    scorer = MapScorer(seen, target)
    rivals: list[Candidate] = []
    if signs:
        candidates, rivals = _found_with_signs(seen, target, scorer, signs, searching)
    else:
        # A shape's mirror image fits itself in the same ways as the shape.
        candidates = _found(seen, target, scorer, source.self_maps, searching)
    if fit is not None:
        candidates, rivals = _drawn_to_points(fit, candidates, rivals, scorer, signs or {}, fitting)
    weighed = _weighed(candidates, rivals, scorer)
    found = [_matching_of(candidate, confidence, mirrored) for candidate, confidence in weighed]
    if fit is not None:
        found = _likeliest_first([_held_to_points(one, fit) for one in found])
        found[0] = _told_if_overruling(found[0], candidates, rivals, scorer)
    return replace(found[0], alternatives=tuple(found[1 : 1 + MAX_ALTERNATIVES]))


def _found(
    source: SpectralShape,
    target: SpectralShape,
    scorer: MapScorer,
    self_maps: list[Floats],
    progress: Progress,
) -> list[Candidate]:
    """Return scored hypotheses with their rivals, best first; the search is widened until the likeliest is sure."""
    spectra = spectrum_of(source), spectrum_of(target)
    candidates: list[Candidate] = []
    for number, effort in enumerate(EFFORTS):
        searching, refining = _halves(section(progress, number / len(EFFORTS), (number + 1) / len(EFFORTS)))
        hypotheses = find_hypotheses(*spectra, effort, progress=searching)
        found, rivalling = _halves(refining)
        candidates += scorer.score(hypotheses.best(effort.n_refined).maps, progress=found)
        rivals = promising(find_rivals(ranked(candidates), self_maps), source, target)
        candidates = ranked(candidates + scorer.score(rivals, progress=rivalling))
        if _weighed(candidates, [], scorer)[0][1] >= SURE:
            break
    return candidates


def _found_with_signs(
    source: SpectralShape, target: SpectralShape, scorer: MapScorer, signs: Mapping[int, int], progress: Progress
) -> tuple[list[Candidate], list[Candidate]]:
    """Return scored hypotheses that keep given signs, best first, and the best that do not need to."""
    keeping, leaving = _halves(progress)
    effort, spectra = EFFORTS[0], (spectrum_of(source), spectrum_of(target))
    scored = []
    for given, (searching, refining) in ((signs, _halves(keeping)), ({}, _halves(leaving))):
        hypotheses = find_hypotheses(*spectra, effort, given, searching).best(effort.n_refined)
        scored.append(ranked(scorer.score(hypotheses.maps, given, refining)))
    return scored[0], scored[1]


def _drawn_to_points(
    fit: PointFit,
    candidates: list[Candidate],
    rivals: list[Candidate],
    scorer: MapScorer,
    signs: Mapping[int, int],
    progress: Progress,
) -> tuple[list[Candidate], list[Candidate]]:
    """Return candidates, best first, and rivals, of which those that miss points lose.

    While none is sure to meet them, there are more that the points draw the search to.
    """
    spectra = spectrum_of(fit.source, fit.pairs.source), spectrum_of(fit.target, fit.pairs.target)
    candidates, rivals = ranked(fit.handicapped(candidates)), fit.handicapped(rivals)
    for number, effort in enumerate(EFFORTS):
        compared = relative_to(candidates[0], candidates), relative_to(candidates[0], rivals)
        best, likely = _weighed(*compared, scorer)[0]
        if likely * trust_in(fit.gaps(best.functional_map)) >= SURE:
            break
        searching, refining = _halves(section(progress, number / len(EFFORTS), (number + 1) / len(EFFORTS)))
        hypotheses = find_hypotheses(*spectra, effort, signs, searching).best(effort.n_refined)
        drawn = fit.handicapped(scorer.score(hypotheses.maps, signs, refining))
        candidates, rivals = ranked(candidates + drawn), rivals + drawn
    return relative_to(candidates[0], candidates), relative_to(candidates[0], rivals)


def _weighed(
    candidates: Sequence[Candidate], rivals: Sequence[Candidate], scorer: MapScorer
) -> list[tuple[Candidate, float]]:
    """Return different ones of candidates, given best first, with their probabilities among rivals, likeliest first."""
    own = distinct_candidates(candidates, MAX_WEIGHED)
    compared = distinct_candidates([*own, *ranked(rivals)], len(own) + MAX_WEIGHED)
    evidence = np.array([evidence_of(candidate, scorer.fine_curvature(candidate)) for candidate in compared])
    likely = probabilities(compared, evidence)[: len(own)]
    order = np.lexsort((-evened(evidence[: len(own)]), -evened(likely)))
    return [(own[number], float(likely[number])) for number in order.tolist()]


def held_to_points(
    matching: Matching,
    points: ArrayLike,
    source: Surface,
    target: Surface,
    source_shape: SpectralShape,
    target_shape: SpectralShape,
) -> Matching:
    """Return a matching that remembers points, and is less sure the farther from them it is."""
    vertices = checked_points(points, source, target)
    pairs = point_pairs(vertices, source, target, source_shape, target_shape)
    return _held_to_points(matching, PointFit(pairs, source_shape, target_shape))


def _held_to_points(matching: Matching, fit: PointFit) -> Matching:
    gaps = fit.gaps_by_number() if matching.same_topology else fit.gaps(with_constant(matching.map))
    return replace(
        matching,
        confidence=matching.confidence * trust_in(gaps),
        alternatives=tuple(_likeliest_first([_held_to_points(other, fit) for other in matching.alternatives])),
        points=fit.pairs.vertices,
        point_gaps=gaps,
    )


def _told_if_overruling(
    matching: Matching, candidates: Sequence[Candidate], rivals: Sequence[Candidate], scorer: MapScorer
) -> Matching:
    """Return a matching that is led by points, less sure where there is another that is sure without them."""
    free = ranked([replace(one, handicap=1.0) for one in (*candidates, *rivals)])
    best, likely = _weighed(free, [], scorer)[0]
    if likely <= SURE_WITHOUT or distance_of(best.functional_map, with_constant(matching.map)) <= SAME_MAP:
        return matching
    return replace(matching, confidence=matching.confidence * LEAST_TRUST, sure_without_points=likely)


def _likeliest_first(matchings: Sequence[Matching]) -> list[Matching]:
    order = np.argsort(-evened(np.array([one.confidence for one in matchings])), kind="stable")
    return [matchings[number] for number in order.tolist()]


def _halves(progress: Progress) -> tuple[Progress, Progress]:
    return section(progress, 0, 0.5), section(progress, 0.5, 1)


def _matching_of(candidate: Candidate, confidence: float, mirrored: bool) -> Matching:
    functional_map = candidate.functional_map[1:, 1:]
    return Matching(
        map=functional_map,
        confidence=confidence,
        mirrored=mirrored,
        symmetric=candidate.symmetric,
        alternating=candidate.alternating,
    )


def _checked_signs(flips: Mapping[int, int]) -> dict[int, int]:
    for number, sign in flips.items():
        if not 1 <= number <= FLIPPABLE:
            raise RegistrationError(f"Only the signs of functions 1 to {FLIPPABLE} can be given, not that of {number}.")
        if sign not in (-1, 1):
            raise RegistrationError(f"The sign of a function is +1 or -1, not {sign}.")
    return {number - 1: int(sign) for number, sign in flips.items()}
