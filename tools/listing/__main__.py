"""Make what the page of an extension site shows: an icon, a featured picture, five more, and the description.

usage: python -m tools.listing [--output FOLDER] [NAME...]

The picture of the window needs the Blender application and Xvfb, and is left out where they are missing.
"""

import argparse
import shutil
import sys
import time
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path

import bpy
from PIL import Image

from tools.extension import ROOT, load_extension
from tools.listing import scenes, screenshot
from tools.package import build
from tools.window import what_is_missing

DESCRIPTION = Path(__file__).with_name("description.md")
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
# Poses of the humanoid and how many vertices each has, the reference first.
POSES = (("stand", 10000), ("walk", 4000), ("reach", 8000), ("sit", 4500))
# Titles, and the lines below them.
CAPTIONS = {
    "levels.png": ("Parts at any level", "One analysis of some seconds; then the level follows the mouse"),
    "poses.png": ("The same parts in every pose", "Matched by shape alone: no rig, no training, any triangulation"),
    "window.png": (
        "In the sidebar of the 3D view",
        "Levels, names, corrections and registration in the order of the work",
    ),
    "weights.png": ("Weights for another mesh", "Shape keys, UV maps, colors and materials go along, too"),
    "bones.png": ("An armature in the parts", "Joints where parts meet, bound to the mesh"),
}
RENDERED: dict[str, Callable[[], Image.Image]] = {
    "icon.png": scenes.icon,
    "featured.png": partial(scenes.featured, MANIFEST["name"], MANIFEST["tagline"].replace(", ", ",\n").splitlines()),
    "levels.png": partial(scenes.levels, *CAPTIONS["levels.png"], (1, 2, 4)),
    "poses.png": partial(scenes.poses, *CAPTIONS["poses.png"], POSES),
    "weights.png": partial(scenes.weights, *CAPTIONS["weights.png"]),
    "bones.png": partial(scenes.bones, *CAPTIONS["bones.png"]),
}
WINDOW = "window.png"


def main(arguments: list[str]) -> int:
    """Make what is asked for, all of it if nothing is named."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join([*RENDERED, WINDOW]))
    parser.add_argument("--output", type=Path, default=ROOT / "dist" / "listing")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    shutil.copy(DESCRIPTION, options.output)
    names = options.names or [*RENDERED, WINDOW]
    load_extension().register()
    try:
        for name in filter(RENDERED.__contains__, names):
            _render(options.output / name)
    finally:
        # As a Python module, Blender cannot end while classes are registered.
        load_extension().unregister()
    if WINDOW in names:
        _take_window(options.output / WINDOW)
    return 0


def _render(target: Path) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    start = time.perf_counter()
    RENDERED[target.name]().save(target)
    _tell(f"{target}: {target.stat().st_size / 1000:.0f} kB, {time.perf_counter() - start:.0f} s")


def _take_window(target: Path) -> None:
    missing = what_is_missing()
    if missing:
        _tell(f"{target}: left out. {missing}")
        return
    archive = next(path for path in build() if path.stem.endswith("linux_x64"))
    screenshot.window(*CAPTIONS[WINDOW], archive).save(target)
    _tell(f"{target}: {target.stat().st_size / 1000:.0f} kB")


def _tell(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
