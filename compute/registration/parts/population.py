"""Registration of any number of shapes at once, through one reference."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ...analysis.analysis import Analysis
from ...choices import FEATURES
from ...errors import RegistrationError
from ...memory import told_if_full
from ...progress import Progress, rising, section, silent
from ...segmentation.parts.part_labels import Parts, Segmentation
from ...surface.mesh import Ints
from ..dense.point_map import point_map
from ..eigenfunctions.given_points import checked_points, point_pairs
from ..eigenfunctions.matching import Matching, match_surfaces, matching_shape
from ..eigenfunctions.pair_memory import require_pair
from ..eigenfunctions.spectral_shape import prepare_shape
from ..eigenfunctions.synchronization import pairs_in_row, synchronized
from .part_matching import ReferenceParts, partner_cuts, reference_parts, with_first_free
from .transferred_labels import Divisible, FaceLabels, divisible, transfer_labels

# Seconds between looks whether shapes in an executor are ready, and whether the user has cancelled.
INTERVAL = 0.05
MATCHED = "Matched {} of {} shapes"
COMPARED = "Compared {} of {} pairs of shapes"
REGISTERED = "Registered {} of {} shapes"
UNSURE = "Its matching is right with a probability of {:.0%} only; look at its parts."
POINTS_OF_EACH = "Points are given as a list: for each shape to register its pairs of vertices, or None."
CONTRADICTS = "Its matching contradicts those of the other shapes; look at its parts."

Result = TypeVar("Result")
# The numbers of two targets, the source first.
NumberedPair: TypeAlias = tuple[int, int]


class Pending(Protocol):
    """A call that an executor runs, as `concurrent.futures.Future` is one."""

    def done(self) -> bool:
        """Whether it has ended."""
        ...

    def result(self) -> Any:
        """Return what it returned, or raise what it raised."""
        ...

    def cancel(self) -> bool:
        """Give it up, if it has not begun."""
        ...


class Executor(Protocol):
    """Runs calls elsewhere, as those of `concurrent.futures` do: declared here, as that module loads threads."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Pending:
        """Call a function elsewhere."""
        ...


@dataclass(frozen=True, eq=False)
class Reference:
    """The shape that all others are registered to.

    Attributes
    ----------
    shape : Divisible
        With its surface, functions and hierarchy.
    parts : ReferenceParts
        The parts to be found on other shapes.
    """

    shape: Divisible
    parts: ReferenceParts


@dataclass(frozen=True, eq=False)
class Registered:
    """One shape, registered.

    Attributes
    ----------
    segmentation : Segmentation
        Equal label = same part as on the reference; larger labels have no partner there.
    matching : Matching
        Of the reference (source) and this shape (target).
    """

    segmentation: Segmentation
    matching: Matching


@told_if_full
def register(
    analyses: Sequence[Analysis],
    *,
    reference: int = 0,
    level: int | None = None,
    points: Sequence[ArrayLike | None] | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> list[Segmentation]:
    """Divide shapes into the same parts.

    Three shapes or more are matched among each other, too, so that a matching that is wrong is put right by the others.

    Parameters
    ----------
    analyses : sequence of Analysis
    reference : int
        Number of the shape that gives the parts, from 0.
    level : int, optional
        Level of the reference whose features are the parts; its default level if None.
    points : sequence of (p, 2) int, optional
        For each of the other shapes, in their order, pairs of vertices that belong together: of the reference and of
        that shape; None for those without.
    executor : concurrent.futures.Executor, optional
        Runs the pairs: threads, processes or a cluster that offers this interface.
    progress : Progress, optional
        Called several times a second; may raise `Cancelled`. Pairs that run in an executor by then are finished there.

    Returns
    -------
    list of Segmentation
        One for each shape: equal label = same part. A part without a partner on the reference has a label that no
        other shape has. One whose matching contradicts those of the others says so among its warnings.

    Raises
    ------
    RegistrationError
        If there is no such shape, or the points are not pairs of vertices for each of the others.
    LevelError
        If the reference has no such level.

    References
    ----------
    .. [1] Reuter, IJCV 2010, sections 4.6 and 4.7.

    Examples
    --------
    >>> from compute import TriangleMesh, analyze, register
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> poses = [analyze(TriangleMesh(square.vertices * [k, 1, 1], square.triangles), order=1) for k in (1, 2)]
    >>> [segmentation.labels.tolist() for segmentation in register(poses)]
    [[0, 0], [0, 0]]
    """
    points_of = _checked_shapes(analyses, reference, points)
    progress = rising(progress or silent)
    progress(0.0, "Preparing the reference")
    reference_segmentation = analyses[reference].segment(level=level, mode=FEATURES)
    prepared = prepare_reference(analyses[reference], reference_segmentation)
    if executor is not None:
        # What goes to other processes is measured once, not in each of them.
        prepare_shape(prepared.shape.shape, with_self_maps=True)
    run = _run_serially if executor is None else partial(_run_in_executor, executor)
    others = [analyses[number] for number in points_of]
    results = _register_all(prepared, others, list(points_of.values()), run, progress)
    segmentations = [result.segmentation for result in results]
    segmentations.insert(reference, reference_segmentation)
    return with_disjoint_labels(segmentations, reference)


@told_if_full
def prepare_reference(analysis: Analysis, segmentation: Segmentation) -> Reference:
    """Return a shape with its parts in the form that others are registered to."""
    shape = divisible(analysis, matching_shape(analysis))
    return with_parts(shape, segmentation.labels.astype(np.int64), segmentation.parts, segmentation.level)


def with_parts(shape: Divisible, labels: Ints, parts: Parts, level: int) -> Reference:
    """Return a shape with a division of its faces in the form that others are registered to."""
    return Reference(shape, reference_parts(labels, parts, level, shape))


def register_one(
    reference: Reference, target: Analysis, points: ArrayLike | None = None, progress: Progress = silent
) -> Registered:
    """Match one shape with the reference and divide it into the same parts."""
    shape, matching = _match_one(reference, target, points, section(progress, 0, 0.8))
    return _divide(reference, shape, matching, section(progress, 0.8, 1))


@told_if_full
def match_divisible(
    reference: Reference,
    target: Divisible,
    *,
    points: ArrayLike | None = None,
    flips: Mapping[int, int] | None = None,
    mirrored: bool = False,
    progress: Progress = silent,
) -> Matching:
    """Match the reference (source) with a target, as `match` does."""
    surfaces = reference.shape.surface, target.surface
    shapes = reference.shape.shape, target.shape
    return match_surfaces(*surfaces, *shapes, points=points, flips=flips, mirrored=mirrored, progress=progress)


@told_if_full
def match_members(source: Divisible, target: Divisible, progress: Progress = silent) -> Matching:
    """Match two targets of one reference, as `match` does."""
    return match_surfaces(source.surface, target.surface, source.shape, target.shape, progress=progress)


def agreed_matchings(
    reference: Reference,
    targets: Sequence[Divisible],
    matchings: Sequence[Matching],
    match_pairs: Callable[[list[NumberedPair], Progress], Sequence[Matching]],
    progress: Progress = silent,
) -> list[Matching]:
    """Return the matchings of a reference with its targets that agree best with those of the targets among each other.

    Parameters
    ----------
    reference : Reference
    targets : sequence of Divisible
    matchings : sequence of Matching
        Of the reference with each target by itself. A single one stays as it is, and so do those by numbers or with
        points that were given.
    match_pairs : callable
        ``match_pairs(pairs, progress)`` matches pairs of targets, given by their numbers, as `match_members` does.
    progress : Progress, optional
        May raise `Cancelled`.
    """
    if len(targets) < 2 or all(matching.same_topology for matching in matchings):
        return list(matchings)
    source = reference.shape.shape.mirrored() if matchings[0].mirrored else reference.shape.shape
    shapes = [target.shape for target in targets]
    pairs = pairs_in_row(source, shapes)
    links = dict(zip(pairs, match_pairs(pairs, section(progress, 0, 0.8)), strict=True))
    return synchronized(source, shapes, matchings, links, section(progress, 0.8, 1))


@told_if_full
def label_matched(
    reference: Reference, target: Divisible, matching: Matching, first_free: int, progress: Progress = silent
) -> FaceLabels:
    """Divide a shape into the parts of the reference by a matching that is known.

    Parameters
    ----------
    first_free : int
        The least label for parts without a partner on the reference.
    progress : Progress, optional
        May raise `Cancelled`.
    """
    to_reference = map_to_reference(reference, target, matching, section(progress, 0, 0.8))
    progress(0.8, "Carrying the parts over")
    return label_mapped(reference, target, matching, to_reference, first_free)


@told_if_full
def map_to_reference(reference: Reference, target: Divisible, matching: Matching, progress: Progress = silent) -> Ints:
    """Return (n,) the point of the reference that each point of a shape corresponds to by a matching."""
    source = reference.shape.shape.mirrored() if matching.mirrored else reference.shape.shape
    pairs = point_pairs(matching.points, reference.shape.surface, target.surface, source, target.shape)
    return point_map(source, target.shape, matching, progress, pairs)


@told_if_full
def label_mapped(
    reference: Reference, target: Divisible, matching: Matching, to_reference: Ints, first_free: int
) -> FaceLabels:
    """Divide a shape into the parts of the reference, which its points are mapped to.

    Parameters
    ----------
    to_reference : (n,) int64
        As ``map_to_reference`` returns it.
    first_free : int
        The least label for parts without a partner on the reference.
    """
    cuts, level = partner_cuts(reference.parts, target, to_reference)
    cuts = with_first_free(cuts, reference.parts.given.highest, first_free)
    same_faces = (
        matching.same_topology
        and np.array_equal(reference.shape.face, target.face)
        and len(reference.shape.graph.stands_for) == len(target.graph.stands_for)
    )
    return transfer_labels(reference.parts.given, target, None if same_faces else to_reference, cuts, level)


def with_disjoint_labels(segmentations: Sequence[Segmentation], reference: int) -> list[Segmentation]:
    """Renumber the parts without a partner, so that no two shapes share such a label."""
    n_shared = int(segmentations[reference].parts.id.max())
    first_free = n_shared + 1
    renumbered = []
    for segmentation in segmentations:
        unshared = np.unique(segmentation.parts.id[segmentation.parts.id > n_shared])
        renumbered.append(_renumbered(segmentation, unshared, first_free) if len(unshared) else segmentation)
        first_free += len(unshared)
    return renumbered


def _renumbered(segmentation: Segmentation, unshared: Ints, first_free: int) -> Segmentation:
    parts = segmentation.parts
    table = np.arange(int(parts.id.max()) + 1)
    table[unshared] = first_free + np.arange(len(unshared))
    new_parts = replace(parts, id=table[parts.id], parent=table[parts.parent])
    return replace(segmentation, labels=table[segmentation.labels].astype(np.int32), parts=new_parts)


def _checked_shapes(
    analyses: Sequence[Analysis], reference: int, points: Sequence[ArrayLike | None] | None
) -> dict[int, Ints]:
    """Return the pairs of points of each shape but the reference; refuse what cannot be matched with that one."""
    if not isinstance(reference, (int, np.integer)) or not 0 <= reference < len(analyses):
        raise RegistrationError(f"There is no shape {reference} to register to; there are {len(analyses)} shapes.")
    others = [number for number in range(len(analyses)) if number != reference]
    if points is None:
        points = [None] * len(others)
    if not isinstance(points, Sequence | np.ndarray):
        raise RegistrationError(POINTS_OF_EACH)
    if len(points) != len(others):
        raise RegistrationError(f"There are points for {len(points)} shapes, and {len(others)} to register.")
    source, checked = analyses[reference], {}
    for number, given in ((reference, None), *zip(others, points, strict=True)):
        try:
            analyses[number].require_one_shape()
            checked[number] = checked_points(given, source.surface, analyses[number].surface)
        except RegistrationError as error:
            raise RegistrationError(f"Shape {number}: {error}") from error
        require_pair(source.surface, analyses[number].surface)
    return {number: checked[number] for number in others}


class _Runner(Protocol):
    """Calls a function with each of some groups of arguments, here or elsewhere."""

    def __call__(
        self, function: Callable[..., Result], arguments: Sequence[tuple[object, ...]], progress: Progress, told: str
    ) -> list[Result]: ...


def _register_all(
    reference: Reference,
    targets: Sequence[Analysis],
    points: Sequence[Ints],
    run: _Runner,
    progress: Progress,
) -> list[Registered]:
    """Match all targets, let the matchings agree, and divide the targets by them."""
    pairs = [(reference, target, given) for target, given in zip(targets, points, strict=True)]
    matched = run(_match_one, pairs, section(progress, 0, 0.5), MATCHED)
    shapes = [shape for shape, _ in matched]

    def match_pairs(pairs: list[NumberedPair], progress: Progress) -> list[Matching]:
        return run(match_members, [(shapes[one], shapes[other]) for one, other in pairs], progress, COMPARED)

    own = [matching for _, matching in matched]
    agreed = agreed_matchings(reference, shapes, own, match_pairs, section(progress, 0.5, 0.8))
    arguments = [(reference, shape, matching) for shape, matching in zip(shapes, agreed, strict=True)]
    return run(_divide, arguments, section(progress, 0.8, 1), REGISTERED)


def _match_one(
    reference: Reference, target: Analysis, points: ArrayLike | None, progress: Progress = silent
) -> tuple[Divisible, Matching]:
    shape = divisible(target, matching_shape(target, section(progress, 0, 0.5)))
    return shape, match_divisible(reference, shape, points=points, progress=section(progress, 0.5, 1))


def _divide(reference: Reference, shape: Divisible, matching: Matching, progress: Progress = silent) -> Registered:
    labels = label_matched(reference, shape, matching, 1 + reference.parts.given.highest, progress)
    return Registered(Segmentation(labels.faces, labels.parts, labels.level, _doubts(matching)), matching)


def _doubts(matching: Matching) -> tuple[str, ...]:
    if not matching.is_consistent:
        return (CONTRADICTS, *matching.warnings)
    return matching.warnings if matching.is_sure else (UNSURE.format(matching.confidence), *matching.warnings)


def _run_serially(
    function: Callable[..., Result], arguments: Sequence[tuple[object, ...]], progress: Progress, told: str
) -> list[Result]:
    """Return the results of calls that are made one after the other."""
    results: list[Result] = []
    for number, given in enumerate(arguments, 1):
        results.append(function(*given, section(progress, (number - 1) / len(arguments), number / len(arguments))))
        progress(number / len(arguments), told.format(number, len(arguments)))
    return results


def _run_in_executor(
    executor: Executor,
    function: Callable[..., Result],
    arguments: Sequence[tuple[object, ...]],
    progress: Progress,
    told: str,
) -> list[Result]:
    """Return the results in the order of the calls; those that have not begun are given up where this is cancelled."""
    futures = [executor.submit(function, *given) for given in arguments]
    try:
        n_done = 0
        while n_done < len(futures):
            time.sleep(INTERVAL)
            n_done = sum(future.done() for future in futures)
            progress(n_done / len(futures), told.format(n_done, len(futures)))
        return [future.result() for future in futures]
    finally:
        for future in futures:
            future.cancel()
