"""Joints against those of the rigs, and against skeletor's skeletons of the same meshes.

usage: python -m benchmarks.skeleton [--data DIR] [--peer PYTHON] [--sizes]

Distances are means over joints in percent of the largest extent: from true joints to found ones, and back. A limb joint
(shoulder, elbow, wrist, hip, knee, ankle) is found if a joint lies within 5 %. "inside" counts joints whose winding
number is above one half. PYTHON is an interpreter that has skeletor; it runs on the same meshes in the same run. CPU
seconds of the first call after the analysis, with all that it makes when first asked.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.posed_families import read_mesh
from compute import TriangleMesh, analyze, binding_weights, skeleton
from compute.surface.mesh import Floats
from examples import humanoid, octopus, quadruped

NEAR = 0.05
SIZES = (5_000, 10_000, 20_000, 50_000)
EXAMPLES = {"humanoid": humanoid, "octopus": octopus, "quadruped": quadruped}
# Bones whose heads are the joints of limbs.
LIMB_BONES = {
    "humanoid": ("upper_arm", "forearm", "hand", "thigh", "shin", "foot"),
    "octopus": tuple(f"arm_{number}_1" for number in range(1, 5)),
    "quadruped": ("fore_shin", "fore_paw", "hind_shin", "hind_paw"),
    "makehuman": ("upperarm01", "lowerarm01", "wrist", "upperleg01", "lowerleg01", "foot"),
}
FILES = {
    "wolf": "quaternius-animals/wolf_0_rest.off",
    "hand": "webxr-hand/hand_0_rest.off",
    "camel": "cgal-data/camel.off",
    "armadillo": "psb-dev/off/281.off",
}
# What skeletor recommends for shapes with limbs: contraction of the surface, then its edges.
PEER = """
import sys, time, numpy as np, skeletor, trimesh
data = np.load(sys.argv[1])
start = time.process_time()
mesh = trimesh.Trimesh(data["vertices"], data["triangles"], process=False)
if sys.argv[3] == "contraction":
    contracted = skeletor.pre.contract(mesh, epsilon=0.1, progress=False)
    found = skeletor.skeletonize.by_edge_collapse(contracted, progress=False)
else:
    found = skeletor.skeletonize.by_wavefront(mesh, waves=1, progress=False)
seconds = time.process_time() - start
degree = np.bincount(np.asarray(found.edges).ravel(), minlength=len(found.vertices))
np.savez(sys.argv[2], joints=np.asarray(found.vertices), n_leaves=(degree == 1).sum(), seconds=seconds)
"""


@dataclass(frozen=True, eq=False)
class Subject:
    """A mesh, with its true joints and the limb joints among them if they are known."""

    name: str
    mesh: TriangleMesh
    true: Floats | None = None
    limbs: Floats | None = None


def main() -> int:
    """Print the tables as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder with makehuman, quaternius-animals and others")
    parser.add_argument("--peer", type=Path, help="Python with skeletor")
    parser.add_argument("--sizes", action="store_true", help="measure how time grows instead")
    arguments = parser.parse_args()
    if arguments.sizes:
        sys.stdout.write(_table_of_sizes())
        return 0
    head = "| mesh | vertices | method | joints | leaves | inside | true to found | found to true | limb joints | s |"
    sys.stdout.write(f"{head}\n|{10 * '---|'}\n")
    for subject in (*_examples(), *_from_files(arguments.data)):
        for row in _rows(subject, arguments.peer):
            sys.stdout.write(f"{row}\n")
            sys.stdout.flush()
    return 0


def winding_numbers(points: Floats, mesh: TriangleMesh) -> Floats:
    """Return how often a closed mesh winds around each point."""
    return np.array([_winding_number(mesh.vertices[mesh.triangles] - point) for point in points])


def _winding_number(corners: Floats) -> float:
    a, b, c = corners.swapaxes(0, 1)
    lengths = [np.linalg.norm(side, axis=1) for side in (a, b, c)]
    volume = np.einsum("tj,tj->t", a, np.cross(b, c))
    dots = [np.einsum("tj,tj->t", *pair) for pair in ((b, c), (c, a), (a, b))]
    below = np.prod(lengths, axis=0) + sum(dot * length for dot, length in zip(dots, lengths, strict=True))
    return float(np.arctan2(volume, below).sum() / (2 * np.pi))


def _examples() -> list[Subject]:
    subjects = []
    for name, make in EXAMPLES.items():
        character = make()
        true = np.unique([point for bone in character.bones for point in (bone.head, bone.tail)], axis=0)
        heads = {bone.name: bone.head for bone in character.bones}
        limbs = np.array([heads[f"{bone}.{side}"] for bone in LIMB_BONES[name] for side in "LR"])
        subjects.append(Subject(name, TriangleMesh(character.vertices, character.triangles), true, limbs))
    return subjects


def _from_files(data: Path | None) -> list[Subject]:
    if data is None or not data.is_dir():
        sys.stderr.write("Skipped: there is no folder with further meshes.\n")
        return []
    subjects = [_makehuman(data / "makehuman")] if (data / "makehuman").is_dir() else []
    files = {name: data / file for name, file in FILES.items() if (data / file).is_file()}
    return subjects + [Subject(name, read_mesh(file)) for name, file in files.items()]


def _makehuman(folder: Path) -> Subject:
    bones = json.loads((folder / "mh_bones.json").read_text())
    # The rig of the face has as many joints as all the rest; those of the body are its ancestors and limbs.
    face = {"head"}
    for name, bone in bones.items():
        if bone["parent"] in face:
            face.add(name)
    true = np.unique([bone["head"] for name, bone in bones.items() if name not in face - {"head"}], axis=0)
    limbs = np.array([bones[f"{bone}.{side}"]["head"] for bone in LIMB_BONES["makehuman"] for side in "LR"])
    return Subject("makehuman", read_mesh(folder / "mh_body_0_rest.obj"), true, limbs)


def _rows(subject: Subject, peer: Path | None) -> Iterator[str]:
    analysis = analyze(subject.mesh)
    labels = analysis.segment(mode="nested").labels
    start = time.process_time()
    found = skeleton(analysis, labels=labels, n_pieces=2)
    seconds = time.process_time() - start
    n_leaves = len(np.setdiff1d(np.arange(1, len(found.joints)), found.parent))
    yield _row(subject, "Reeb graph, ours", found.joints, n_leaves, seconds)
    for method in ("wavefront", "contraction") if peer else ():
        yield _row_of_peer(subject, peer, method)


def _row_of_peer(subject: Subject, peer: Path, method: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        mesh, result = Path(folder) / "mesh.npz", Path(folder) / "result.npz"
        np.savez(mesh, vertices=subject.mesh.vertices, triangles=subject.mesh.triangles)
        run = subprocess.run([peer, "-W", "ignore", "-c", PEER, mesh, result, method], capture_output=True, timeout=500)
        if run.returncode:
            return f"| {subject.name} | | skeletor, {method} | failed | | | | | | |"
        found = np.load(result)
        return _row(subject, f"skeletor, {method}", found["joints"], int(found["n_leaves"]), float(found["seconds"]))


def _row(subject: Subject, method: str, joints: Floats, n_leaves: int, seconds: float) -> str:
    size = np.ptp(subject.mesh.vertices, axis=0).max()
    n_inside = int((winding_numbers(joints, subject.mesh) > 0.5).sum())
    figures = ["", "", ""]
    if subject.true is not None:
        apart = np.linalg.norm(subject.true[:, None] - joints, axis=2) / size
        limbs = np.linalg.norm(subject.limbs[:, None] - joints, axis=2).min(axis=1) / size
        share = f"{(limbs < NEAR).sum()} of {len(limbs)}"
        figures = [f"{100 * apart.min(axis=1).mean():.1f} %", f"{100 * apart.min(axis=0).mean():.1f} %", share]
    cells = [
        subject.name,
        len(subject.mesh.vertices),
        method,
        len(joints),
        n_leaves,
        n_inside,
        *figures,
        f"{seconds:.2f}",
    ]
    return "| " + " | ".join(map(str, cells)) + " |"


def _table_of_sizes(sizes: Sequence[int] = SIZES) -> str:
    lines = ["| vertices | order | joints | skeleton, s | weights, s |", "|---|---|---|---|---|"]
    for size in sizes:
        character = humanoid(size)
        analysis = analyze(TriangleMesh(character.vertices, character.triangles))
        labels = analysis.segment(mode="nested").labels
        start = time.process_time()
        found = skeleton(analysis, labels=labels, n_pieces=2)
        middle = time.process_time()
        binding_weights(analysis, found)
        seconds = f"{middle - start:.2f} | {time.process_time() - middle:.2f}"
        order = analysis.eigenbasis.order
        lines.append(f"| {len(character.vertices)} | {order} | {len(found.joints)} | {seconds} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
