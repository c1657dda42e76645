"""Segment a character in two poses, or the user's own file, and leave a .blend, a report and pictures.

usage: python tools/demo.py [--mesh FILE] [--output FOLDER]
"""

import argparse
import json
import sys
import time
from pathlib import Path
from typing import TypedDict

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import bpy

import examples
from examples.blender import add_posed_mesh
from tools.extension import load_extension

load_extension()
from eigenparts.cli import formats
from eigenparts.cli.processes.suppress_output import blender_is_quiet as quiet
from eigenparts.operators.blender.known_values import mesh_of, present
from eigenparts.operators.mesh_state.state import read
from eigenparts.tasks.refusals import Refusal
from tools.extension_operators import run_operator
from tools.render import render, side_by_side

POSES = ("rest", "walk")
# Coarse is the level a person would pick; fine shows whatever stands out by a thousandth of the range, such as fingers.
LEVELS: dict[str, dict[str, float]] = {"coarse": {}, "fine": {"threshold": 1e-3}}


class Part(TypedDict):
    """A part in the report."""

    id: int
    share_of_area: float
    faces: int


class Level(TypedDict):
    """The parts that an object shows at one level."""

    level: int
    n_levels: int
    parts: list[Part]


class Row(TypedDict):
    """An object in the report."""

    name: str
    seconds: float
    levels: dict[str, Level]
    pictures: list[str]


def main(arguments: list[str]) -> int:
    """Run the demo; print where everything is."""
    options = _parse(arguments)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    objects = _load(options.mesh) if options.mesh else _characters()
    load_extension().register()
    options.output.mkdir(parents=True, exist_ok=True)
    try:
        rows = [_divide(obj, options.output) for obj in objects]
    except RuntimeError as error:
        sys.exit(str(error).removeprefix("Error: ").strip())
    finally:
        # As a Python module, Blender cannot end while classes are registered.
        load_extension().unregister()
    pictures = [options.output / picture for row in rows for picture in row["pictures"]]
    _leave(options.output, rows, side_by_side(pictures, options.output / "overview.png"))
    return 0


def _parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesh", type=Path, help="a file of your own instead of the character")
    parser.add_argument("--output", type=Path, default=Path("demo"))
    return parser.parse_args(arguments)


def _characters() -> list[bpy.types.Object]:
    """Add the humanoid in two poses, side by side."""
    character = examples.humanoid()
    objects = [add_posed_mesh(character, pose) for pose in POSES]
    for place, obj in enumerate(objects):
        obj.location.x = 1.8 * place
    present(bpy.context.view_layer).update()
    return objects


def _load(path: Path) -> list[bpy.types.Object]:
    try:
        return formats.load(path).objects
    except Refusal as refusal:
        sys.exit(f"{path}: {refusal}")


def _divide(obj: bpy.types.Object, folder: Path) -> Row:
    """Analyze one object, take a picture at each level, and return its row of the report."""
    present(bpy.context.view_layer).objects.active = obj
    start = time.perf_counter()
    run_operator("analyze")
    seconds, levels = round(time.perf_counter() - start, 2), dict[str, Level]()
    pictures = [_picture(obj, folder, name, levels) for name in reversed(LEVELS)][::-1]
    return {"name": obj.name, "seconds": seconds, "levels": levels, "pictures": pictures}


def _picture(obj: bpy.types.Object, folder: Path, name: str, levels: dict[str, Level]) -> str:
    run_operator("segment", **LEVELS[name])
    summary = read(mesh_of(obj)).summary
    parts: list[Part] = [
        {"id": part, "share_of_area": round(share, 4), "faces": n_faces} for part, share, n_faces in summary.parts
    ]
    levels[name] = {"level": summary.level, "n_levels": summary.n_levels, "parts": parts}
    with quiet():
        return render([obj], folder / f"{obj.name.replace(' ', '_')}_{name}.png").name


def _leave(folder: Path, rows: list[Row], overview: Path) -> None:
    (folder / "report.json").write_text(json.dumps({"objects": rows}, indent=2) + "\n")
    with quiet():
        bpy.ops.wm.save_as_mainfile(filepath=str((folder / "demo.blend").resolve()), compress=True)
    for row in rows:
        counts = ", ".join(f"{len(level['parts'])} parts at level {level['level']}" for level in row["levels"].values())
        sys.stdout.write(f"{row['name']}: {counts} ({row['seconds']} s)\n")
    sys.stdout.write(
        f"Pictures, demo.blend and report.json are in {folder.resolve()}; look at {overview.name} first.\n"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
