"""The work of registering meshes; knows nothing of Blender, so any thread may do it."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import engine
from .analyze import Outcome, outcome_of
from .exchange import MeshArrays
from .refusals import Refusal

# Functions whose signs can be given, and that are shown.
SHOWN_FUNCTIONS = 8
Progress = Callable[[float, str], None]


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
    """The parts that a reference shows: its level, None for the default one, out of how many, and the mode."""

    level: int | None
    n_levels: int
    mode: str


@dataclass(frozen=True, eq=False)
class Found:
    """A mesh registered.

    Attributes
    ----------
    outcome : Outcome
    labels : BranchLabels
        The parts of the reference on the branches of this mesh.
    matching : Matching
    alternative, n_alternatives : int
    """

    outcome: Outcome
    labels: "engine.BranchLabels"
    matching: "engine.Matching"
    alternative: int
    n_alternatives: int


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
    analyzed = [analyze_subject(target, _step(progress, k, n_steps)) for k, target in enumerate((reference, *targets))]
    (analysis, outcome), *others = analyzed
    level = shown.level if analysis.hierarchy.n_levels == shown.n_levels else None
    segmentation = analysis.segment(level=level, mode=shown.mode)
    progress((len(targets) + 1) / n_steps, f"Preparing {reference.name}")
    prepared = engine.prepare_reference(analysis, segmentation)
    first_free = max(first_free, int(segmentation.parts.id.max()) + 1)
    found = []
    for number, (target, (own, own_outcome)) in enumerate(zip(targets, others, strict=True)):
        told = f"Registering {target.name}, {number + 1} of {len(targets)}"
        progress((len(targets) + 1 + number) / n_steps, told)
        found.append(register_analyzed(prepared, own, own_outcome, wish, first_free))
        first_free = max(first_free, int(found[-1].labels.parts.id.max()) + 1)
    progress(1.0, "Done")
    return Registration(outcome, segmentation.level, tuple(found))


def analyze_subject(subject: Subject, progress: Progress) -> tuple["engine.Analysis", Outcome]:
    """Return the analysis of a mesh and what of it is left for the mesh; a Refusal names the object."""
    start = time.perf_counter()
    try:
        mesh = engine.TriangleMesh(subject.arrays.vertices, subject.arrays.triangles)
        analysis = engine.analyze(mesh, **subject.options, progress=_naming(progress, subject.name))
    except engine.Cancelled:
        raise
    except engine.EngineError as error:
        raise Refusal(f"{subject.name}: {error}") from error
    return analysis, outcome_of(analysis, subject.arrays, subject.options, time.perf_counter() - start)


def register_analyzed(
    reference: "engine.Reference", target: "engine.Analysis", outcome: Outcome, wish: Wish, first_free: int
) -> Found:
    """Return an analyzed mesh divided into the parts of the reference; its own are numbered from ``first_free``."""
    shape = engine.spectral_shape(target.matching_basis)
    best = engine.match_surfaces(
        reference.surface, target.surface, reference.shape, shape, flips=wish.flips, mirrored=wish.mirrored
    )
    matchings = (best, *best.alternatives)
    alternative = wish.alternative % len(matchings)
    matching = matchings[alternative]
    source = reference.shape.mirrored() if matching.mirrored else reference.shape
    landing = engine.source_points(source, shape, matching)
    cuts, hierarchy, _, level = engine.register_cuts(reference.parts, target, shape, landing)
    cuts = _with_own_labels(cuts, int(reference.parts.segmentation.parts.id.max()), first_free)
    labels = engine.label_behind(cuts, hierarchy, outcome.stored.branches, level)
    return Found(outcome, labels, matching, alternative, len(matchings) - 1)


def _with_own_labels(cuts: list[np.ndarray], highest_shared: int, first_free: int) -> list[np.ndarray]:
    """Renumber the parts without a partner, so that no other mesh has their labels."""
    own = np.unique(np.concatenate(cuts))
    own = own[own > highest_shared]
    return [np.where(cut > highest_shared, first_free + np.searchsorted(own, cut), cut) for cut in cuts]


def _step(progress: Progress, number: int, n_steps: int) -> Progress:
    """Return a callback whose 0..1 is one of some equal steps."""

    def report(fraction: float, text: str) -> None:
        progress((number + fraction) / n_steps, text)

    return report


def _naming(progress: Progress, name: str) -> Progress:
    """Return a callback that tells of which object it speaks."""
    return lambda fraction, text: progress(fraction, f"{name}: {text}")
