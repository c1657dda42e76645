"""Make the pictures of the documentation, all but those of the window, which ``make test-window`` takes.

usage: python -m tools.pictures [--output FOLDER] [--data FOLDER] [NAME...]

Pictures of meshes that are not part of the project are left out where there is no folder with these.
"""

import argparse
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import bpy

from benchmarks import spectrum_plots
from tools.extension import load_extension
from tools.pictures import family, gallery, levels, skeletons, topology, transferred

FOLDER = Path("docs/pictures")

PICTURES: dict[str, Callable[[Path], None]] = {
    "levels.gif": levels.draw,
    "family.gif": family.draw,
    "way.png": topology.draw_way,
    "gallery_humanoid.png": partial(gallery.draw, "humanoid"),
    "gallery_quadruped.png": partial(gallery.draw, "quadruped"),
    "gallery_octopus.png": partial(gallery.draw, "octopus"),
    "gallery_hand.png": partial(gallery.draw, "hand"),
    "registration.png": gallery.draw_registered,
    "complex_humanoid.png": topology.draw_complex_of_humanoid,
    "complex_handles.png": topology.draw_complex_of_handles,
    "diagram_humanoid.png": topology.draw_diagram,
    "skeleton_armatures.png": skeletons.draw_examples,
    "skeleton_posed.png": skeletons.draw_posed,
    "transfer_labels.png": transferred.draw_labels,
    "transfer_weights.png": transferred.draw_weights,
    "spectrum_convergence.png": spectrum_plots.draw_convergence,
    "spectrum_accuracy.png": spectrum_plots.draw_accuracy,
    "spectrum_size.png": spectrum_plots.draw_size,
}
# Those of other meshes.
PICTURES_OF_DATA: dict[str, Callable[[Path, Path], None]] = {
    "transfer_fox_wolf.png": transferred.draw_kin,
}


def main(arguments: list[str]) -> int:
    """Make the pictures that are asked for, all of them if none is."""
    options = _parse(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    load_extension().register()
    try:
        for name in options.names or [*PICTURES, *PICTURES_OF_DATA]:
            _make(name, options.output / name, options.data)
    finally:
        # As a Python module, Blender cannot end while classes are registered.
        load_extension().unregister()
    return 0


def _parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join([*PICTURES, *PICTURES_OF_DATA]))
    parser.add_argument("--output", type=Path, default=FOLDER)
    parser.add_argument("--data", type=Path, help="folder of meshes, as for the benchmarks")
    return parser.parse_args(arguments)


def _make(name: str, target: Path, data: Path | None) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    start = time.perf_counter()
    if name in PICTURES:
        PICTURES[name](target)
    elif data is None:
        sys.stdout.write(f"{target}: left out, as it shows meshes of a folder that is named with DATA.\n")
        return
    else:
        PICTURES_OF_DATA[name](target, data)
    size = target.stat().st_size / 1000
    sys.stdout.write(f"{target}: {size:.0f} kB, {time.perf_counter() - start:.0f} s\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
