"""Whether the command line ends by itself: every format in and out, with exit code and seconds.

usage: python -m benchmarks.command_ends
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy

from tests.cli.files import add_object, write_off
from tests.shapes import star
from tools.extension import ROOT

# Seconds after which a process counts as one that does not end.
LIMIT = 300
NAMES = ("star.blend", "star.obj", "star.ply", "star.stl", "star.glb", "star.gltf", "star.fbx", "star.off")
COMMANDS = {
    "segment": ["segment", "{file}"],
    "register": ["register", "{file}", "--source", "{source}"],
    "transfer": ["transfer", "{file}", "--source", "{source}"],
    "batch": ["batch", "{folder}", "--glob", "{name}"],
    "batch --jobs 2": ["batch", "{folder}", "--glob", "{name}", "--jobs", "2"],
    "batch --in-process": ["batch", "{folder}", "--glob", "{name}", "--in-process"],
}


def main() -> int:
    """Print the table in Markdown, and return 1 if a process did not end with 0."""
    sys.stdout.write(f"Blender {bpy.app.version_string} as a module.\n\n")
    sys.stdout.write("| command | in | out | exit code | s to the report | s to the end |\n|---|---|---|---|---|---|\n")
    codes = []
    with tempfile.TemporaryDirectory() as folder:
        source = _write_stars(Path(folder) / "in")
        for command, words in COMMANDS.items():
            for name in NAMES:
                codes.append(_run(command, words, source.with_name(name), source))
    return int(any(code != 0 for code in codes))


def _write_stars(folder: Path) -> Path:
    """Write a star in every format and return one that has weights."""
    folder.mkdir()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    obj = add_object(star(5, 3))
    obj.vertex_groups.new(name="all").add(range(len(obj.data.vertices)), 1.0, "REPLACE")
    write_off(star(5, 3), folder / "star.off")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "star.blend"), copy=True)
    bpy.ops.wm.obj_export(filepath=str(folder / "star.obj"))
    bpy.ops.wm.ply_export(filepath=str(folder / "star.ply"))
    bpy.ops.wm.stl_export(filepath=str(folder / "star.stl"))
    bpy.ops.export_scene.gltf(filepath=str(folder / "star.glb"))
    bpy.ops.export_scene.gltf(filepath=str(folder / "star.gltf"), export_format="GLTF_SEPARATE")
    bpy.ops.export_scene.fbx(filepath=str(folder / "star.fbx"))
    source = folder / "source.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(source), copy=True)
    return source


def _run(command: str, words: list[str], path: Path, source: Path) -> int | None:
    """Write a row and return the exit code, None if the process had to be ended."""
    values = {"file": path, "folder": path.parent, "name": path.name, "source": source}
    with tempfile.TemporaryDirectory() as out:
        arguments = [word.format(**values) for word in words] + ["--output", out, "--json-lines"]
        start = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-P", str(ROOT / "cli" / "launch.py"), "", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        seconds = float("nan")
        for line in process.stdout:
            if line.startswith(b'{"version"'):
                seconds = time.perf_counter() - start
        code = _exit_code(process)
        end = time.perf_counter() - start
        result = next((found.suffix for found in Path(out).iterdir() if found.suffix != ".json"), "none")
    sys.stdout.write(f"| {command} | {path.suffix} | {result} | {code} | {seconds:.1f} | {end:.1f} |\n")
    sys.stdout.flush()
    return code


def _exit_code(process: subprocess.Popen) -> int | None:
    try:
        return process.wait(LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return None


if __name__ == "__main__":
    # Blender has to end here, too.
    from tools.extension import load_extension

    load_extension()
    from eigenparts.cli.processes.ending import end_process

    end_process(main())
