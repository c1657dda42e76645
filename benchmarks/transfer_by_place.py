"""Transfer by place: weights of clothes from the body they lie on, and whether clothes are told from other poses.

usage: python -m benchmarks.transfer_by_place --data DIR

Errors are half the sum of absolute differences of the weights at a vertex, mean over vertices. Beside ours, the way of
robust weight transfer, stand the nearest point, which Blender's Data Transfer takes, and harmonic filling.
"""

import argparse
import sys
import time
from itertools import permutations
from pathlib import Path

import numpy as np

from benchmarks.posed_families import FAMILIES, decimated, load_family, read_mesh, remeshed
from compute import TriangleMesh, analyze, correspond, correspond_by_place, fill_unsure
from compute.registration.dense.by_place import lie_together
from compute.surface.heat_smoothing import harmonic_fill
from compute.surface.mesh import Floats

GARMENTS = ("tights", "skirt")


def main(arguments: list[str]) -> int:
    """Print two Markdown tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of the families")
    data = parser.parse_args(arguments).data
    sys.stdout.write("| layer of | onto | nearest | filled harmonically | by place | lies there | s | by shape | s |\n")
    sys.stdout.write(f"{'|---' * 9}|\n")
    for row in _garments_told(data):
        sys.stdout.write(row)
        sys.stdout.flush()
    sys.stdout.write("\n| poses on one another | pairs | taken for clothes or the same surface |\n|---|---|---|\n")
    for family in FAMILIES:
        sys.stdout.write(_poses_told(data, family))
        sys.stdout.flush()
    return 0


def _garments_told(data: Path) -> list[str]:
    folder = data / "makehuman"
    body, garments = read_mesh(folder / "mh_body_0_rest.obj"), np.load(folder / "garments.npz")
    of_body = np.load(folder / "mh_body_weights.npz")["weights"].astype(np.float64)
    # The bones of the body are the first of those of the garments; the others move nothing of it.
    weights = np.pad(of_body, ((0, 0), (0, len(garments["bones"]) - of_body.shape[1])))
    rows = []
    for name in GARMENTS:
        quads, truth = garments[f"{name}_quads"].astype(np.int64), garments[f"{name}_weights"].astype(np.float64)
        cloth = TriangleMesh(garments[f"{name}_vertices"], quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))
        rows.append(_row(("body", name), body, cloth, weights, truth))
        rows.append(_row((name, "body"), cloth, body, truth, weights))
    return rows


def _row(names: tuple[str, str], source: TriangleMesh, target: TriangleMesh, weights: Floats, truth: Floats) -> str:
    start = time.process_time()
    found = correspond_by_place(source, target)
    nearest = found.transfer(weights)
    filled = fill_unsure(found, target, nearest)
    seconds = time.process_time() - start
    harmonic = harmonic_fill(target, nearest, found.is_sure)
    start = time.process_time()
    shaped = correspond(analyze(source), analyze(target), method="shape")
    by_shape, shape_seconds = fill_unsure(shaped, target, shaped.transfer(weights)), time.process_time() - start
    assert shaped.matching is not None
    told = f"{_error(by_shape, truth):.3f} ({shaped.matching.confidence:.2f})"
    errors = (f"{_error(values, truth):.3f}" for values in (nearest, harmonic, filled))
    cells = *names, *errors, f"{found.overlap:.0%}", f"{seconds:.2f}", told, f"{shape_seconds:.1f}"
    return f"| {' | '.join(cells)} |\n"


def _error(values: Floats, truth: Floats) -> float:
    return float(np.abs(values - truth).sum(axis=1).mean() / 2)


def _poses_told(data: Path, family: str) -> str:
    poses = [pose.mesh for pose in load_family(data, family)][:4]
    targets = [[mesh, remeshed(mesh), decimated(mesh)] for mesh in poses]
    pairs = [(poses[a], other) for a, b in permutations(range(len(poses)), 2) for other in targets[b]]
    return f"| {family} | {len(pairs)} | {sum(_lie_together(*pair) for pair in pairs)} |\n"


def _lie_together(source: TriangleMesh, target: TriangleMesh) -> bool:
    found = correspond_by_place(source, target)
    return lie_together(source, target, found.points, found.is_sure)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
