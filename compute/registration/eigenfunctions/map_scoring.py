"""Scores of hypotheses: every one is refined to a map of points, which can be measured as geometry."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...progress import Progress, silent
from ...surface.mesh import Floats, Ints
from ...surface.ties import evened
from .hypotheses import nearest_orthogonal, spectrum_of
from .moments import agreement
from .spectral_shape import SpectralShape
from .zoomout import MATCHING_SIZES, nearest_points, sample_functions, with_constant, zoom_out

# Two candidates are one if their maps of the first functions differ by less, relative to the identity's norm.
SAME_MAP = 0.3
COMPARED_FUNCTIONS = 10
# Costs below this say nothing: a shape fits itself in all ways its symmetry allows, up to the triangulation.
LEAST_COST = 3e-9
# Neighbouring points that land more than this many times farther apart are torn from each other.
TORN = 3.0
# What no map does without: at 1000 samples single points near thin features always are.
USUAL_TEARING = 0.003
NEIGHBOURS = 6
# Standard deviation of fine curvature, which ranges from -1 to 1, that is the triangulation's: a sphere has as much.
CURVATURE_NOISE = 0.15
# Below this share of triangles that keep their orientation a map is torn or inside out.
LEAST_ORIENTED = 0.3


@dataclass(frozen=True, eq=False)
class Candidate:
    """A hypothesis after refinement, with its scores.

    Attributes
    ----------
    start : (K, K) float64
        The hypothesis.
    functional_map : (k, k) float64
        Refined, target x source, the constant included.
    nearest : (s,) int64
        For each of the target's samples, the source's sample (its place in ``samples``) that it is mapped to.
    symmetric, alternating : float
        Agreement of the moments after refinement, 1 at best: of all that is measured here, the one that separates
        right from wrong most often.
    commutation : float
        How far the map is from commuting with the Laplace operator: 0 for an isometry.
    orientation : float
        Area-weighted agreement of the mapped triangles' normals, from -1 to 1.
    curvature : float
        Correlation of the mean curvature, from -1 to 1; it tells front from back, where the alternating moments
        are blind.
    tearing : float
        Share of neighbouring points that are torn apart, from 0 to 1; swapped arms on the right body show here.
    handicap : float
        Factor of the cost, greater the farther the map is off given points.
    """

    start: Floats
    functional_map: Floats
    nearest: Ints
    symmetric: float
    alternating: float
    commutation: float
    orientation: float
    curvature: float
    tearing: float
    handicap: float = 1.0

    @cached_property
    def cost(self) -> float:
        """Small for good maps; the factors are what separates right from wrong on posed characters."""
        moments = (1.02 - self.symmetric) * (1.02 - self.alternating)
        geometry = (2 - self.orientation) * (1.05 - self.curvature) * (USUAL_TEARING + self.tearing)
        return self.commutation * moments * geometry * self.handicap + LEAST_COST * (self.handicap - 1)

    @property
    def is_torn(self) -> bool:
        """Whether the map is torn or inside out."""
        return self.orientation < LEAST_ORIENTED


def ranked(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return candidates, the least costly first and torn maps last; of equally good ones the earlier first."""
    cost = evened(np.array([candidate.cost for candidate in candidates]))
    is_torn = np.array([candidate.is_torn for candidate in candidates])
    order = np.lexsort((cost, is_torn))
    return [candidates[number] for number in order.tolist()]


def distinct_candidates(best_first: Sequence[Candidate], n_wanted: int) -> list[Candidate]:
    """Return the first few candidates that differ from all better ones."""
    kept: list[Candidate] = []
    for candidate in best_first:
        if len(kept) == n_wanted:
            break
        if all(distance_of(candidate.functional_map, better.functional_map) > SAME_MAP for better in kept):
            kept.append(candidate)
    return kept


def distance_of(one: Floats, other: Floats) -> float:
    """Return how far two maps, the constant included, are apart on the first functions; the identity's norm is 1."""
    first = slice(1, min(1 + COMPARED_FUNCTIONS, len(one), len(other)))
    gap = one[first, first] - other[first, first]
    return float(np.linalg.norm(gap) / np.sqrt(len(gap)))


class MapScorer:
    """Refines and scores hypotheses for one pair of shapes; keeps what all of them need.

    Parameters
    ----------
    source, target : SpectralShape
    n_samples : int, optional
        How many samples of either to use, of all that there are; they are spread as evenly. Fewer make rougher maps,
        sooner.
    """

    def __init__(self, source: SpectralShape, target: SpectralShape, n_samples: int | None = None) -> None:
        sizes = [min(size, source.n_functions, target.n_functions) for size in MATCHING_SIZES]
        self._source, self._target, self._sizes = source, target, sizes
        self._places = source.samples[:n_samples], target.samples[:n_samples]
        self._source_samples = sample_functions(source.functions[self._places[0]], ())
        self._target_samples = sample_functions(target.functions[self._places[1]], sizes)
        self._spectra = spectrum_of(source), spectrum_of(target)
        last = max(sizes)
        self._positions = source.project(source.positions)[:last]
        self._neighbours = _neighbours(target, self._places[1])
        self._normals = source.project(source.normals)[:last]
        self._fine_curvature: dict[Candidate, float] = {}

    def score(
        self, starts: Floats, signs: Mapping[int, int] | None = None, progress: Progress = silent
    ) -> list[Candidate]:
        """Return a candidate for each hypothesis, in their order.

        Parameters
        ----------
        starts : (h, K, K) float64
            The hypotheses, orthogonal maps of the first functions, the constant left out.
        signs : mapping of int to +1 or -1, optional
            Signs that are kept whatever fits better, by the source's function from 0.
        progress : Progress, optional
            May raise `Cancelled`.
        """
        candidates = []
        for number, start in enumerate(starts):
            progress(number / len(starts), "Refining what was found")
            candidates.append(self._candidate(start, signs or {}))
        return candidates

    def fine_curvature(self, candidate: Candidate) -> float:
        """Return the correlation of fine curvature over the map of a candidate, from -1 to 1; it is kept."""
        if candidate not in self._fine_curvature:
            source, samples = self._source, self._places[1]
            nearest = nearest_points(candidate.functional_map, source.functions, self._target.functions[samples])
            curvature = source.fine_curvature[nearest], self._target.fine_curvature[samples]
            self._fine_curvature[candidate] = _correlation(*curvature, noise=CURVATURE_NOISE)
        return self._fine_curvature[candidate]

    def _candidate(self, start: Floats, signs: Mapping[int, int]) -> Candidate:
        source, target = self._source_samples, self._target_samples
        refined = zoom_out(with_constant(start), source, target, self._sizes, signs)
        nearest = nearest_points(refined, source.functions, target.functions)
        symmetric, alternating = self._moments(refined, len(start))
        return Candidate(
            start=start,
            functional_map=refined,
            nearest=nearest,
            symmetric=symmetric,
            alternating=alternating,
            commutation=self._commutation(refined),
            orientation=self._orientation(refined),
            curvature=self._curvature(nearest),
            tearing=self._tearing(nearest),
        )

    def _moments(self, functional_map: Floats, level: int) -> tuple[float, float]:
        """Return the agreement of the moments under the refined map, made orthogonal, of a hypothesis' functions."""
        rotation = nearest_orthogonal(functional_map[1 : level + 1, 1 : level + 1])
        source, target = (spectrum.moments.damped(spectrum.values[:level]) for spectrum in self._spectra)
        symmetric = agreement(rotation, source.symmetric, target.symmetric)
        return float(symmetric), float(agreement(rotation, source.alternating, target.alternating))

    def _commutation(self, functional_map: Floats) -> float:
        n_target, n_source = functional_map.shape
        source_values, target_values = self._source.values[:n_source], self._target.values[:n_target, None]
        commutator = functional_map * source_values - target_values * functional_map
        return float((commutator**2).sum() / (source_values**2).sum())

    def _orientation(self, functional_map: Floats) -> float:
        """Compare the normals of the target's triangles, mapped to the source, with the normals of the source."""
        target = self._target
        coefficients = np.hstack([functional_map @ self._positions, functional_map @ self._normals])
        mapped = target.functions[:, : len(functional_map)] @ coefficients
        a, b, c = mapped[target.triangles].swapaxes(0, 1)
        side = np.einsum("ij,ij->i", np.cross((b - a)[:, :3], (c - a)[:, :3]), (a + b + c)[:, 3:])
        return float((target.areas * np.sign(side)).sum() / target.areas.sum())

    def _curvature(self, nearest: Ints) -> float:
        here, there = self._places
        return _correlation(self._source.curvature[here][nearest], self._target.curvature[there])

    def _tearing(self, nearest: Ints) -> float:
        pairs, length = self._neighbours
        mapped = self._source.positions[self._places[0][nearest]]
        mapped_length = np.linalg.norm(mapped[pairs[:, 0]] - mapped[pairs[:, 1]], axis=1)
        return float((mapped_length > TORN * length).mean()) if len(pairs) else 0.0


def _neighbours(shape: SpectralShape, samples: Ints) -> tuple[Ints, Floats]:
    """Return pairs of samples that lie side by side, not across a thin part, and their distances."""
    positions, normals = shape.positions[samples], shape.normals[samples]
    n_near = min(NEIGHBOURS + 1, len(positions))
    near = cKDTree(positions).query(positions, n_near)[1][:, 1:]
    pairs = np.stack([np.repeat(np.arange(len(positions)), n_near - 1), near.ravel()], axis=1)
    pairs = pairs[np.einsum("ij,ij->i", normals[pairs[:, 0]], normals[pairs[:, 1]]) > 0]
    return pairs, np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)


def _correlation(one: Floats, other: Floats, noise: float = 0.0) -> float:
    """Return the correlation, from -1 to 1, with noise of a given size added to both: less where they hardly vary."""
    one, other = one - one.mean(), other - other.mean()
    floor = noise**2 * len(one) + np.finfo(float).tiny
    return float(one @ other / (np.sqrt(one @ one + floor) * np.sqrt(other @ other + floor)))
