"""Matching of posed characters: ``python -m benchmarks.registration --data DIR [--pairs N] [--outcomes FILE]``.

The source is a pose as it was made, the target another pose that was remeshed or decimated and shuffled. The truth is
the connectivity that the poses share before remeshing. Beside it stand the same pairs with their own connectivity
(matched by shape, not by number), some of them by pyFM with and without its orientation term, pairs of kin without a
truth, and bodies in full resolution. With a file of outcomes, pairs that stand in it are not matched again.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from benchmarks.peers import is_installed, versions_of
from benchmarks.posed_families import FAMILIES, Mirror, Pose, find_mirror, load_family, read_mesh, shuffled
from benchmarks.registration_peers import (
    ORIENTATION_WEIGHTS,
    map_of_vertices,
    match_by_peer,
    point_of_vertex,
    prepare_peer,
)
from benchmarks.registration_truth import JUDGED_FUNCTIONS, Copy, make_copy, map_error, misplaced
from compute.analysis.analyze import analyze
from compute.registration.eigenfunctions.matching import Matching, match_shapes
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.mesh import Ints, TriangleMesh

# A pair is right when the map of the first functions is within this distance of the truth, relative to the identity,
# and less than this share of the area lands on the mirrored side.
LARGEST_ERROR = 0.3
MOST_MIRRORED = 0.05
# A matching that is surer is taken for right.
SURE = 0.5
KINDS = ("remeshed", "decimated", "same")
OURS = "Eigenparts"
KIN = (
    ("wolf and husky", "quaternius-animals/wolf_0_rest.off", "quaternius-animals/husky_0_rest.off"),
    ("fox and wolf", "quaternius-animals/fox_0_rest.off", "quaternius-animals/wolf_0_rest.off"),
    ("horse and donkey", "quaternius-animals/horse_0_rest.off", "quaternius-animals/donkey_0_rest.off"),
    ("man and woman", "odedstein/human_man.obj", "odedstein/human_woman.obj"),
    ("horse and torus", "quaternius-animals/horse_0_rest.off", "odedstein/torus.obj"),
    ("horse and hand", "quaternius-animals/horse_0_rest.off", "webxr-hand/hand_0_rest.off"),
    ("man and hand", "odedstein/human_man.obj", "webxr-hand/hand_0_rest.off"),
)


@dataclass(frozen=True)
class Outcome:
    """How one pair went."""

    method: str
    family: str
    kind: str
    poses: tuple[int, int]
    error: float
    mirrored: float
    distance: float
    confidence: float
    seconds: float

    @property
    def is_right(self) -> bool:
        """Whether the functions and the sides are those of the truth."""
        return self.error <= LARGEST_ERROR and self.mirrored < MOST_MIRRORED

    @property
    def is_sure(self) -> bool:
        """Whether the map is said to be right rather than wrong."""
        return self.confidence > SURE


class Ledger:
    """The outcomes so far, in a file if one is given."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        lines = path.read_text().splitlines() if path is not None and path.exists() else []
        self.outcomes = [Outcome(**{**row, "poses": tuple(row["poses"])}) for row in map(json.loads, lines)]
        self._known = {self._key(one.method, one.family, one.kind, one.poses) for one in self.outcomes}

    def has(self, method: str, family: str, kind: str, poses: tuple[int, int]) -> bool:
        """Whether a pair was matched before."""
        return self._key(method, family, kind, poses) in self._known

    def add(self, outcome: Outcome) -> None:
        """Keep an outcome."""
        self.outcomes.append(outcome)
        if self._path is not None:
            with self._path.open("a") as file:
                file.write(json.dumps(asdict(outcome)) + "\n")

    @staticmethod
    def _key(*parts: str | tuple[int, int]) -> str:
        return json.dumps(parts)


@dataclass(frozen=True, eq=False)
class Family:
    """Poses with what their pairs are judged by."""

    name: str
    poses: list[Pose]
    mirror: Mirror
    cache: Path

    def copies(self, kind: str, poses: tuple[int, int]) -> tuple[Copy, Copy]:
        """Return the source as it was made, and the target changed."""
        return make_copy(self.poses[poses[0]], "same", self.cache), make_copy(self.poses[poses[1]], kind, self.cache)

    def pairs(self, n_pairs: int) -> list[tuple[int, int]]:
        """Return pairs of poses, evenly chosen among all."""
        n_poses = len(self.poses)
        pairs = [(i, j) for i in range(n_poses) for j in range(n_poses) if i != j]
        return [pairs[place] for place in np.unique(np.linspace(0, len(pairs) - 1, n_pairs).astype(int)).tolist()]


def run_ours(family: Family, kind: str, poses: tuple[int, int]) -> Outcome:
    """Match a pair."""
    copies = family.copies(kind, poses)
    start = time.process_time()
    # Shapes anew, so that what is kept on them is computed within the time measured.
    matching = match_shapes(*(spectral_shape(copy.analysis.matching_basis) for copy in copies))
    seconds = time.process_time() - start
    queries = copies[1].shape.samples
    wrong = misplaced(_landed(matching, *copies), queries, copies, family.poses[0].mesh, family.mirror)
    error = map_error(matching.map, *copies)
    return Outcome(OURS, family.name, kind, poses, error, *wrong, matching.confidence, seconds)


def _landed(matching: Matching, source: Copy, target: Copy) -> Ints:
    """Return the source's point that each sample of the target lands on."""
    queries, places = target.shape.samples, source.shape.samples
    here, there = source.shape.functions[places], target.shape.functions[queries]
    return places[nearest_points(with_constant(matching.map), here, there)]


def run_peer(method: str, family: Family, kind: str, poses: tuple[int, int]) -> Outcome:
    """Match a pair by pyFM."""
    copies = family.copies(kind, poses)
    prepared = [prepare_peer(copy.analysis.mesh) for copy in copies]
    start = time.process_time()
    vertices = match_by_peer(*prepared, ORIENTATION_WEIGHTS[method])
    seconds = time.process_time() - start
    landed, queries = point_of_vertex(copies[0])[vertices], point_of_vertex(copies[1])
    wrong = misplaced(landed, queries, copies, family.poses[0].mesh, family.mirror)
    error = map_error(map_of_vertices(vertices, *copies, JUDGED_FUNCTIONS), *copies)
    return Outcome(method, family.name, kind, poses, error, *wrong, float("nan"), seconds)


def run_family(family: Family, kinds: Sequence[str], n_pairs: int, peer_every: int, ledger: Ledger) -> None:
    """Match pairs of a family, and every few of them by the peer; none if ``peer_every`` is 0."""
    for kind in kinds:
        for place, poses in enumerate(family.pairs(n_pairs)):
            if not ledger.has(OURS, family.name, kind, poses):
                ledger.add(run_ours(family, kind, poses))
            for method in ORIENTATION_WEIGHTS if peer_every and is_installed("pyFM") else ():
                if place % peer_every == 0 and not ledger.has(method, family.name, kind, poses):
                    ledger.add(run_peer(method, family, kind, poses))


def families(data: Path, names: list[str], cache: Path) -> Iterator[Family]:
    """Yield the families whose files are there."""
    for name in names:
        poses = load_family(data, name)
        if poses:
            yield Family(name, poses, find_mirror(poses[0].mesh), cache)
        else:
            print(f"{name}: no files, left out")


def table(outcomes: list[Outcome]) -> Iterator[str]:
    """Yield the Markdown table of all families."""
    yield "| family | pairs | right | sure | of these right | distance | CPU s | same connectivity |"
    yield "|---|---|---|---|---|---|---|---|"
    ours = [one for one in outcomes if one.method == OURS]
    for family in [*dict.fromkeys(one.family for one in ours), "all"]:
        yield _row(family, [one for one in ours if family in (one.family, "all")])


def _row(name: str, outcomes: list[Outcome]) -> str:
    hard = [one for one in outcomes if one.kind != "same"]
    sure = [one for one in hard if one.is_sure]
    seconds = [one.seconds for one in hard]
    cells = (
        name,
        len(hard),
        _share(hard),
        f"{len(sure) / max(len(hard), 1):.1%}",
        _share(sure),
        f"{100 * np.mean([one.distance for one in hard]):.1f}",
        f"{np.median(seconds):.2f}, at most {max(seconds):.1f}",
        _share([one for one in outcomes if one.kind == "same"]),
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def _share(outcomes: list[Outcome]) -> str:
    return f"{sum(one.is_right for one in outcomes)} of {len(outcomes)}"


def peer_table(outcomes: list[Outcome]) -> Iterator[str]:
    """Yield the Markdown table of the pairs that the peer matched as well."""
    pairs = {(one.family, one.kind, one.poses) for one in outcomes if one.method != OURS}
    yield "| method | right, remeshed or decimated | same connectivity | distance | CPU s |"
    yield "|---|---|---|---|---|"
    for method in (OURS, *ORIENTATION_WEIGHTS):
        own = [one for one in outcomes if one.method == method and (one.family, one.kind, one.poses) in pairs]
        hard, same = [one for one in own if one.kind != "same"], [one for one in own if one.kind == "same"]
        if own:
            distance = 100 * np.mean([one.distance for one in hard])
            seconds = np.median([one.seconds for one in hard])
            yield f"| {method} | {_share(hard)} | {_share(same)} | {distance:.1f} | {seconds:.2f} |"


def failures(outcomes: list[Outcome]) -> Iterator[str]:
    """Yield a line for each pair of ours that is wrong or not sure."""
    for one in outcomes:
        if one.method == OURS and not (one.is_right and one.is_sure):
            verdict = "right" if one.is_right else "WRONG"
            yield (
                f"- {one.family} {one.poses[0]} to {one.poses[1]}, {one.kind}: {verdict}, map error {one.error:.2f},"
                f" mirrored {one.mirrored:.1%}, confidence {one.confidence:.2f}"
            )


def kin(data: Path) -> Iterator[str]:
    """Yield how sure pairs of different characters are; there is no truth for them."""
    yield "| pair | confidence | moments agree |"
    yield "|---|---|---|"
    for name, *paths in KIN:
        matching = match_shapes(*(_quick_shape(read_mesh(data / path)) for path in paths))
        yield f"| {name} | {matching.confidence:.2f} | {matching.symmetric:.2f}, {matching.alternating:.2f} |"


def full_resolution(data: Path) -> Iterator[str]:
    """Yield the time of pairs of bodies as they were made, shuffled, with and without what is kept on a shape."""
    poses = load_family(data, "makehuman")
    yield "| pair | vertices | shapes, CPU s | match, CPU s | confidence |"
    yield "|---|---|---|---|---|"
    for target in poses[1:4]:
        bases = [
            analyze(mesh, n_functions=2, order=1).matching_basis for mesh in (poses[0].mesh, shuffled(target.mesh))
        ]
        start = time.process_time()
        shapes = [spectral_shape(basis) for basis in bases]
        middle = time.process_time()
        matching = match_shapes(*shapes)
        spent = f"{middle - start:.2f} | {time.process_time() - middle:.2f}"
        yield f"| rest to {target.name} | {len(target.mesh.vertices)} | {spent} | {matching.confidence:.2f} |"


def _quick_shape(mesh: TriangleMesh):
    return spectral_shape(analyze(mesh, n_functions=2, order=1).matching_basis)


def _sections(arguments: argparse.Namespace | SimpleNamespace, ledger: Ledger) -> Iterator[Iterator[str]]:
    reports: tuple[Callable[[list[Outcome]], Iterator[str]], ...] = (table, peer_table, failures)
    for report in reports:
        yield report(ledger.outcomes)
    yield kin(arguments.data)
    yield full_resolution(arguments.data)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-registration")
    parser.add_argument("--outcomes", type=Path, help="file that outcomes are kept in and read from")
    parser.add_argument("--pairs", type=int, default=4, help="of each family and kind of copy")
    parser.add_argument("--peer-every", type=int, default=4, help="pyFM matches one pair in so many")
    parser.add_argument("--families", default=",".join(FAMILIES))
    parser.add_argument("--kinds", default=",".join(KINDS), help="of copies")
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    print(versions_of("numpy", "scipy", "pymeshlab", "pyfmaps") + "\n", flush=True)
    ledger = Ledger(arguments.outcomes)
    for family in families(arguments.data, arguments.families.split(","), arguments.cache):
        run_family(family, arguments.kinds.split(","), arguments.pairs, arguments.peer_every, ledger)
        own = [one for one in ledger.outcomes if one.method == OURS and one.family == family.name]
        print(_row(family.name, own), flush=True)
    for section in _sections(arguments, ledger):
        print("\n" + "\n".join(section), flush=True)


if __name__ == "__main__":
    main()
