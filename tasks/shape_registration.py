"""Shapes matched with a reference and divided into its parts."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compute
from . import recent_analyses
from .level_choice import LevelChoice
from .match_options import MatchOptions
from .mesh_analysis import AnalysisInput, AnalysisResult, StoredAnalysis, result_of
from .recent_results import Recent, Value, key_of
from .refusals import Refusal, in_name_of
from .shared_calls import run_all

CORRECTED_BEFORE = (
    "{} was corrected by hand, and then edited, cut or analyzed with other settings; "
    "analyze it with these settings first, so that all get its corrections."
)

# Of shapes that are kept: points, 1 kB of memory each. Of matchings: how many.
RECENT_POINTS = 100_000
RECENT_MATCHINGS = 128
# How much of the time of preparing a mesh its analysis takes.
ANALYSIS_SHARE = 0.6
# Where in the time of registering meshes the first, the next and the last stage end.
STAGES = (0.0, 0.4, 0.8, 1.0)

_recent_shapes: Recent[MatchableShape] = Recent("shapes", RECENT_POINTS)
_recent_matchings: Recent[compute.Matching] = Recent("matchings", RECENT_MATCHINGS)


@dataclass(frozen=True, eq=False)
class ShownParts:
    """The parts that a reference is to show.

    Attributes
    ----------
    mode : str
        How levels are read.
    choice : LevelChoice
        One of ``level``, ``threshold`` and ``n_parts``; the level that the mesh shows if empty.
    level : int or None
        The level that it shows, None if it shows none.
    analysis : StoredAnalysis or None
        The one that it shows, with what was corrected.
    """

    mode: str
    choice: LevelChoice
    level: int | None = None
    analysis: StoredAnalysis | None = None


@dataclass(frozen=True, eq=False)
class MatchableShape:
    """An analyzed mesh, ready to be matched.

    Attributes
    ----------
    key : str
        Equal for equal meshes and options.
    shape : Divisible
    result : AnalysisResult
    """

    key: str
    shape: compute.Divisible
    result: AnalysisResult


@dataclass(frozen=True, eq=False)
class PreparedReference:
    """The mesh whose parts all others get.

    Attributes
    ----------
    name : str
        Of the object.
    key : str
        Equal for equal meshes and options.
    result : AnalysisResult
    level : int
    mode : str
    matched : Reference
        Its shape and parts, as others are matched with them.
    """

    name: str
    key: str
    result: AnalysisResult
    level: int
    mode: str
    matched: compute.Reference

    @property
    def highest_label(self) -> int:
        """The last of the labels that all share."""
        return self.matched.parts.given.highest


@dataclass(frozen=True, eq=False)
class MatchedPair:
    """A reference and a mesh that is matched with it.

    Attributes
    ----------
    name : str
        Of the object.
    reference : PreparedReference
    target : MatchableShape
    best : Matching
    options : MatchOptions
    """

    name: str
    reference: PreparedReference
    target: MatchableShape
    best: compute.Matching
    options: MatchOptions

    @property
    def alternative(self) -> int:
        """Which matching is chosen, 0 for the best."""
        return self.options.alternative % (1 + len(self.best.alternatives))

    @property
    def matching(self) -> compute.Matching:
        """The one that is chosen."""
        return (self.best, *self.best.alternatives)[self.alternative]


@dataclass(frozen=True, eq=False)
class RegisteredShape:
    """A mesh divided into the parts of a reference.

    Attributes
    ----------
    name : str
        Of the object.
    result : AnalysisResult
    labels : FaceLabels
        The parts of the reference on the faces of this mesh.
    matching : Matching
    alternative, n_alternatives : int
    by_diagrams : tuple of int
        What persistence diagrams alone say of the reference's first functions: the number of the function that each is
        here, negative where negated; 0 where they do not tell the sign.
    """

    name: str
    result: AnalysisResult
    labels: compute.FaceLabels
    matching: compute.Matching
    alternative: int
    n_alternatives: int
    by_diagrams: tuple[int, ...]

    @property
    def highest_label(self) -> int:
        """The last label, of a part of the reference or of its own."""
        return int(self.labels.parts.id.max())


@dataclass(frozen=True, eq=False)
class Registration:
    """A reference with all that were registered to it."""

    reference: PreparedReference
    shapes: tuple[RegisteredShape, ...]


def register_all(
    reference: AnalysisInput,
    shown: ShownParts,
    targets: list[AnalysisInput],
    options: list[MatchOptions],
    first_free: int,
    progress: compute.Progress,
) -> Registration:
    """Analyze all meshes and divide the targets into the parts of the reference; what is known is used again.

    Parameters
    ----------
    options : list of MatchOptions
        One for each target.
    first_free : int
        The least label for parts without a partner on the reference.
    """
    analyzing, matching, dividing = (compute.section(progress, *ends) for ends in pairwise(STAGES))
    # All are analyzed first: what cannot be is told before the longer part begins.
    meshes = [(given,) for given in (reference, *targets)]
    keys = [_key_of(given) for (given,) in meshes]
    source, *others = _recall_all(_recent_shapes, keys, _new_shape, meshes, analyzing)
    prepared = prepare_reference(reference.name, source, shown)
    matchings = match_all(prepared, others, options, matching)
    first_free = max(first_free, prepared.highest_label + 1)
    pairs = [
        (MatchedPair(given.name, prepared, target, best, chosen),)
        for given, target, best, chosen in zip(targets, others, matchings, options, strict=True)
    ]
    shapes: list[RegisteredShape] = []
    for (pair,), to_reference in zip(pairs, run_all(_map_to_reference, pairs, dividing), strict=True):
        shapes.append(_divide(pair, to_reference, first_free))
        first_free = max(first_free, shapes[-1].highest_label + 1)
    progress(1.0, "Done")
    return Registration(prepared, tuple(shapes))


def match_all(
    reference: PreparedReference,
    targets: list[MatchableShape],
    options: list[MatchOptions],
    progress: compute.Progress,
) -> list[compute.Matching]:
    """Return the best matchings of a reference with targets, such that they agree with each other, and keep them.

    What the user chose stays as it is.
    """
    matching, agreeing = compute.section(progress, 0, 0.5), compute.section(progress, 0.5, 1)
    pairs = [(reference, target, chosen) for target, chosen in zip(targets, options, strict=True)]
    keys = [_key_of_pair(reference.key, target, chosen) for _, target, chosen in pairs]
    own = _recall_all(_recent_matchings, keys, _new_matching, pairs, matching)
    if any(chosen.flips or chosen.alternative for chosen in options):
        return own

    def match_pairs(pairs: list[tuple[int, int]], progress: compute.Progress) -> list[compute.Matching]:
        links = [(targets[one], targets[two]) for one, two in pairs]
        keys = [_key_of_pair(source.key, target, MatchOptions()) for source, target in links]
        return _recall_all(_recent_matchings, keys, _new_link, links, progress)

    shapes = [target.shape for target in targets]
    agreed = compute.agreed_matchings(reference.matched, shapes, own, match_pairs, agreeing)
    for key, found in zip(keys, agreed, strict=True):
        _recent_matchings.put(key, found, 1)
    return agreed


def matchable_shape(
    given: AnalysisInput,
    progress: compute.Progress,
    analysis_of: Callable[..., compute.Analysis] = recent_analyses.analyze,
) -> MatchableShape:
    """Return an analyzed mesh, ready to be matched."""
    start = time.perf_counter()
    analysis = analysis_of(given.arrays, given.options, compute.section(progress, 0, ANALYSIS_SHARE))
    result = result_of(analysis, given, time.perf_counter() - start)
    points = compute.matching_shape(analysis, compute.section(progress, ANALYSIS_SHARE, 1))
    return MatchableShape(_key_of(given), compute.divisible(analysis, points, given.arrays.polygon_of_triangle), result)


def prepare_reference(name: str, source: MatchableShape, shown: ShownParts) -> PreparedReference:
    """Return a reference with the parts that it is to show, and what was corrected by hand.

    Raises
    ------
    Refusal
        If it was corrected by hand in another analysis.
    """
    part_tree, choice, corrections = source.shape.part_tree, shown.choice, None
    if shown.analysis is not None and _has_trees(shown.analysis.part_tree.hierarchy, part_tree.hierarchy):
        part_tree = replace(part_tree, branches=shown.analysis.part_tree.branches)
        corrections = shown.analysis.corrections
        if not choice and shown.level is not None:
            choice = {"level": shown.level}
    elif shown.analysis is not None and shown.analysis.corrections is not None and shown.analysis.corrections.items:
        raise Refusal(CORRECTED_BEFORE.format(name))
    labels = compute.label_branches(part_tree, mode=shown.mode, corrections=corrections, **choice)
    faces = labels.of_faces(part_tree).astype(np.int64)
    matched = compute.with_parts(source.shape, faces, labels.parts, labels.level)
    return PreparedReference(
        name=name, key=source.key, result=source.result, level=labels.level, mode=shown.mode, matched=matched
    )


def divide(pair: MatchedPair, first_free: int, progress: compute.Progress) -> RegisteredShape:
    """Return a target divided by the matching that was chosen."""
    return _divide(pair, _map_to_reference(pair, progress), first_free)


def _map_to_reference(pair: MatchedPair, progress: compute.Progress) -> NDArray[np.int64]:
    """Return the point of the reference that each point of the target corresponds to: most of the time of dividing."""
    naming = compute.naming(progress, pair.name)
    return compute.map_to_reference(pair.reference.matched, pair.target.shape, pair.matching, naming)


def _divide(pair: MatchedPair, to_reference: NDArray[np.int64], first_free: int) -> RegisteredShape:
    reference, target, matching = pair.reference.matched, pair.target, pair.matching
    labels = compute.label_mapped(reference, target.shape, matching, to_reference, first_free)
    diagrams = compute.match_shape_diagrams(reference.shape.shape, target.shape.shape)
    return RegisteredShape(
        name=pair.name,
        result=target.result,
        labels=replace(labels, warnings=(*labels.warnings, *pair.options.point_warnings(matching))),
        matching=matching,
        alternative=pair.alternative,
        n_alternatives=len(pair.best.alternatives),
        by_diagrams=tuple(np.where(diagrams.is_open, 0, diagrams.signs * (1 + diagrams.order)).tolist()),
    )


def _recall_all(
    recent: Recent[Value],
    keys: list[str],
    make: Callable[..., Value],
    arguments: Sequence[tuple[Any, ...]],
    progress: compute.Progress,
) -> list[Value]:
    """Return what is at hand under some keys; what is not is made and kept, in several processes if there are."""
    known = {key: value for key in keys if (value := recent.get(key)) is not None}
    missing = {key: given for key, given in zip(keys, arguments, strict=True) if key not in known}
    known |= zip(missing, run_all(make, list(missing.values()), progress), strict=True)
    return [known[key] for key in keys]


def _new_shape(given: AnalysisInput, progress: compute.Progress) -> MatchableShape:
    with in_name_of(given.name):
        new = matchable_shape(given, compute.naming(progress, given.name), recent_analyses.reuse)
    _recent_shapes.put(new.key, new, len(new.shape.shape.positions))
    return new


def _key_of(given: AnalysisInput) -> str:
    arrays = given.arrays
    options = [item for pair in sorted(given.options.items()) for item in pair]
    return key_of([arrays.vertices, arrays.triangles, arrays.polygon_of_triangle, *options])


def _has_trees(stored: compute.Hierarchy, hierarchy: compute.Hierarchy) -> bool:
    trees = [[tree.extremum.tolist() for tree in one.trees] for one in (stored, hierarchy)]
    return trees[0] == trees[1] and stored.n_levels == hierarchy.n_levels


def _new_matching(
    reference: PreparedReference, target: MatchableShape, options: MatchOptions, progress: compute.Progress
) -> compute.Matching:
    new = compute.match_divisible(
        reference.matched,
        target.shape,
        points=options.points.vertices,
        flips=options.flips,
        mirrored=options.mirrored,
        progress=progress,
    )
    _recent_matchings.put(_key_of_pair(reference.key, target, options), new, 1)
    return new


def _new_link(source: MatchableShape, target: MatchableShape, progress: compute.Progress) -> compute.Matching:
    """Return the matching of two targets."""
    new = compute.match_members(source.shape, target.shape, progress)
    _recent_matchings.put(_key_of_pair(source.key, target, MatchOptions()), new, 1)
    return new


def _key_of_pair(source: str, target: MatchableShape, options: MatchOptions) -> str:
    return key_of([source, target.key, sorted(options.flips.items()), options.mirrored, *options.points.vertices])
