"""Registration of posed characters: ``python -m benchmarks.registration --data DIR [--pairs N] [--cache DIR]``.

The source is a pose as it was made, the target another pose that was remeshed or decimated and shuffled. The truth is
the connectivity that the poses share before remeshing. Beside it stand the same pairs with their own connectivity
(matched by shape, not by number), pyFM with and without its orientation term, and pairs of kin without a truth.
"""

import argparse
import pickle
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np

from benchmarks.posed_families import (
    FAMILIES,
    Mirror,
    Pose,
    SurfacePoints,
    closest_points,
    decimated,
    find_mirror,
    load_family,
    read_mesh,
    remeshed,
)
from compute.analysis import Analysis, analyze
from compute.fem.lagrange import reference_element
from compute.mesh import Floats, Ints, TriangleMesh
from compute.registration.matching import Matching, match_shapes
from compute.registration.population import prepare_reference, register_matched
from compute.registration.spectral_shape import SpectralShape, spectral_shape
from compute.registration.zoomout import nearest_points, with_constant

# A pair is right when the map of the first functions is within this distance of the truth, relative to the identity,
# and less than this share of the area lands on the mirrored side.
JUDGED_FUNCTIONS = 10
LARGEST_ERROR = 0.3
MOST_MIRRORED = 0.05
# Points closer to the plane of symmetry than this, in units of the root of the area, have no side.
MIDDLE = 0.15
COPIES: dict[str, Callable[[TriangleMesh], TriangleMesh]] = {
    "same": lambda mesh: mesh,
    "remeshed": remeshed,
    "decimated": decimated,
}
KIN = (
    ("wolf and husky", "quaternius-animals/wolf_0_rest.off", "quaternius-animals/husky_0_rest.off"),
    ("fox and wolf", "quaternius-animals/fox_0_rest.off", "quaternius-animals/wolf_0_rest.off"),
    ("horse and donkey", "quaternius-animals/horse_0_rest.off", "quaternius-animals/donkey_0_rest.off"),
    ("man and woman", "odedstein/human_man.obj", "odedstein/human_woman.obj"),
    ("horse and torus", "quaternius-animals/horse_0_rest.off", "odedstein/torus.obj"),
    ("horse and hand", "quaternius-animals/horse_0_rest.off", "webxr-hand/hand_0_rest.off"),
)


@dataclass(frozen=True, eq=False)
class Copy:
    """A pose, as it is or remeshed, analyzed; the points of its shape are traced to the pose they were made from."""

    pose: Pose
    analysis: Analysis
    shape: SpectralShape
    truth: SurfacePoints


@dataclass(frozen=True, eq=False)
class Outcome:
    """How one pair went."""

    family: str
    kind: str
    poses: tuple[int, int]
    error: float
    mirrored: float
    distance: float
    confidence: float
    seconds: float
    labels: float = np.nan
    swapped: float = np.nan

    @property
    def is_right(self) -> bool:
        """Whether the functions and the sides are those of the truth."""
        return self.error <= LARGEST_ERROR and self.mirrored < MOST_MIRRORED


def make_copy(pose: Pose, kind: str, cache: Path) -> Copy:
    """Return a copy of a pose, from the cache if it was made before."""
    path = cache / f"{pose.family}-{pose.name}-{kind}.pickle"
    if not path.exists():
        analysis = analyze(COPIES[kind](pose.mesh))
        shape = spectral_shape(analysis.matching_basis)
        truth = closest_points(analysis.matching_basis.nodes[shape.node], pose.mesh)
        path.write_bytes(pickle.dumps(Copy(pose, analysis, shape, truth)))
    return pickle.loads(path.read_bytes())


def true_map(source: Copy, target: Copy) -> Floats:
    """Return (k, k) the functional map that the shared connectivity of the poses gives, the constant included."""
    basis, size = source.analysis.matching_basis, JUDGED_FUNCTIONS
    triangle = source.analysis.surface.triangle_of_input[target.truth.triangle]
    weights = reference_element(basis.order).evaluate(target.truth.barycentric[:, 1:])
    functions = basis.functions[:, :size] * np.sqrt(source.analysis.surface.mesh.areas.sum())
    carried = np.einsum("pn,pnk->pk", weights, functions[basis.elements[triangle]])
    return target.shape.project(carried)[1 : size + 1]


def judge(matching: Matching, source: Copy, target: Copy, rest: TriangleMesh, mirror: Mirror) -> tuple[float, ...]:
    """Return the error of the functional map, the mirrored share and the mean distance to the truth at rest."""
    size = JUDGED_FUNCTIONS
    error = np.linalg.norm(matching.map[:size, :size] - true_map(source, target)) / np.sqrt(size)
    queries, places = target.shape.samples, source.shape.samples
    functional_map = with_constant(matching.map)
    landed = places[nearest_points(functional_map, source.shape.functions[places], target.shape.functions[queries])]
    true_places, found = _at(target.truth, queries, rest), _at(source.truth, landed, rest)
    unit = np.sqrt(rest.areas.sum())
    images = mirror.reflected(true_places)
    away, to_image, sides = (
        np.linalg.norm(a - b, axis=1) / unit for a, b in ((found, true_places), (found, images), (images, true_places))
    )
    return float(error), float(((to_image < away) & (sides > MIDDLE)).mean()), float(away.mean())


def _at(points: SurfacePoints, chosen: Ints, mesh: TriangleMesh) -> Floats:
    return SurfacePoints(points.triangle[chosen], points.barycentric[chosen]).on(mesh)


def judge_labels(source: Copy, target: Copy, matching: Matching) -> tuple[float, float]:
    """Return the share of area with the true label, and that with a part where the truth has another part."""
    reference = prepare_reference(source.analysis, source.analysis.segment())
    found = register_matched(reference, target.analysis, target.shape, matching).segmentation.labels
    mesh = target.analysis.mesh
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    true = reference.parts.segmentation.labels[closest_points(middles, target.pose.mesh).triangle]
    share = mesh.areas / mesh.areas.sum()
    return float(share[true == found].sum()), float(share[(true != found) & (true > 0) & (found > 0)].sum())


def run_family(data: Path, family: str, cache: Path, n_pairs: int, *, labels_every: int = 4) -> Iterator[Outcome]:
    """Yield the outcomes of pairs of a family, evenly chosen among all: source as made, target remeshed."""
    poses = load_family(data, family)
    if not poses:
        print(f"{family}: no files, left out")
        return
    mirror = find_mirror(poses[0].mesh)
    for kind in ("remeshed", "decimated", "same"):
        pairs = [(i, j) for i in range(len(poses)) for j in range(len(poses)) if i != j]
        for place in np.unique(np.linspace(0, len(pairs) - 1, min(n_pairs, len(pairs))).astype(int)).tolist():
            i, j = pairs[place]
            source, target = make_copy(poses[i], "same", cache), make_copy(poses[j], kind, cache)
            start = time.process_time()
            # Shapes anew, so that what is kept on them is computed within the time measured.
            shapes = (spectral_shape(copy.analysis.matching_basis) for copy in (source, target))
            matching = match_shapes(*shapes)
            seconds = time.process_time() - start
            verdict = judge(matching, source, target, poses[0].mesh, mirror)
            with_labels = kind != "same" and place % labels_every == 0
            labels = judge_labels(source, target, matching) if with_labels else (np.nan, np.nan)
            yield Outcome(family, kind, (i, j), *verdict, matching.confidence, seconds, *labels)


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the Markdown table of all families."""
    lines = [
        "| family | pairs | right | same connectivity | sure | of these right | labels right | other part | CPU s |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    families = [*dict.fromkeys(outcome.family for outcome in outcomes), "all"]
    for family in families:
        lines.append(_row(family, [one for one in outcomes if family in (one.family, "all")]))
    return lines


def _row(name: str, outcomes: list[Outcome]) -> str:
    hard = [one for one in outcomes if one.kind != "same"]
    same = [one for one in outcomes if one.kind == "same"]
    sure = [one for one in hard if one.confidence > 0.5]
    cells = (
        name,
        len(hard),
        _share(hard),
        _share(same),
        f"{len(sure) / max(len(hard), 1):.1%}",
        _share(sure),
        f"{np.nanmean([one.labels for one in hard]):.1%}",
        f"{np.nanmean([one.swapped for one in hard]):.2%}",
        f"{np.mean([one.seconds for one in hard]):.2f} (max {max(one.seconds for one in hard):.1f})",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def _share(outcomes: list[Outcome]) -> str:
    return f"{sum(one.is_right for one in outcomes)} of {len(outcomes)}"


def failures(outcomes: list[Outcome]) -> list[str]:
    """Return a line for each pair that is wrong or not sure."""
    return [
        f"- {one.family} {one.poses[0]} to {one.poses[1]}, {one.kind}: {'right' if one.is_right else 'WRONG'},"
        f" map error {one.error:.2f}, mirrored {one.mirrored:.1%}, confidence {one.confidence:.2f}"
        for one in outcomes
        if not one.is_right or one.confidence <= 0.5
    ]


def kin(data: Path) -> Iterator[str]:
    """Yield how sure pairs of different characters are; there is no truth for them."""
    yield "| pair | confidence | moments agree |"
    yield "|---|---|---|"
    for name, *paths in KIN:
        shapes = (
            spectral_shape(analyze(read_mesh(data / path), n_functions=2, order=1).matching_basis) for path in paths
        )
        matching = match_shapes(*shapes)
        yield f"| {name} | {matching.confidence:.2f} | {matching.symmetric:.2f}, {matching.alternating:.2f} |"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-registration")
    parser.add_argument("--pairs", type=int, default=4, help="of each family and kind of copy")
    parser.add_argument("--families", default=",".join(FAMILIES))
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    print(f"numpy {np.__version__}, scipy {version('scipy')}, pymeshlab {version('pymeshlab')}\n")
    outcomes: list[Outcome] = []
    for family in arguments.families.split(","):
        outcomes += run_family(arguments.data, family, arguments.cache, arguments.pairs)
        print(_row(family, [one for one in outcomes if one.family == family]), flush=True)
    print("\n" + "\n".join(table(outcomes)) + "\n\n" + "\n".join(failures(outcomes)) + "\n")
    print("\n".join(kin(arguments.data)))


if __name__ == "__main__":
    main()
