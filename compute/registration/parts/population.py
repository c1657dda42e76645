"""Registration of any number of shapes at once, through one reference."""

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, wait
from dataclasses import dataclass, replace
from functools import partial

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
from ..eigenfunctions.given_points import point_pairs
from ..eigenfunctions.matching import Matching, match_surfaces, matching_shape
from ..eigenfunctions.pair_memory import require_pair
from .part_matching import ReferenceParts, partner_cuts, reference_parts, with_first_free
from .transferred_labels import Divisible, FaceLabels, divisible, transfer_labels

# Seconds between looks whether shapes in an executor are ready, and whether the user has cancelled.
INTERVAL = 0.2


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
        other shape has.

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
    if not 0 <= reference < len(analyses):
        raise RegistrationError(f"There is no shape {reference} to register to; there are {len(analyses)} shapes.")
    for analysis in analyses:
        require_pair(analyses[reference].surface, analysis.surface)
    progress = rising(progress or silent)
    progress(0.0, "Preparing the reference")
    reference_segmentation = analyses[reference].segment(level=level, mode=FEATURES)
    prepared = prepare_reference(analyses[reference], reference_segmentation)
    others = [analysis for number, analysis in enumerate(analyses) if number != reference]
    given = [None] * len(others) if points is None else list(points)
    if len(given) != len(others):
        raise RegistrationError(f"There are points for {len(given)} shapes, and {len(others)} to register.")
    run = _run_serially if executor is None else partial(_run_in_executor, executor)
    segmentations = [_told(result) for result in run(prepared, others, given, progress)]
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
    shape = divisible(target, matching_shape(target, section(progress, 0, 0.4)))
    matching = match_divisible(reference, shape, points=points, progress=section(progress, 0.4, 0.8))
    labels = label_matched(reference, shape, matching, 1 + reference.parts.given.highest, section(progress, 0.8, 1))
    return Registered(Segmentation(labels.faces, labels.parts, labels.level), matching)


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
    source = reference.shape.shape.mirrored() if matching.mirrored else reference.shape.shape
    pairs = point_pairs(matching.points, reference.shape.surface, target.surface, source, target.shape)
    to_reference = point_map(source, target.shape, matching, section(progress, 0, 0.8), pairs)
    progress(0.8, "Carrying the parts over")
    cuts, level = partner_cuts(reference.parts, target, to_reference)
    cuts = with_first_free(cuts, reference.parts.given.highest, first_free)
    same_faces = (
        matching.same_topology
        and np.array_equal(reference.shape.face, target.face)
        and len(reference.shape.graph.stands_for) == len(target.graph.stands_for)
    )
    return transfer_labels(reference.parts.given, target, None if same_faces else to_reference, cuts, level)


def _told(result: Registered) -> Segmentation:
    segmentation = result.segmentation
    return replace(segmentation, warnings=(*segmentation.warnings, *result.matching.warnings))


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


def _run_serially(
    reference: Reference, targets: Sequence[Analysis], points: Sequence[ArrayLike | None], progress: Progress
) -> Iterator[Registered]:
    """Yield the registered shapes one after the other."""
    for number, (target, given) in enumerate(zip(targets, points, strict=True)):
        step = section(progress, number / len(targets), (number + 1) / len(targets))
        yield register_one(reference, target, given, step)
        progress((number + 1) / len(targets), f"Registered {number + 1} of {len(targets)} shapes")


def _run_in_executor(
    executor: Executor,
    reference: Reference,
    targets: Sequence[Analysis],
    points: Sequence[ArrayLike | None],
    progress: Progress,
) -> Iterator[Registered]:
    """Yield the registered shapes in their order; those that have not begun are given up where this is cancelled."""
    futures = [
        executor.submit(register_one, reference, target, given) for target, given in zip(targets, points, strict=True)
    ]
    try:
        open_futures: set[Future[Registered]] = set(futures)
        while open_futures:
            _, open_futures = wait(open_futures, timeout=INTERVAL)
            n_done = len(futures) - len(open_futures)
            progress(n_done / len(futures), f"Registered {n_done} of {len(futures)} shapes")
        yield from (future.result() for future in futures)
    finally:
        for future in futures:
            future.cancel()
