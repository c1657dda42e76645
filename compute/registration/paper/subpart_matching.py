"""The paper's matching on fine levels: coarse parts first, then what they divide into, each pair analyzed on its own.

The first functions of a whole shape do not tell fingers from each other; those of an arm alone do.
"""

from dataclasses import dataclass

import numpy as np

from ...analysis.analysis import Analysis, analyze_part, segment_part
from ...choices import FEATURES
from ...progress import Progress, rising, silent
from ...segmentation.parts.part_labels import Segmentation
from .diagram_matching import DiagramMatching, PartPairs, match_diagrams, match_tips

# A part with fewer faces has no parts of its own to be matched.
LEAST_FACES = 60


@dataclass(frozen=True, eq=False)
class SubpartPairs:
    """The parts into which two corresponding parts divide.

    Attributes
    ----------
    of_source, of_target : int
        Labels of the two parts.
    source, target : Segmentation
        Of the triangles of those parts alone, in the order of the mesh.
    matching : DiagramMatching
        Of their own functions.
    pairs : PartPairs
        Labels in ``source`` and ``target`` that correspond.
    """

    of_source: int
    of_target: int
    source: Segmentation
    target: Segmentation
    matching: DiagramMatching
    pairs: PartPairs


def match_subparts(
    source: Analysis,
    target: Analysis,
    parts: tuple[Segmentation, Segmentation],
    pairs: PartPairs,
    *,
    progress: Progress | None = None,
) -> tuple[SubpartPairs, ...]:
    """Cut off the parts that correspond, analyze each on its own, and pair what it divides into.

    Parameters
    ----------
    source, target : Analysis
    parts : pair of Segmentation
        Of the source and of the target, at a coarse level.
    pairs : PartPairs
        The parts that correspond, such as those of `match_tips`.
    progress : Progress, optional
        Called before each pair; may raise `Cancelled`.

    Returns
    -------
    tuple of SubpartPairs
        For the pairs of which both parts divide further.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.7: "the registered regions can be cut off and the whole analysis can be
       continued on the subparts".
    """
    progress = rising(progress or silent)
    subparts = []
    for number, labels in enumerate(zip(pairs.source.tolist(), pairs.target.tolist(), strict=True)):
        progress(number / len(pairs.source), f"Matching inside part {labels[0]}")
        if all(_can_be_divided(whole, label) for whole, label in zip(parts, labels, strict=True)):
            pieces = [
                analyze_part(one, whole, label)
                for one, whole, label in zip((source, target), parts, labels, strict=True)
            ]
            subparts.append(_match_pieces(pieces[0], pieces[1], labels))
    progress(1.0, "Done")
    return tuple(one for one in subparts if len(one.pairs.source))


def _can_be_divided(whole: Segmentation, label: int) -> bool:
    return bool(np.count_nonzero(whole.labels == label) >= LEAST_FACES)


def _match_pieces(source: Analysis, target: Analysis, labels: tuple[int, int]) -> SubpartPairs:
    parts = segment_part(source, FEATURES), segment_part(target, FEATURES)
    matching = match_diagrams(source, target)
    return SubpartPairs(
        of_source=labels[0],
        of_target=labels[1],
        source=parts[0],
        target=parts[1],
        matching=matching,
        pairs=match_tips(source, target, parts, matching),
    )
