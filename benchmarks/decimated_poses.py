"""Heads of characters that were decimated in another pose, the last table of `benchmarks.transfer`.

The source is the character at rest, the targets are all its poses with 35 % and 25 % of their triangles. Distances are
straight ones at rest, in hundredths of the root of the area (1 is about 1.3 cm on a grown-up). A vertex is wrong if it
is more than `WRONG` off, and right if it is less than `RIGHT` off.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.posed_families import Pose, closest_points, load_family
from benchmarks.registration_truth import Copy, make_copy
from compute.registration.dense.correspondence import correspond
from compute.surface.mesh import Bools, TriangleMesh
from examples import humanoid

KINDS = ("35 %", "25 %")
WRONG, RIGHT = 4.0, 1.0


@dataclass(frozen=True, eq=False)
class HeadOutcome:
    """One decimated pose: mean offsets of head and rest, shares of vertices, CPU seconds after the eigenfunctions."""

    family: str
    kind: str
    head: float
    rest: float
    doubted_head: float
    doubted: float
    sure_and_wrong: float
    doubted_and_right: float
    seconds: float


def run_decimated(data: Path, cache: Path) -> Iterator[HeadOutcome]:
    """Yield the outcomes of all poses of makehuman, if it is there, and of the humanoid that the project makes."""
    for poses, is_head in (_makehuman(data), _humanoid()):
        for pose in poses[1:]:
            for kind in KINDS:
                source, target = make_copy(poses[0], "same", cache), make_copy(pose, kind, cache)
                yield _outcome(source, target, kind, is_head)


def _makehuman(data: Path) -> tuple[list[Pose], Bools]:
    poses = load_family(data, "makehuman")
    if not poses:
        return [], np.zeros(0, dtype=bool)
    known = np.load(data / "makehuman" / "mh_body_weights.npz", allow_pickle=True)
    return poses, known["part_of_vertex"] == [str(part) for part in known["parts"]].index("head")


def _humanoid() -> tuple[list[Pose], Bools]:
    character = humanoid(13_000)
    meshes = {name: TriangleMesh(character.mesh_in_pose(name), character.triangles) for name in character.poses}
    is_head = character.fine_part_of_vertex == character.fine_part_names.index("head")
    return [Pose("humanoid", name, mesh) for name, mesh in meshes.items()], is_head


def _outcome(source: Copy, target: Copy, kind: str, is_head: Bools) -> HeadOutcome:
    start = time.process_time()
    found = correspond(source.analysis, target.analysis)
    seconds = time.process_time() - start
    rest = source.pose.mesh
    truth = closest_points(target.analysis.mesh.vertices, target.pose.mesh)
    off = np.linalg.norm(found.transfer(rest.vertices) - truth.on(rest), axis=1) * 100 / np.sqrt(rest.areas.sum())
    corner = rest.triangles[truth.triangle, truth.barycentric.argmax(axis=1)]
    head, sure = is_head[corner], found.is_sure
    return HeadOutcome(
        family=target.pose.family,
        kind=kind,
        head=float(off[head].mean()),
        rest=float(off[~head].mean()),
        doubted_head=float((~sure[head]).mean()),
        doubted=float((~sure).mean()),
        sure_and_wrong=float((sure & (off > WRONG)).mean()),
        doubted_and_right=float((~sure & (off < RIGHT)).mean()),
        seconds=seconds,
    )


def head_table(outcomes: list[HeadOutcome]) -> list[str]:
    """Return the Markdown table, a row for each family and share of triangles."""
    lines = [
        "| family | triangles | poses | head off, mean | worst | rest off | head doubted | all doubted "
        "| sure and wrong | doubted and right | CPU s |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for family, kind in dict.fromkeys((one.family, one.kind) for one in outcomes):
        some = [one for one in outcomes if (one.family, one.kind) == (family, kind)]
        shares = ("doubted_head", "doubted", "sure_and_wrong", "doubted_and_right")
        cells = [family, kind, str(len(some)), f"{_mean(some, 'head'):.2f}", f"{max(one.head for one in some):.2f}"]
        cells += [f"{_mean(some, 'rest'):.2f}", *(f"{_mean(some, name):.1%}" for name in shares)]
        lines.append("| " + " | ".join([*cells, f"{_mean(some, 'seconds'):.1f}"]) + " |")
    return lines


def _mean(outcomes: list[HeadOutcome], name: str) -> float:
    return float(np.mean([getattr(one, name) for one in outcomes]))
