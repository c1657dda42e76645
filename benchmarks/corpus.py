"""Whether every mesh of a folder gives a result or a sentence: never a traceback, a hang or a changed mesh.

usage: python -m benchmarks.corpus DIR [--jobs N] [--limit SECONDS] [--log FILE] [--table FILE]

Each file is read in a process of its own. Its meshes are analyzed, divided at every level, registered with a copy that
is turned and renumbered, given an armature and cut. A log that exists is continued; a summary is printed at the end.
"""

import argparse
import csv
import hashlib
import json
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

SUFFIXES = (".off", ".obj", ".ply", ".stl", ".glb", ".gltf", ".fbx", ".blend")

# Of files with many objects, the largest; all are meshes like any other.
MOST_OBJECTS = 2

# A sentence is what an operator says to the user; anything else that goes wrong is a fault.
FINE = ("done", "sentence")


def main(arguments: list[str] | None = None) -> int:
    """Try all files, print a summary, and return 1 if there was a fault."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=float, default=600, help="seconds after which a file hangs")
    parser.add_argument("--log", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-corpus.jsonl")
    parser.add_argument("--table", type=Path, help="file for a line about each file, as comma-separated values")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.one:
        sys.stdout.write("\n" + json.dumps(try_file(options.one)))
        return 0
    files = sorted(path for path in options.folder.rglob("*") if path.suffix.lower() in SUFFIXES)
    rows = {row["file"]: row for row in _read(options.log)}
    with ThreadPoolExecutor(options.jobs) as pool, options.log.open("a") as log:
        waiting = [path for path in files if _name(path, options.folder) not in rows]
        for row in pool.map(lambda path: _in_own_process(path, options), waiting):
            rows[row["file"]] = row
            log.write(json.dumps(row) + "\n")
            log.flush()
    found = [rows[name] for path in files if (name := _name(path, options.folder)) in rows]
    if options.table:
        write_table(found, options.table)
    sys.stdout.write(summary(found))
    return int(any(outcome not in FINE for row in found for outcome in row["outcomes"].values()))


def summary(rows: list[dict[str, Any]]) -> str:
    """Return what became of each collection as Markdown, with the sentences and faults behind."""
    lines = ["| collection | files | faces | done | sentence | fault | s a file |", "|---" * 7 + "|"]
    for collection in dict.fromkeys(row["file"].split("/")[0] for row in rows):
        inside = [row for row in rows if row["file"].split("/")[0] == collection]
        counted = Counter(outcome for row in inside for outcome in row["outcomes"].values())
        n_faults = counted.total() - sum(counted[outcome] for outcome in FINE)
        n_faces = [row["faces"] for row in inside if "faces" in row] or [0]
        seconds = sum(row["seconds"] for row in inside) / len(inside)
        lines.append(
            f"| {collection} | {len(inside)} | {min(n_faces)} to {max(n_faces)} | {counted['done']} | "
            f"{counted['sentence']} | {n_faults} | {seconds:.1f} |"
        )
    counted = Counter(outcome for row in rows for outcome in row["outcomes"].values())
    said = Counter(sentence for row in rows for sentence in row["sentences"])
    lines += ["", f"{len(rows)} files: " + ", ".join(f"{n} {outcome}" for outcome, n in counted.most_common()), ""]
    return "\n".join([*lines, *(f"- {n} x {sentence}" for sentence, n in said.most_common())]) + "\n"


def write_table(rows: list[dict[str, Any]], path: Path) -> None:
    """Write a line for each file, as comma-separated values."""
    steps = list(dict.fromkeys(step for row in rows for step in row["outcomes"]))
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["file", "faces", *steps, "s"])
        for row in rows:
            outcomes = [row["outcomes"].get(step, "") for step in steps]
            writer.writerow([row["file"], row.get("faces", ""), *outcomes, f"{row['seconds']:.1f}"])


def _read(log: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in log.read_text().splitlines()] if log.is_file() else []


def _name(path: Path, folder: Path) -> str:
    return str(path.relative_to(folder))


def _in_own_process(path: Path, options: argparse.Namespace) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.corpus", str(options.folder), "--one", str(path)]
    start = time.perf_counter()
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=options.limit)
        row = json.loads(ended.stdout.splitlines()[-1])
    except subprocess.TimeoutExpired:
        row = {"outcomes": {"process": "hang"}, "sentences": []}
    except (IndexError, ValueError):
        row = {"outcomes": {"process": "crash"}, "sentences": [ended.stderr[-400:]]}
    return row | {"file": _name(path, options.folder), "seconds": time.perf_counter() - start}


def try_file(path: Path) -> dict[str, Any]:
    """Return what became of each step for the largest meshes of a file; the worst of them counts."""
    import bpy

    from tools.extension import load_extension

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    load_extension().register()
    from eigenparts.cli import formats
    from eigenparts.tasks.refusals import Refusal

    try:
        objects = formats.load(path).objects
    except Refusal as refusal:
        return {"outcomes": {"read": "sentence"}, "sentences": [str(refusal)]}
    outcomes: dict[str, str] = {}
    sentences: list[str] = []
    largest = sorted(objects, key=lambda obj: -len(obj.data.polygons))[:MOST_OBJECTS]
    for obj in largest:
        for step, act in STEPS.items():
            outcome, sentence = _outcome(act, obj)
            if outcomes.get(step) in (None, *FINE):
                outcomes[step] = outcome
            sentences += [sentence] if sentence else []
    return {"faces": sum(len(obj.data.polygons) for obj in largest), "outcomes": outcomes, "sentences": sentences}


def _outcome(act: Callable[[Any], None], obj: Any) -> tuple[str, str]:
    """Return "done", "sentence", "traceback" or "changed", and what was said."""
    before = _digest(obj.data)
    try:
        act(obj)
        outcome, sentence = "done", ""
    except RuntimeError as error:
        # So operators tell scripts what they told the user.
        sentence = " ".join(str(error).removeprefix("Error: ").split())
        outcome = "traceback" if "Traceback" in sentence or "Copy Bug Report" in sentence else "sentence"
    except Exception as error:
        outcome, sentence = "traceback", f"{type(error).__name__}: {error}"
    if act is not cut and _digest(obj.data) != before:
        outcome = "changed"
    return outcome, sentence


def _digest(mesh: Any) -> str:
    """Return a text that changes with the positions and the faces."""
    import numpy as np

    positions = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", positions)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return hashlib.sha256(positions.tobytes() + corners.tobytes() + starts.tobytes()).hexdigest()


def analyze(obj: Any) -> None:
    """Analyze an object with the defaults."""
    import bpy

    _select(obj)
    bpy.ops.eigenparts.analyze()


def every_level(obj: Any) -> None:
    """Show every level in both modes, and end at the default one."""
    import bpy

    from eigenparts.operators.mesh_state.state import read

    _select(obj)
    n_levels = 1 + read(obj.data).highest_level if read(obj.data).is_readable else 0
    for mode in ("FEATURES", "NESTED"):
        for level in range(n_levels):
            bpy.ops.eigenparts.segment(level=level, mode=mode)
    bpy.ops.eigenparts.segment()


def register(obj: Any) -> None:
    """Register a copy that is turned and numbered anew."""
    import bpy

    copy = _turned_copy(obj)
    _select(obj, copy)
    bpy.ops.eigenparts.register_selected()


def create_armature(obj: Any) -> None:
    """Build an armature, without binding the mesh to it."""
    import bpy

    _select(obj)
    bpy.ops.eigenparts.create_armature(weights="NONE")


def cut(obj: Any) -> None:
    """Cut the borders of the parts into the mesh."""
    import bpy

    _select(obj)
    bpy.ops.eigenparts.cut()


STEPS = {
    "analyze": analyze,
    "levels": every_level,
    "register": register,
    "armature": create_armature,
    "cut": cut,
}


def _turned_copy(obj: Any) -> Any:
    import bpy
    import numpy as np
    from mathutils import Matrix

    mesh = obj.data
    order = np.random.default_rng(0).permutation(len(mesh.vertices))
    place = np.argsort(order)
    copy = bpy.data.meshes.new(f"{mesh.name} turned")
    faces = [[int(place[vertex]) for vertex in polygon.vertices] for polygon in mesh.polygons]
    copy.from_pydata([mesh.vertices[int(vertex)].co for vertex in order], [], faces[::-1])
    copy.transform(Matrix.Rotation(1.0, 4, (0.6, 0.8, 0.0)))
    turned = bpy.data.objects.new(copy.name, copy)
    bpy.context.collection.objects.link(turned)
    return turned


def _select(active: Any, *others: Any) -> None:
    import bpy

    bpy.context.view_layer.update()
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in (active, *others))
    bpy.context.view_layer.objects.active = active


if __name__ == "__main__":
    sys.exit(main())
