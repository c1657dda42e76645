"""Parts of posed characters after registration: ``python -m benchmarks.registered_parts --data DIR [--pairs N]``.

The reference is a pose as it was made, at its default level; the target another pose that was remeshed or decimated and
shuffled. The truth is the reference's labels, carried over by the connectivity that the poses share before remeshing.
"""

import argparse
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.posed_families import FAMILIES, closest_points, load_family
from benchmarks.registration_truth import Copy, make_copy
from compute.registration.parts.population import Reference, label_matched, match_divisible, prepare_reference
from compute.registration.parts.transferred_labels import divisible

KINDS = ("remeshed", "decimated")


@dataclass(frozen=True)
class Outcome:
    """How one pair went: shares of the area with the true label, and with another part's; CPU seconds of both steps."""

    family: str
    right: float
    other_part: float
    matching_seconds: float
    labelling_seconds: float


def run_pair(family: str, reference: Reference, target: Copy) -> Outcome:
    """Register a pair."""
    shape = divisible(target.analysis, target.shape)
    start = time.process_time()
    matching = match_divisible(reference, shape)
    middle = time.process_time()
    found = label_matched(reference, shape, matching, 1 + reference.parts.given.highest).faces
    stop = time.process_time()
    mesh = target.analysis.mesh
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    true = reference.parts.given.labels[closest_points(middles, target.pose.mesh).triangle]
    share = mesh.areas / mesh.areas.sum()
    other = share[(true != found) & (true > 0) & (found > 0)].sum()
    return Outcome(family, float(share[true == found].sum()), float(other), middle - start, stop - middle)


def run_family(data: Path, family: str, cache: Path, n_pairs: int) -> Iterator[Outcome]:
    """Yield the outcomes of the first pose with others, evenly chosen."""
    poses = load_family(data, family)
    if not poses:
        print(f"{family}: no files, left out")
        return
    source = make_copy(poses[0], "same", cache)
    reference = prepare_reference(source.analysis, source.analysis.segment(mode="features"))
    for kind in KINDS:
        for place in np.unique(np.linspace(1, len(poses) - 1, n_pairs).astype(int)).tolist():
            yield run_pair(family, reference, make_copy(poses[place], kind, cache))


def _row(name: str, outcomes: list[Outcome]) -> str:
    right, other, matching, labelling = np.array(
        [[one.right, one.other_part, one.matching_seconds, one.labelling_seconds] for one in outcomes]
    ).T
    cells = f"{right.mean():.1%} | {right.min():.1%} | {other.mean():.2%} | {np.median(matching):.1f}"
    return f"| {name} | {len(outcomes)} | {cells} | {np.median(labelling):.1f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-registration")
    parser.add_argument("--pairs", type=int, default=3, help="of each family and kind of copy")
    parser.add_argument("--families", default=",".join(FAMILIES))
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    print(
        "| family | pairs | right | least | other part | match, CPU s | parts, CPU s |\n|---|---|---|---|---|---|---|"
    )
    outcomes: list[Outcome] = []
    for family in arguments.families.split(","):
        own = list(run_family(arguments.data, family, arguments.cache, arguments.pairs))
        outcomes += own
        if own:
            print(_row(family, own), flush=True)
    print(_row("all", outcomes))


if __name__ == "__main__":
    main()
