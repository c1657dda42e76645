"""Hypotheses on the eigenfunctions of two shapes: their order, their signs, and the mixing of near-equal ones.

A hypothesis is an orthogonal matrix: column i holds the source's function i in terms of the target's functions. A
beam search over signed places begins it, a few rounds of ascent on the agreement of the moment tensors turn it inside
near-equal eigenvalues, and level by level it grows from 8 to 16 functions, because the dense refinement that follows
drifts to mirrored maps if it starts from fewer.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...progress import Progress, section, silent
from ...surface.mesh import Floats, Ints
from ...surface.ties import evened
from .moments import Moments, agreement, agreement_gradient
from .spectral_shape import SpectralShape

# A function may move by this many places; on posed characters none was seen to move farther.
WINDOW = 2
# How far eigenvalues may differ for two functions to mix: the standard deviation of the logarithm of their ratio.
MIXING = 0.35
# How much of the previous round stays in the next one; without it the ascent may swing to and fro.
INERTIA = 0.3
POLISHING_ROUNDS = 20
SEARCHING = "Searching order and signs"
# Signed assignments kept when a hypothesis is continued to the next level.
CONTINUED_WIDTH = 16
# Two hypotheses are one if their matrices agree on this share of the functions.
SAME_HYPOTHESIS = 0.95


@dataclass(frozen=True, eq=False)
class Effort:
    """Widths of the search.

    Attributes
    ----------
    levels : tuple of int
        Numbers of functions, rising.
    beam_width : int
        Signed assignments kept from one function to the next on the first level.
    n_seeds : int
        Distinct hypotheses kept on the first level.
    n_branches : int
        Distinct continuations of each hypothesis to the next level.
    n_kept : int
        Hypotheses kept on every later level.
    n_refined : int
        Hypotheses that go into the dense refinement.
    """

    levels: tuple[int, ...] = (8, 12, 16)
    beam_width: int = 300
    n_seeds: int = 10
    n_branches: int = 3
    n_kept: int = 8
    n_refined: int = 6


@dataclass(frozen=True, eq=False)
class Spectrum:
    """The eigenvalues and moments of a shape, without the constant: all that hypotheses are made of.

    Attributes
    ----------
    values : (K,) float64
    moments : Moments
    marks : (p, K) float64
        Functions at the points that are to go to those of the same row of the other shape.
    """

    values: Floats
    moments: Moments
    marks: Floats

    def damped_marks(self, n_functions: int) -> Floats:
        """Return (p, n) the marks in the space where distances are commute times, at norm 1."""
        scaled = self.marks[:, :n_functions] / np.sqrt(self.values[:n_functions])
        return scaled / max(float(np.linalg.norm(scaled)), np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Hypotheses:
    """Some hypotheses on K functions, best first.

    Attributes
    ----------
    maps : (h, K, K) float64
        Orthogonal, target x source.
    symmetric, alternating : (h,) float64
        Agreement of the two kinds of moment tensors, 1 at best.
    marks : (h,) float64
        Agreement of the marks, 1 at best; 0 if there are none.
    """

    maps: Floats
    symmetric: Floats
    alternating: Floats
    marks: Floats

    def __len__(self) -> int:
        return len(self.maps)

    @property
    def total(self) -> Floats:
        """(h,) all agreements together, 2 at best without marks."""
        return self.symmetric + self.alternating + self.marks

    def best(self, n_wanted: int) -> "Hypotheses":
        """Return the first few."""
        return self.take(np.arange(min(n_wanted, len(self))))

    def take(self, chosen: Ints) -> "Hypotheses":
        """Return some of them, in the order given."""
        return Hypotheses(self.maps[chosen], self.symmetric[chosen], self.alternating[chosen], self.marks[chosen])


def spectrum_of(shape: SpectralShape, marked: Ints | None = None) -> Spectrum:
    """Return the part of a shape that hypotheses are made of, with marks at some of its points."""
    moments = shape.moments
    first = slice(1, 1 + len(moments.symmetric))
    return Spectrum(shape.values[first], moments, shape.functions[[] if marked is None else marked, first])


def find_hypotheses(
    source: Spectrum,
    target: Spectrum,
    effort: Effort,
    signs: Mapping[int, int] | None = None,
    progress: Progress = silent,
) -> Hypotheses:
    """Return hypotheses on the functions of the last level, best first.

    Parameters
    ----------
    source, target : Spectrum
    effort : Effort
    signs : mapping of int to +1 or -1, optional
        Signs that are given, by the source's function (from 0); the refinement may still leave them.
    progress : Progress, optional
        Told several times a second; may raise `Cancelled`.
    """
    signs = signs or {}
    n_available = min(len(source.values), len(target.values))
    levels = sorted({min(level, n_available) for level in effort.levels})
    steps = [section(progress, k / len(levels), (k + 1) / len(levels)) for k in range(len(levels))]
    searching, polishing = section(steps[0], 0, 0.5), section(steps[0], 0.5, 1)
    assignments = _beam(_Level(source, target, levels[0]), effort.beam_width, signs, progress=searching)
    seeds = _polish(_completed(*assignments, levels[0]), source, target, polishing)
    hypotheses = seeds.take(_distinct(seeds.maps, np.arange(len(seeds)), effort.n_seeds))
    for level, step in zip(levels[1:], steps[1:], strict=True):
        hypotheses = _extend(hypotheses, _Level(source, target, level), effort, signs, step)
    return hypotheses.take(np.argsort(-evened(hypotheses.total), kind="stable"))


class _Level:
    """The functions of both shapes on one level, the target's with the places a function may move by."""

    def __init__(self, source: Spectrum, target: Spectrum, n_functions: int) -> None:
        self.source, self.target, self.n_functions = source, target, n_functions
        self.source_values = source.values[:n_functions]
        self.target_values = target.values[: n_functions + WINDOW]
        self.source_moments = source.moments.damped(self.source_values)
        self.target_moments = target.moments.damped(self.target_values)
        self.source_marks = source.damped_marks(n_functions)
        self.target_marks = target.damped_marks(n_functions + WINDOW)


def _beam(
    level: _Level,
    width: int,
    signs: Mapping[int, int],
    known: Floats | None = None,
    progress: Progress = silent,
) -> tuple[Ints, Floats]:
    """Return (b, K) places and signs of the best signed assignments, best first.

    ``known`` is a map of the first functions that is not to be touched any more.
    """
    n_known = 0 if known is None else len(known)
    moments, marks = level.source_moments, level.source_marks
    if known is not None:
        rotation = np.eye(level.n_functions)
        rotation[:n_known, :n_known] = known
        moments, marks = moments.rotated(rotation), marks @ rotation.T
    places, sign = np.arange(n_known)[None], np.ones((1, n_known))
    for function in range(n_known, level.n_functions):
        progress((function - n_known) / (level.n_functions - n_known), SEARCHING)
        places, sign = _branch(places, sign, len(level.target_values), signs.get(function))
        order = np.argsort(-evened(_score(places, sign, level, moments, marks)), kind="stable")[:width]
        places, sign = places[order], sign[order]
    return places, sign


def _branch(places: Ints, sign: Floats, n_places: int, given_sign: int | None) -> tuple[Ints, Floats]:
    """Extend every assignment by the next function in all ways: each free place near by, each sign."""
    function = places.shape[1]
    near = np.arange(max(0, function - WINDOW), min(n_places, function + WINDOW + 1))
    # Between equally good assignments the earlier one is taken: rather one that keeps signs.
    choices = np.array([1.0, -1.0]) if given_sign is None else np.array([float(given_sign)])
    step_place, step_sign = np.repeat(near, len(choices)), np.tile(choices, len(near))
    n_before, n_steps = len(places), len(step_place)
    is_free = (np.repeat(places, n_steps, axis=0) != np.tile(step_place, n_before)[:, None]).all(axis=1)
    longer = np.column_stack([np.repeat(places, n_steps, axis=0), np.tile(step_place, n_before)])
    signed = np.column_stack([np.repeat(sign, n_steps, axis=0), np.tile(step_sign, n_before)])
    return longer[is_free], signed[is_free]


def _score(places: Ints, sign: Floats, level: _Level, moments: Moments, marks: Floats) -> Floats:
    """Return (b,) the agreement of the moments, eigenvalues and marks under assignments; 2 is best without marks."""
    n = places.shape[1]
    assigned = places[:, :, None, None], places[:, None, :, None], places[:, None, None, :]
    cube = sign[:, :, None, None] * sign[:, None, :, None] * sign[:, None, None, :]
    total = np.zeros(len(places))
    for source, target in (
        (moments.symmetric, level.target_moments.symmetric),
        (moments.alternating, level.target_moments.alternating),
    ):
        total += _similarity(source[:n, :n, :n], target[assigned] * cube)
    stretch = np.abs(np.log(level.source_values[:n]) - np.log(level.target_values)[places])
    total += np.einsum("pk,pbk,bk->b", marks[:, :n], level.target_marks[:, places], sign)
    return total - stretch.mean(axis=1)


def _similarity(one: Floats, many: Floats) -> Floats:
    """Return 1 where tensors are equal, -1 where opposite, less where their norms differ."""
    product = np.einsum("ijk,hijk->h", one, many)
    return 2 * product / ((one * one).sum() + np.einsum("hijk,hijk->h", many, many) + 1e-12)


def _completed(places: Ints, sign: Floats, level: int) -> Floats:
    """Return (b, K, K) orthogonal matrices: assignments to places beyond the level are filled by what is left over."""
    maps = np.broadcast_to(1e-6 * np.eye(level), (len(places), level, level)).copy()
    row, function = np.nonzero(places < level)
    maps[row, places[row, function], function] += sign[row, function]
    return nearest_orthogonal(maps)


def nearest_orthogonal(matrices: Floats) -> Floats:
    """Return the orthogonal matrix nearest to each."""
    left, _, right = np.linalg.svd(matrices, full_matrices=False)
    return left @ right


def _polish(maps: Floats, source: Spectrum, target: Spectrum, progress: Progress) -> Hypotheses:
    """Turn maps uphill on the agreement of the moments, mixing functions of similar eigenvalues only."""
    level = maps.shape[-1]
    source_moments = source.moments.damped(source.values[:level])
    target_moments = target.moments.damped(target.values[:level])
    ratio = np.log(source.values[:level])[None, :] - np.log(target.values[:level])[:, None]
    weight = np.exp(-((ratio / MIXING) ** 2))
    source_marks, target_marks = source.damped_marks(level), target.damped_marks(level)
    pull = target_marks.T @ source_marks
    for done in range(POLISHING_ROUNDS):
        progress(done / POLISHING_ROUNDS, SEARCHING)
        gradient = agreement_gradient(maps, source_moments.symmetric, target_moments.symmetric)
        gradient += agreement_gradient(maps, source_moments.alternating, target_moments.alternating)
        maps = nearest_orthogonal((gradient + pull + INERTIA / np.sqrt(level) * maps) * weight)
    symmetric = agreement(maps, source_moments.symmetric, target_moments.symmetric)
    alternating = agreement(maps, source_moments.alternating, target_moments.alternating)
    return Hypotheses(maps, symmetric, alternating, (maps * pull).sum(axis=(1, 2)))


def _distinct(maps: Floats, order: Ints, n_wanted: int) -> Ints:
    """Return the first few of maps in an order, without those that nearly repeat an earlier one."""
    kept: list[int] = []
    overlap = np.einsum("hab,gab->hg", maps, maps) / maps.shape[-1]
    for number in order.tolist():
        if len(kept) == n_wanted:
            break
        if not (overlap[number, kept] > SAME_HYPOTHESIS).any():
            kept.append(number)
    return np.array(kept, dtype=np.int64)


def _extend(
    shorter: Hypotheses, level: _Level, effort: Effort, signs: Mapping[int, int], progress: Progress
) -> Hypotheses:
    """Return the best continuations of hypotheses to the next level."""
    starts, parent = [], []
    for number, known in enumerate(shorter.maps):
        progress(0.5 * number / len(shorter), SEARCHING)
        places, sign = _beam(level, CONTINUED_WIDTH, signs, known)
        wider = np.eye(level.n_functions)
        wider[: len(known), : len(known)] = known
        n_tried = 2 * effort.n_branches
        starts.append(_completed(places[:n_tried], sign[:n_tried], level.n_functions) @ wider)
        parent.append(np.full(len(starts[-1]), number))
    polished = _polish(np.concatenate(starts), level.source, level.target, section(progress, 0.5, 1))
    chosen = _limit_per_parent(polished, np.concatenate(parent), effort.n_branches)
    return polished.take(chosen[: effort.n_kept])


def _limit_per_parent(polished: Hypotheses, parent: Ints, n_branches: int) -> Ints:
    """Return distinct hypotheses, best first, at most a few of one parent."""
    order = _distinct(polished.maps, np.arange(len(polished)), len(polished))
    chosen = np.concatenate([order[parent[order] == number][:n_branches] for number in np.unique(parent)])
    return chosen[np.argsort(-evened(polished.total[chosen]), kind="stable")]
