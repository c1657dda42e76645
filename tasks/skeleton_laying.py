"""A skeleton laid into the parts of a mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .. import compute
from . import recent_analyses
from .mesh_analysis import AnalysisInput
from .mesh_shape import Stretch
from .recent_results import Recent, key_of

# How many shapes are remembered by their symmetry.
RECENT_SYMMETRIES = 8
# A tuple of one: that a shape has no symmetry is remembered, too.
_recent_partners: Recent[tuple[NDArray[np.int64] | None]] = Recent("symmetries", RECENT_SYMMETRIES)


@dataclass(frozen=True, eq=False)
class NamedSkeleton:
    """A skeleton with all that its bones are called after.

    Attributes
    ----------
    skeleton : Skeleton
    weights : (V, J) array or None
        How much each bone moves each vertex, if that was wanted.
    pairing : dict of int to (int, int)
        For each part that has a side, the part both sides are called after and +1 for left, -1 for right.
    warnings : tuple of str
        Of the analysis and of the skeleton.
    stretch : Stretch
        From the mesh to the shape in which the joints lie.
    """

    skeleton: compute.Skeleton
    weights: NDArray[np.float64] | None
    pairing: dict[int, tuple[int, int]]
    warnings: tuple[str, ...]
    stretch: Stretch


@dataclass(frozen=True, eq=False)
class SkeletonInput:
    """The parts of a mesh, and the kind of skeleton that is wanted.

    Attributes
    ----------
    labels : (F,) int32
        Part of each polygon.
    level : int
        Which features have bones.
    n_pieces : int
        Bones in a long straight limb.
    poses : tuple of (V, 3) arrays
        The same vertices elsewhere.
    pairing : dict
        Sides that are known from the mesh that this one is registered to; empty if there are none.
    needs_weights : bool
    layout : BoneLayout or None
        The bones of the mesh that this one is registered to.
    """

    labels: NDArray[np.int32]
    level: int
    n_pieces: int
    poses: tuple[NDArray[np.float64], ...] = ()
    pairing: dict[int, tuple[int, int]] = field(default_factory=dict)
    needs_weights: bool = False
    layout: compute.BoneLayout | None = None


def lay_bones(given: AnalysisInput, wanted: SkeletonInput, progress: compute.Progress) -> NamedSkeleton:
    """Run the engine."""
    analysis = recent_analyses.recall(given.arrays, given.options, compute.section(progress, 0, 0.6))
    labels = wanted.labels[given.arrays.polygon_of_triangle]
    key = key_of([recent_analyses.key_of_analysis(given.arrays, given.options), labels])
    finding = compute.section(progress, 0.6, 0.9)
    partner = _recall_partner(key, partial(compute.mirror_parts, analysis, labels, progress=finding))
    progress(0.9, "Laying bones")
    level = min(wanted.level, analysis.hierarchy.n_levels - 1)
    skeleton = compute.skeleton(
        analysis,
        level=level,
        labels=labels,
        poses=wanted.poses,
        n_pieces=wanted.n_pieces,
        partner=partner,
        layout=wanted.layout,
    )
    progress(0.95, "Binding the mesh")
    weights = compute.binding_weights(analysis, skeleton) if wanted.needs_weights else None
    return NamedSkeleton(
        skeleton=skeleton,
        weights=weights,
        pairing=wanted.pairing or _pairing(skeleton, partner),
        warnings=(*analysis.warnings, *skeleton.warnings),
        stretch=given.arrays.stretch,
    )


def _recall_partner(key: str, find: Callable[[], NDArray[np.int64] | None]) -> NDArray[np.int64] | None:
    """Return which parts mirror which, as it was found before if that is known: a bent pose takes seconds."""
    kept = _recent_partners.get(key)
    if kept is None:
        kept = (find(),)
        _recent_partners.put(key, kept, 1)
    return kept[0]


def _pairing(skeleton: compute.Skeleton, partner: NDArray[np.int64] | None) -> dict[int, tuple[int, int]]:
    if partner is None:
        return {}
    side = compute.sides(skeleton, partner)
    return {part: (min(part, int(partner[part])), int(side[part])) for part in np.flatnonzero(side).tolist()}
