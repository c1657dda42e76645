"""Calibration: how often maps are right that are said to be right with some probability.

usage: ``python -m benchmarks.calibration --data DIR [--pairs N] [--families wolf,hand] [--outcomes FILE]``

Pairs whose truth is known: poses of the families, the target remeshed, decimated, noised or cut open, and all pairs of
scanned persons (faust-dev). The constants of the confidence were chosen on `CHOSEN_ON` and are judged on the others.
"""

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import permutations
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.peers import versions_of
from benchmarks.posed_families import FAMILIES, read_mesh
from benchmarks.registration import OURS, Ledger, Outcome, families, run_family
from benchmarks.registration_truth import JUDGED_FUNCTIONS
from compute.analysis.analyze import analyze
from compute.registration.eigenfunctions.matching import match_shapes
from compute.registration.eigenfunctions.spectral_shape import SpectralShape, spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.mesh import Floats, Ints

KINDS = ("remeshed", "decimated", "noised", "cut open")
SCANS = "faust-dev"
# Families whose pairs the constants were fitted to, with pairs of different animals by their landmarks; of the scans
# half of the persons.
CHOSEN_ON = ("horse", "hand", "makehuman", "shiba", "trex", SCANS)
N_BINS = 10
# Functions that carry the true places over.
N_CARRYING = 40


def calibration_error(confidence: Floats, is_right: Floats) -> float:
    """Return the expected calibration error: the mean gap between stated and found in ten bins, by their pairs."""
    bins = np.minimum((confidence * N_BINS).astype(int), N_BINS - 1)
    found = [number for number in range(N_BINS) if (bins == number).any()]
    gaps = [abs(confidence[bins == number].mean() - is_right[bins == number].mean()) for number in found]
    return float(np.average(gaps, weights=[(bins == number).sum() for number in found]))


def bins_table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield a Markdown table of ten bins: confidence stated, share found right."""
    confidence = np.array([one.confidence for one in outcomes])
    is_right = np.array([float(one.is_right) for one in outcomes])
    bins = np.minimum((confidence * N_BINS).astype(int), N_BINS - 1)
    yield "| confidence | pairs | stated, mean | right |"
    yield "|---|---|---|---|"
    for number in range(N_BINS):
        inside = bins == number
        if inside.any():
            share = f"{confidence[inside].mean():.2f} | {is_right[inside].mean():.2f}"
            yield f"| {number / N_BINS:.1f} to {(number + 1) / N_BINS:.1f} | {inside.sum()} | {share} |"
    yield ""
    yield f"Expected calibration error: {calibration_error(confidence, is_right):.3f}."


def families_table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield a Markdown table with a row for each family."""
    yield "| family | pairs | right | sure | sure and wrong | match, CPU s |"
    yield "|---|---|---|---|---|---|"
    for family in dict.fromkeys(one.family for one in outcomes):
        own = [one for one in outcomes if one.family == family]
        sure = [one for one in own if one.confidence > 0.5]
        n_wrong = sum(not one.is_right for one in sure)
        seconds = np.mean([one.seconds for one in own])
        n_right = sum(one.is_right for one in own)
        yield f"| {family} | {len(own)} | {n_right} | {len(sure)} | {n_wrong} | {seconds:.2f} |"


def run_scans(data: Path, ledger: Ledger) -> None:
    """Match all ordered pairs of scanned persons; their places are points with the same line in the files of truth."""
    folder = data / SCANS
    scans = []
    for path in sorted(folder.glob("*.off")):
        basis = analyze(read_mesh(path), n_functions=2).matching_basis
        shape = spectral_shape(basis)
        tree = cKDTree(basis.nodes[shape.node])
        vertices = basis.nodes[: len(basis.surface.mesh.vertices)]
        places = [
            tree.query(vertices[np.loadtxt(folder / "corres" / f"{path.stem}{kind}.vts", dtype=int) - 1])[1]
            for kind in ("", ".sym")
        ]
        scans.append((shape, *places))
    for first, second in permutations(range(len(scans)), 2):
        if not ledger.has(OURS, SCANS, "remeshed", (first, second)):
            ledger.add(_scan_outcome(scans[first], scans[second], (first, second)))


def _scan_outcome(
    source: tuple[SpectralShape, Ints, Ints], target: tuple[SpectralShape, Ints, Ints], number: tuple[int, int]
) -> Outcome:
    (here, places, mirrored), (there, queries, _) = source, target
    start = time.process_time()
    matching = match_shapes(here, there)
    seconds = time.process_time() - start
    size = JUDGED_FUNCTIONS + 1
    truth = np.linalg.lstsq(there.functions[queries, :N_CARRYING], here.functions[places, :size], rcond=None)[0]
    error = np.linalg.norm(matching.map[: size - 1, : size - 1] - truth[1:size, 1:]) / np.sqrt(size - 1)
    landed = here.positions[nearest_points(with_constant(matching.map), here.functions, there.functions[queries])]
    off, to_image = (np.linalg.norm(landed - here.positions[where], axis=1) for where in (places, mirrored))
    on_other_side = float(((to_image < off) & (off > 0.15)).mean())
    return Outcome(
        OURS, SCANS, "remeshed", number, float(error), on_other_side, float(off.mean()), matching.confidence, seconds
    )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-registration")
    parser.add_argument("--outcomes", type=Path, help="file that outcomes are kept in and read from")
    parser.add_argument("--pairs", type=int, default=4, help="of each family and kind of copy")
    parser.add_argument("--families", default=",".join(FAMILIES))
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    print(versions_of("numpy", "scipy", "pymeshlab") + "\n", flush=True)
    ledger = Ledger(arguments.outcomes)
    run_scans(arguments.data, ledger)
    for family in families(arguments.data, arguments.families.split(","), arguments.cache):
        run_family(family, KINDS, arguments.pairs, 0, ledger)
    for name, chosen in (("Judged on", False), ("Chosen on", True)):
        outcomes = [one for one in ledger.outcomes if (one.family in CHOSEN_ON) == chosen]
        print(f"\n{name}:\n")
        for table in (families_table, bins_table):
            print("\n".join(table(outcomes)) + "\n", flush=True)


if __name__ == "__main__":
    main()
