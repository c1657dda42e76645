"""Registration of any number of shapes at once, through one reference."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..analysis import Analysis
from ..errors import RegistrationError
from ..mesh import Ints
from ..progress import Progress, silent
from ..segmentation.parts import Segmentation
from ..surface import Surface
from .dense import source_points
from .matching import Matching, match_surfaces
from .part_matching import ReferenceParts, reference_parts, register_parts
from .spectral_shape import SpectralShape, spectral_shape


@dataclass(frozen=True, eq=False)
class Reference:
    """The shape that all others are registered to.

    Attributes
    ----------
    surface : Surface
    shape : SpectralShape
    parts : ReferenceParts
    """

    surface: Surface
    shape: SpectralShape
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


def register(
    analyses: Sequence[Analysis],
    *,
    reference: int = 0,
    level: int | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> list[Segmentation]:
    """Divide shapes into the same parts.

    Parameters
    ----------
    analyses : sequence of Analysis
    reference : int
        Which of them gives the parts.
    level : int, optional
        Level of the reference; its default level if None.
    executor : concurrent.futures.Executor, optional
        Runs the pairs: threads, processes or a cluster that offers this interface.
    progress : Progress, optional
        Told after each pair; may raise `Cancelled`.

    Returns
    -------
    list of Segmentation
        One for each shape: equal label = same part. A part without a partner on the reference has a label that no
        other shape has.

    Raises
    ------
    RegistrationError
        If there is no such shape.
    LevelError
        If the reference has no such level.
    """
    if not 0 <= reference < len(analyses):
        raise RegistrationError(f"There is no shape {reference} to register to; there are {len(analyses)} shapes.")
    prepared = prepare_reference(analyses[reference], analyses[reference].segment(level=level))
    others = [analysis for number, analysis in enumerate(analyses) if number != reference]
    segmentations = [result.segmentation for result in _register_all(prepared, others, executor, progress or silent)]
    segmentations.insert(reference, prepared.parts.segmentation)
    return with_own_labels(segmentations, reference)


def prepare_reference(analysis: Analysis, segmentation: Segmentation) -> Reference:
    """Return a shape with its parts in the form that others are registered to."""
    shape = spectral_shape(analysis.matching_basis)
    return Reference(analysis.surface, shape, reference_parts(segmentation, analysis.hierarchy, shape))


def register_one(reference: Reference, target: Analysis) -> Registered:
    """Match one shape with the reference and divide it into the same parts."""
    shape = spectral_shape(target.matching_basis)
    matching = match_surfaces(reference.surface, target.surface, reference.shape, shape)
    return register_matched(reference, target, shape, matching)


def register_matched(reference: Reference, target: Analysis, shape: SpectralShape, matching: Matching) -> Registered:
    """Divide a shape into the parts of the reference by a matching that is known."""
    source = reference.shape.mirrored() if matching.mirrored else reference.shape
    landing = source_points(source, shape, matching)
    return Registered(register_parts(reference.parts, target, shape, landing), matching)


def with_own_labels(segmentations: Sequence[Segmentation], reference: int) -> list[Segmentation]:
    """Renumber the parts without a partner, so that no two shapes share such a label."""
    n_shared = int(segmentations[reference].parts.id.max())
    first_free = n_shared + 1
    renumbered = []
    for segmentation in segmentations:
        own = np.unique(segmentation.parts.id[segmentation.parts.id > n_shared])
        renumbered.append(_renumbered(segmentation, own, first_free) if len(own) else segmentation)
        first_free += len(own)
    return renumbered


def _renumbered(segmentation: Segmentation, own: Ints, first_free: int) -> Segmentation:
    parts = segmentation.parts
    table = np.arange(int(parts.id.max()) + 1)
    table[own] = first_free + np.arange(len(own))
    new_parts = replace(parts, id=table[parts.id], parent=table[parts.parent])
    return replace(segmentation, labels=table[segmentation.labels].astype(np.int32), parts=new_parts)


def _register_all(
    reference: Reference, targets: Sequence[Analysis], executor: Executor | None, progress: Progress
) -> Iterator[Registered]:
    """Yield the registered shapes in their order, telling how far it is."""
    run = map if executor is None else executor.map
    for number, result in enumerate(run(partial(register_one, reference), targets), start=1):
        progress(number / len(targets), f"Registered {number} of {len(targets)} shapes")
        yield result
