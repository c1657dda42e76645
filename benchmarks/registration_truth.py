"""Copies of posed characters whose correspondence is known, and how far a map is from it."""

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache as cache_result
from functools import partial
from hashlib import blake2b
from pathlib import Path

import numpy as np

from benchmarks.posed_families import (
    Mirror,
    Pose,
    SurfacePoints,
    closest_points,
    cut_open,
    decimated,
    noised,
    remeshed,
)
from compute.analysis.analysis import Analysis
from compute.analysis.analyze import analyze
from compute.fem.lagrange import reference_element
from compute.registration.eigenfunctions.spectral_shape import SpectralShape, spectral_shape
from compute.surface.mesh import Floats, Ints, TriangleMesh

# Functions that a map is judged by.
JUDGED_FUNCTIONS = 10
# Points closer to the plane of symmetry than this, in units of the root of the area, have no side.
MIDDLE = 0.15
COPIES: dict[str, Callable[[TriangleMesh], TriangleMesh]] = {
    "same": lambda mesh: mesh,
    "remeshed": remeshed,
    "decimated": decimated,
    "noised": noised,
    "cut open": cut_open,
    "35 %": partial(decimated, share=0.35),
    "25 %": partial(decimated, share=0.25),
}


@dataclass(frozen=True, eq=False)
class Copy:
    """A pose, as it is or remeshed, analyzed; the points of its shape are traced to the pose they were made from."""

    pose: Pose
    analysis: Analysis
    shape: SpectralShape
    truth: SurfacePoints


def make_copy(pose: Pose, kind: str, cache: Path) -> Copy:
    """Return a copy of a pose, from the cache if it was made before."""
    path = cache / f"{pose.family}-{pose.name}-{kind}-{engine_digest()}.pickle"
    if not path.exists():
        analysis = analyze(COPIES[kind](pose.mesh))
        shape = spectral_shape(analysis.matching_basis)
        truth = closest_points(analysis.matching_basis.nodes[shape.node], pose.mesh)
        path.write_bytes(pickle.dumps(Copy(pose, analysis, shape, truth)))
    return pickle.loads(path.read_bytes())


@cache_result
def engine_digest() -> str:
    """Return a text that changes with the engine, whose results are not mixed with those of another one."""
    files = sorted((Path(__file__).parents[1] / "compute").rglob("*.py"))
    return blake2b(b"".join(file.read_bytes() for file in files), digest_size=6).hexdigest()


def map_error(functional_map: Floats, source: Copy, target: Copy) -> float:
    """Return the distance of a map, the constant left out, to the truth on the first functions; the identity is 1."""
    size = JUDGED_FUNCTIONS
    return float(np.linalg.norm(functional_map[:size, :size] - true_map(source, target)) / np.sqrt(size))


def true_map(source: Copy, target: Copy) -> Floats:
    """Return (k, k) the functional map that the shared connectivity of the poses gives, the constant left out."""
    basis, size = source.analysis.matching_basis, JUDGED_FUNCTIONS
    triangle = source.analysis.surface.triangle_of_input[target.truth.triangle]
    weights = reference_element(basis.order).evaluate(target.truth.barycentric[:, 1:])
    functions = basis.functions[:, :size] * np.sqrt(source.analysis.surface.mesh.areas.sum())
    carried = np.einsum("pn,pnk->pk", weights, functions[basis.elements[triangle]])
    return target.shape.project(carried)[1 : size + 1]


def misplaced(
    landed: Ints, queries: Ints, copies: tuple[Copy, Copy], rest: TriangleMesh, mirror: Mirror
) -> tuple[float, float]:
    """Return the share of points that land on the mirrored side, and the mean distance to the truth at rest.

    Parameters
    ----------
    landed : (q,) int64
        The source's points that some of the target's land on.
    queries : (q,) int64
        Those points of the target.
    copies : pair of Copy
        Source and target.
    rest : TriangleMesh
        The pose in which places are compared.
    mirror : Mirror
        Of that pose.
    """
    source, target = copies
    true_places, found = _at(target.truth, queries, rest), _at(source.truth, landed, rest)
    unit = np.sqrt(rest.areas.sum())
    images = mirror.reflected(true_places)
    away, to_image, sides = (
        np.linalg.norm(a - b, axis=1) / unit for a, b in ((found, true_places), (found, images), (images, true_places))
    )
    return float(((to_image < away) & (sides > MIDDLE)).mean()), float(away.mean())


def _at(points: SurfacePoints, chosen: Ints, mesh: TriangleMesh) -> Floats:
    return SurfacePoints(points.triangle[chosen], points.barycentric[chosen]).on(mesh)
