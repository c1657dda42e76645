"""Transfer between posed characters: ``python -m benchmarks.transfer --data DIR [--pairs N] [--decimated]``.

The source is a pose as it was made, the target another pose that was remeshed or decimated and shuffled. The truth is
the connectivity that the poses share before remeshing; distances are taken along the rest pose, in hundredths of the
root of its area. Beside it stand pyFM (wave kernel signatures, orientation term, ZoomOut to 100 functions) and the
nearest point in space, which is what Blender's Data Transfer takes. Labels are the 15 parts of makehuman, and the
default parts of the source for the other families; weights are the 124 bones of makehuman, before normalization.
"""

import argparse
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.decimated_poses import head_table, run_decimated
from benchmarks.peers import is_installed, versions_of
from benchmarks.posed_families import FAMILIES, Pose, SurfacePoints, closest_points, find_mirror, load_family
from benchmarks.registration_peers import FIT, N_FUNCTIONS
from benchmarks.registration_truth import MIDDLE, Copy, make_copy
from benchmarks.surface_distances import SurfaceDistances
from compute.registration.dense.correspondence import correspond
from compute.registration.eigenfunctions.matching import match_shapes
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from compute.surface.mesh import Floats, Ints, TriangleMesh

KINDS = ("remeshed", "decimated")
OURS, PEER, NEAREST = "ours", "pyFM", "nearest in space"
# Points that errors are measured at, drawn by area.
N_JUDGED = 500
PEER_FUNCTIONS, PEER_STEP = 100, 5


@dataclass(frozen=True, eq=False)
class Outcome:
    """How one method did on one pair; lengths in hundredths of the root of the area."""

    family: str
    method: str
    error: float
    mirrored: float
    labels: float
    weights: float
    coverage: float
    seconds: float


@dataclass(frozen=True, eq=False)
class Judge:
    """Compares found points with the true ones on the rest pose of a family."""

    poses: list[Pose]
    labels: Ints
    weights: Floats | None

    def judge(self, target: Copy, found: SurfacePoints) -> tuple[float, float, float, float]:
        """Return error, mirrored share, share of area with the true label, and total variation of the weights."""
        rest, mesh = self.poses[0].mesh, target.analysis.mesh
        truth = closest_points(mesh.vertices, target.pose.mesh)
        area = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas / 3, 3), len(mesh.vertices))
        share = area / area.sum()
        chosen = np.random.default_rng(0).choice(len(share), N_JUDGED, p=share)
        unit = np.sqrt(rest.areas.sum())
        away = SurfaceDistances(rest).between(_take(truth, chosen), _take(found, chosen)) * 100 / unit
        same = self._labels(truth) == self._labels(found)
        return (
            float(away.mean()),
            self._mirrored(truth, found, share),
            float(share[same].sum()),
            self._variation(truth, found),
        )

    def _labels(self, points: SurfacePoints) -> Ints:
        return self.labels[points.triangle]

    def _mirrored(self, truth: SurfacePoints, found: SurfacePoints, share: Floats) -> float:
        rest = self.poses[0].mesh
        true_places, places = truth.on(rest), found.on(rest)
        images = find_mirror(rest).reflected(true_places)
        has_side = np.linalg.norm(images - true_places, axis=1) > MIDDLE * np.sqrt(rest.areas.sum())
        to_image, to_truth = (np.linalg.norm(places - other, axis=1) for other in (images, true_places))
        return float(share[has_side & (to_image < to_truth)].sum())

    def _variation(self, truth: SurfacePoints, found: SurfacePoints) -> float:
        if self.weights is None:
            return np.nan
        triangles = self.poses[0].mesh.triangles
        true, here = (
            np.einsum("nk,nkb->nb", points.barycentric, self.weights[triangles[points.triangle]])
            for points in (truth, found)
        )
        return float(np.abs(true - here).sum(axis=1).mean() / 2)


def _take(points: SurfacePoints, chosen: Ints) -> SurfacePoints:
    return SurfacePoints(points.triangle[chosen], points.barycentric[chosen])


def judge_of(data: Path, family: str, poses: list[Pose], source: Copy) -> Judge:
    """Return the judge of a family; makehuman has true parts and weights."""
    if family != "makehuman":
        return Judge(poses, source.analysis.segment(mode="features").labels.astype(np.int64), None)
    known = np.load(data / "makehuman" / "mh_body_weights.npz", allow_pickle=True)
    part = np.unique(known["part_of_vertex"], return_inverse=True)[1]
    corners = part[poses[0].mesh.triangles]
    of_triangle = np.where(corners[:, 1] == corners[:, 2], corners[:, 1], corners[:, 0])
    return Judge(poses, of_triangle, known["weights"].astype(float))


def by_us(source: Copy, target: Copy) -> tuple[SurfacePoints, float, float]:
    """Return the points, how many are sure, and the CPU seconds after the eigenfunctions."""
    start = time.process_time()
    shapes = (spectral_shape(copy.analysis.matching_basis) for copy in (source, target))
    matching = match_shapes(*shapes)
    found = correspond(source.analysis, target.analysis, matching=matching)
    sure = float(found.is_sure.mean())
    return SurfacePoints(found.triangles, found.barycentric), sure, time.process_time() - start


def by_peer(source: Copy, target: Copy) -> tuple[SurfacePoints, float, float]:
    """Return vertices found by pyFM as points, and the CPU seconds after the eigenfunctions."""
    from pyFM.functional import FunctionalMapping
    from pyFM.mesh import TriMesh

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        here, there = (
            TriMesh(copy.analysis.mesh.vertices, copy.analysis.mesh.triangles, area_normalize=True, center=True)
            for copy in (source, target)
        )
        for mesh in (here, there):
            mesh.process(k=PEER_FUNCTIONS)
        start = time.process_time()
        model = FunctionalMapping(here, there)
        model.preprocess(n_descr=100, descr_type="WKS", subsample_step=5, k_process=PEER_FUNCTIONS)
        model.fit(K=(N_FUNCTIONS, N_FUNCTIONS), w_orient=1.0, **FIT)
        rounds = (PEER_FUNCTIONS - N_FUNCTIONS) // PEER_STEP
        grown = model.zoomout_refine(nit=rounds, step=PEER_STEP, subsample=1000)
        found = _at_vertices(model.get_p2p(FM=grown), source.analysis.mesh)
        return found, 1.0, time.process_time() - start


def by_nearest(source: Copy, target: Copy) -> tuple[SurfacePoints, float, float]:
    """Return the nearest points in space, as the meshes stand in their files, and the CPU seconds."""
    start = time.process_time()
    found = closest_points(target.analysis.mesh.vertices, source.analysis.mesh)
    return found, 1.0, time.process_time() - start


def _at_vertices(vertices: Ints, mesh: TriangleMesh) -> SurfacePoints:
    side = np.zeros(len(mesh.vertices), dtype=np.int64)
    side[mesh.triangles.ravel()] = np.arange(mesh.triangles.size)
    return SurfacePoints(side[vertices] // 3, np.eye(3)[side[vertices] % 3])


METHODS = {OURS: by_us, **({PEER: by_peer} if is_installed("pyFM") else {}), NEAREST: by_nearest}


def run_family(data: Path, family: str, cache: Path, n_pairs: int) -> Iterator[Outcome]:
    """Yield the outcomes of pairs of a family, evenly chosen among all."""
    poses = load_family(data, family)
    if not poses:
        sys.stdout.write(f"{family}: no files, left out\n")
        return
    pairs = [(i, j) for i in range(len(poses)) for j in range(len(poses)) if i != j]
    for kind in KINDS:
        for place in np.unique(np.linspace(0, len(pairs) - 1, min(n_pairs, len(pairs))).astype(int)).tolist():
            i, j = pairs[place]
            source, target = make_copy(poses[i], "same", cache), make_copy(poses[j], kind, cache)
            judge = judge_of(data, family, poses, source)
            for name, method in METHODS.items():
                found, coverage, seconds = method(source, target)
                error, mirrored, labels, weights = judge.judge(target, found)
                yield Outcome(family, name, error, mirrored, labels, weights, coverage, seconds)


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the Markdown table, a row for each family and method."""
    lines = [
        "| family | pairs | method | mean error | worst pair | mirrored | labels right | weights off | sure | CPU s |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for family in [*dict.fromkeys(one.family for one in outcomes), "all"]:
        for method in METHODS:
            lines.append(
                _row(family, method, [o for o in outcomes if family in (o.family, "all") and o.method == method])
            )
    return lines


def _row(family: str, method: str, some: list[Outcome]) -> str:
    error = [one.error for one in some]
    weights = [one.weights for one in some if np.isfinite(one.weights)]
    cells = (
        family,
        len(some),
        method,
        f"{np.mean(error):.2f}",
        f"{max(error):.2f}",
        f"{np.mean([one.mirrored for one in some]):.2%}",
        f"{np.mean([one.labels for one in some]):.2%}",
        f"{np.mean(weights):.4f}" if weights else "",
        f"{np.mean([one.coverage for one in some]):.1%}" if method == OURS else "",
        f"{np.mean([one.seconds for one in some]):.1f}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-transfer")
    parser.add_argument("--pairs", type=int, default=1, help="of each family and kind of copy")
    parser.add_argument("--families", default=",".join(FAMILIES))
    parser.add_argument("--decimated", action="store_true", help="all poses with 35 and 25 %% of their triangles, too")
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    sys.stdout.write(versions_of("numpy", "scipy", "pyfmaps", "pymeshlab") + "\n\n")
    outcomes: list[Outcome] = []
    for family in filter(None, arguments.families.split(",")):
        outcomes += run_family(arguments.data, family, arguments.cache, arguments.pairs)
        for method in METHODS:
            some = [one for one in outcomes if one.family == family and one.method == method]
            if some:
                sys.stdout.write(_row(family, method, some) + "\n")
        sys.stdout.flush()
    if outcomes:
        sys.stdout.write("\n" + "\n".join(table(outcomes)) + "\n")
    if arguments.decimated:
        heads = list(run_decimated(arguments.data, arguments.cache))
        sys.stdout.write("\n" + "\n".join(head_table(heads)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
