"""Calibration: how often maps are right that are said to be right with some probability.

usage: ``python -m benchmarks.calibration --data DIR [--pairs N] [--families wolf,hand] [--outcomes FILE]
[--pictures DIR]``

Pairs whose truth is known: poses of the families, the target remeshed, decimated, noised or cut open, and all pairs of
scanned persons (faust-dev). The constants of the confidence were chosen on `CHOSEN_ON` and are judged on the others.
"""

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from benchmarks.map_pictures import draw_map
from benchmarks.peers import versions_of
from benchmarks.posed_families import FAMILIES, read_mesh
from benchmarks.registration import MOST_MIRRORED, OURS, Family, Ledger, Outcome, families, run_family
from benchmarks.registration_truth import COPIES, JUDGED_FUNCTIONS
from compute.analysis.analyze import analyze
from compute.registration.eigenfunctions.matching import match_shapes
from compute.registration.eigenfunctions.spectral_shape import SpectralShape, spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.mesh import Floats, Ints

CHANGES = ("decimated", "noised", "cut open")
KINDS = ("remeshed", *CHANGES)
SCANS = "faust-dev"
# The scans are each remeshed by themselves, so none is another one's copy as it is.
AS_SCANNED = "same"
# Families whose pairs the constants were fitted to, with pairs of different animals by their landmarks; of the scans
# half of the persons.
CHOSEN_ON = ("horse", "hand", "makehuman", "shiba", "trex", SCANS)
N_BINS = 10
# Maps that pictures are made of.
N_WORST = 5
# Of the root of the area: how far the nearest point of a changed scan may be from one of the truth.
LARGEST_GAP = 0.02
# Functions that carry the true places over.
N_CARRYING = 40


@dataclass(frozen=True, eq=False)
class Scan:
    """A scanned person with the points of the truth: the same line of all scans is the same place of the body.

    Attributes
    ----------
    shape : SpectralShape
    places, images : (q,) int64
        Points of the shape, and those of their mirror images.
    is_there : (q,) bool
        Whether the point is on the shape still, which a cut may have taken it from.
    """

    shape: SpectralShape
    places: Ints
    images: Ints
    is_there: NDArray[np.bool_]


def calibration_error(confidence: Floats, is_right: Floats) -> float:
    """Return the expected calibration error: the mean gap between stated and found in ten bins, by their pairs."""
    bins = _bins_of(confidence)
    found = [number for number in range(N_BINS) if (bins == number).any()]
    gaps = [abs(confidence[bins == number].mean() - is_right[bins == number].mean()) for number in found]
    return float(np.average(gaps, weights=[(bins == number).sum() for number in found]))


def bins_table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield a Markdown table of ten bins: confidence stated, share found right."""
    confidence = np.array([one.confidence for one in outcomes])
    is_right = np.array([float(one.is_right) for one in outcomes])
    bins = _bins_of(confidence)
    yield "| confidence | pairs | stated, mean | right |"
    yield "|---|---|---|---|"
    for number in range(N_BINS):
        inside = bins == number
        if inside.any():
            share = f"{confidence[inside].mean():.2f} | {is_right[inside].mean():.2f}"
            yield f"| {number / N_BINS:.1f} to {(number + 1) / N_BINS:.1f} | {inside.sum()} | {share} |"
    yield ""
    yield f"Expected calibration error: {calibration_error(confidence, is_right):.3f}."


def _bins_of(confidence: Floats) -> Ints:
    return np.minimum((confidence * N_BINS).astype(int), N_BINS - 1)


def families_table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield a Markdown table with a row for each family."""
    yield "| family | pairs | right | left for right | otherwise wrong | sure | sure and wrong | distance | CPU s |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for family in dict.fromkeys(one.family for one in outcomes):
        own = [one for one in outcomes if one.family == family]
        wrong = [one for one in own if not one.is_right]
        n_mirrored = sum(one.mirrored >= MOST_MIRRORED for one in wrong)
        counts = (len(own), len(own) - len(wrong), n_mirrored, len(wrong) - n_mirrored)
        sure = (sum(one.is_sure for one in own), sum(one.is_sure for one in wrong))
        means = f"{100 * np.mean([one.distance for one in own]):.1f} | {np.mean([one.seconds for one in own]):.2f}"
        yield f"| {family} | {' | '.join(map(str, counts + sure))} | {means} |"


def worst(outcomes: Sequence[Outcome], n_wanted: int) -> list[Outcome]:
    """Return the maps that are farthest from the truth, those that are wrong and sure first."""
    return sorted(outcomes, key=lambda one: (one.is_right, -one.confidence * (not one.is_right), -one.error))[:n_wanted]


def load_scans(data: Path, kind: str) -> list[Scan]:
    """Return the scanned persons, as they are or changed."""
    folder = data / SCANS
    scans = []
    for path in sorted(folder.glob("*.off")):
        mesh = read_mesh(path)
        basis = analyze(COPIES[kind](mesh), n_functions=2).matching_basis
        shape = spectral_shape(basis)
        tree = cKDTree(basis.nodes[shape.node])
        lines = [np.loadtxt(folder / "corres" / f"{path.stem}{side}.vts", dtype=int) - 1 for side in ("", ".sym")]
        (gap, places), (_, images) = (tree.query(mesh.vertices[line]) for line in lines)
        scans.append(Scan(shape, places, images, gap < LARGEST_GAP * np.sqrt(mesh.areas.sum())))
    return scans


def run_scans(scans: dict[str, list[Scan]], ledger: Ledger) -> None:
    """Match all ordered pairs of scanned persons, each target as it is and changed."""
    for kind, targets in scans.items():
        for first, second in permutations(range(len(targets)), 2):
            if not ledger.has(OURS, SCANS, kind, (first, second)):
                ledger.add(_scan_outcome(scans[AS_SCANNED][first], targets[second], kind, (first, second)))


def _scan_outcome(source: Scan, target: Scan, kind: str, number: tuple[int, int]) -> Outcome:
    here, there = source.shape, target.shape
    start = time.process_time()
    matching = match_shapes(here, there)
    seconds = time.process_time() - start
    size, queries = JUDGED_FUNCTIONS, target.places[target.is_there]
    places, images = source.places[target.is_there], source.images[target.is_there]
    truth = np.linalg.lstsq(there.functions[queries, :N_CARRYING], here.functions[places, : size + 1], rcond=None)[0]
    error = np.linalg.norm(matching.map[:size, :size] - truth[1 : size + 1, 1:]) / np.sqrt(size)
    landed = here.positions[nearest_points(with_constant(matching.map), here.functions, there.functions[queries])]
    off, to_image = (np.linalg.norm(landed - here.positions[where], axis=1) for where in (places, images))
    mirrored = float(((to_image < off) & (off > 0.15)).mean())
    return Outcome(OURS, SCANS, kind, number, float(error), mirrored, float(off.mean()), matching.confidence, seconds)


def draw_worst(ledger: Ledger, scans: dict[str, list[Scan]], judged: Sequence[Family], folder: Path) -> None:
    """Draw the worst maps."""
    for number, one in enumerate(worst(ledger.outcomes, N_WORST)):
        if one.family == SCANS:
            shapes = [scans[kind][place].shape for kind, place in zip((AS_SCANNED, one.kind), one.poses, strict=True)]
        else:
            family = next(family for family in judged if family.name == one.family)
            shapes = [copy.shape for copy in family.copies(one.kind, one.poses)]
        draw_map(*shapes, folder / f"worst_{number}_{one.family}_{one.kind.replace(' ', '_')}.png")
        print(f"- worst {number}: {one}", flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-registration")
    parser.add_argument("--outcomes", type=Path, help="file that outcomes are kept in and read from")
    parser.add_argument("--pictures", type=Path, help="folder for pictures of the worst maps")
    parser.add_argument("--pairs", type=int, default=4, help="of each family and kind of copy")
    parser.add_argument("--families", default=",".join(FAMILIES))
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    print(versions_of("numpy", "scipy", "pymeshlab") + "\n", flush=True)
    ledger = Ledger(arguments.outcomes)
    scans = {kind: load_scans(arguments.data, kind) for kind in (AS_SCANNED, *CHANGES)}
    run_scans(scans, ledger)
    judged = list(families(arguments.data, arguments.families.split(","), arguments.cache))
    for family in judged:
        run_family(family, KINDS, arguments.pairs, 0, ledger)
    for name, chosen in (("Judged on", False), ("Chosen on", True)):
        outcomes = [one for one in ledger.outcomes if (one.family in CHOSEN_ON) == chosen]
        if outcomes:
            tables = (families_table(outcomes), bins_table(outcomes))
            print(f"\n{name}:\n\n" + "\n\n".join("\n".join(table) for table in tables) + "\n", flush=True)
    if arguments.pictures is not None:
        draw_worst(ledger, scans, judged, arguments.pictures)


if __name__ == "__main__":
    main()
