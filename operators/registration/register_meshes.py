"""The work of registering meshes; knows nothing of Blender, so any thread may do it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ... import compute
from ..jobs import recent_analyses
from ..jobs.recent_results import Recent, key_of
from ..mesh_data.mesh_arrays import MeshArrays
from ..mesh_state.state import StoredAnalysis
from ..messages.user_errors import Refusal, in_name_of
from ..parts.analyze import Outcome, outcome_of

# Functions whose signs can be given, and that are shown.
SHOWN_FUNCTIONS = 8
CORRECTED_BEFORE = (
    "{} was corrected by hand, and then edited, cut or analyzed with other settings; "
    "analyze it with these settings first, so that all get its corrections."
)
Progress = Callable[[float, str], None]
# Of shapes that are kept: points, 1 kB of memory each. Of matchings: how many.
RECENT_POINTS = 100_000
RECENT_MATCHINGS = 32
# How much of the time of examining a mesh its analysis takes.
ANALYSIS_SHARE = 0.6

_recent_shapes = Recent(RECENT_POINTS)
_recent_matchings = Recent(RECENT_MATCHINGS)


@dataclass(frozen=True, eq=False)
class Subject:
    """A mesh to register, or the reference.

    Attributes
    ----------
    name : str
        Of the object, for the user.
    arrays : MeshArrays
    options : dict
        Keyword arguments of the engine's analysis.
    """

    name: str
    arrays: MeshArrays
    options: dict[str, Any]


@dataclass(frozen=True)
class Wish:
    """What the user asks of a matching.

    Attributes
    ----------
    flips : mapping of int to +1 or -1
        The signs of some of the reference's functions, from 1.
    alternative : int
        0 for the best matching.
    mirrored : bool
        Match the mirror image of the reference.
    """

    flips: Mapping[int, int] = field(default_factory=dict)
    alternative: int = 0
    mirrored: bool = False


@dataclass(frozen=True, eq=False)
class Shown:
    """The parts that a reference shows: its level, mode and analysis, with what was corrected; None for the default."""

    level: int | None
    mode: str
    analysis: StoredAnalysis | None


@dataclass(frozen=True, eq=False)
class Examined:
    """An analyzed mesh, ready to be matched.

    Attributes
    ----------
    key : str
        Equal for equal meshes and options.
    shape : Divisible
    outcome : Outcome
    """

    key: str
    shape: compute.Divisible
    outcome: Outcome


@dataclass(frozen=True, eq=False)
class Found:
    """A mesh registered.

    Attributes
    ----------
    outcome : Outcome
    labels : FaceLabels
        The parts of the reference on the faces of this mesh.
    matching : Matching
    alternative, n_alternatives : int
    by_diagrams : tuple of int
        What persistence diagrams alone say of the reference's first functions: the number of the function that each is
        here, negative where negated; 0 where they do not tell the sign.
    """

    outcome: Outcome
    labels: compute.FaceLabels
    matching: compute.Matching
    alternative: int
    n_alternatives: int
    by_diagrams: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Registration:
    """All meshes registered: what the reference's analysis leaves, its level, and each of the others."""

    reference: Outcome
    level: int
    found: tuple[Found, ...]


def register_subjects(
    reference: Subject, shown: Shown, targets: list[Subject], wish: Wish, first_free: int, progress: Progress
) -> Registration:
    """Analyze all meshes and divide the targets into the parts of the reference.

    Parameters
    ----------
    first_free : int
        The least label for parts without a partner on the reference.
    """
    n_steps = 2 * len(targets) + 1
    # All are analyzed first: what cannot be is told before the longer part begins.
    own, *others = (_examine(target, _step(progress, k, n_steps)) for k, target in enumerate((reference, *targets)))
    labels, faces = _division(shown, own, reference.name)
    prepared = compute.with_parts(own.shape, faces, labels.parts, labels.level)
    first_free = max(first_free, int(labels.parts.id.max()) + 1)
    found = []
    for number, (subject, other) in enumerate(zip(targets, others, strict=True)):
        told = compute.naming(_step(progress, len(targets) + 1 + number, n_steps), subject.name)
        matching = _match(prepared, own.key, other, wish, told)
        carrying = compute.section(told, 0.7, 1)
        found.append(_register(prepared, other.shape, other.outcome, matching, wish, first_free, carrying))
        first_free = max(first_free, int(found[-1].labels.parts.id.max()) + 1)
    progress(1.0, "Done")
    return Registration(own.outcome, labels.level, tuple(found))


def register_analyzed(
    reference: compute.Reference, target: compute.Analysis, outcome: Outcome, wish: Wish, first_free: int
) -> Found:
    """Return an analyzed mesh divided into the parts of the reference; its own are numbered from ``first_free``."""
    shape = compute.divisible(target, compute.matching_shape(target), outcome.polygon_of_triangle)
    matching = compute.match_divisible(reference, shape, flips=wish.flips, mirrored=wish.mirrored)
    return _register(reference, shape, outcome, matching, wish, first_free, compute.silent)


def _examine(subject: Subject, progress: Progress) -> Examined:
    arrays = subject.arrays
    key = key_of([arrays.vertices, arrays.triangles, arrays.polygon_of_triangle, *_flat(subject.options)])
    known = _recent_shapes.get(key)
    if known is not None:
        return known
    told = compute.naming(progress, subject.name)
    start = time.perf_counter()
    with in_name_of(subject.name):
        analysis = recent_analyses.reuse(arrays, subject.options, compute.section(told, 0, ANALYSIS_SHARE))
        outcome = outcome_of(analysis, arrays, subject.options, time.perf_counter() - start)
        points = compute.matching_shape(analysis, compute.section(told, ANALYSIS_SHARE, 1))
    examined = Examined(key, compute.divisible(analysis, points, arrays.polygon_of_triangle), outcome)
    _recent_shapes.put(key, examined, len(points.positions))
    return examined


def _flat(options: Mapping[str, Any]) -> list[Any]:
    return [item for pair in sorted(options.items()) for item in pair]


def _division(shown: Shown, reference: Examined, name: str) -> tuple[compute.BranchLabels, np.ndarray]:
    """Return the parts that a reference shows, with what was corrected by hand, and the part of each face."""
    part_tree = reference.shape.part_tree
    level = corrections = None
    if shown.analysis is not None and _has_trees(shown.analysis.part_tree.hierarchy, part_tree.hierarchy):
        level, corrections = shown.level, shown.analysis.corrections
        part_tree = replace(part_tree, branches=shown.analysis.part_tree.branches)
    elif shown.analysis is not None and shown.analysis.corrections is not None and shown.analysis.corrections.items:
        raise Refusal(CORRECTED_BEFORE.format(name))
    labels = compute.label_branches(part_tree, level=level, mode=shown.mode, corrections=corrections)
    return labels, labels.of_faces(part_tree).astype(np.int64)


def _has_trees(stored: compute.Hierarchy, hierarchy: compute.Hierarchy) -> bool:
    trees = [[tree.extremum.tolist() for tree in one.trees] for one in (stored, hierarchy)]
    return trees[0] == trees[1] and stored.n_levels == hierarchy.n_levels


def _match(
    reference: compute.Reference, reference_key: str, target: Examined, wish: Wish, progress: Progress
) -> compute.Matching:
    key = key_of([reference_key, target.key, sorted(wish.flips.items()), wish.mirrored])
    known = _recent_matchings.get(key)
    if known is None:
        known = compute.match_divisible(
            reference,
            target.shape,
            flips=wish.flips,
            mirrored=wish.mirrored,
            progress=compute.section(progress, 0, 0.7),
        )
        _recent_matchings.put(key, known, 1)
    return known


def _register(
    reference: compute.Reference,
    target: compute.Divisible,
    outcome: Outcome,
    best: compute.Matching,
    wish: Wish,
    first_free: int,
    progress: Progress,
) -> Found:
    matchings = (best, *best.alternatives)
    alternative = wish.alternative % len(matchings)
    labels = compute.label_matched(reference, target, matchings[alternative], first_free, progress)
    diagrams = compute.match_shape_diagrams(reference.shape.shape, target.shape)
    by_diagrams = np.where(diagrams.is_open, 0, diagrams.signs * (1 + diagrams.order))
    matching, n_others = matchings[alternative], len(matchings) - 1
    return Found(outcome, labels, matching, alternative, n_others, tuple(by_diagrams.tolist()))


def _step(progress: Progress, number: int, n_steps: int) -> Progress:
    """Return a callback whose 0..1 is one of some equal steps."""
    return compute.section(progress, number / n_steps, (number + 1) / n_steps)
