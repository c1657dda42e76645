"""How fast the level slider answers: ``eigenparts.segment`` with colours and mesh update, without redraw.

Once as analyzed, and once with a border that was moved, a part that was split and faces that were painted.

usage: python -m benchmarks.slider [--vertices N ...] [--profile]
"""

import argparse
import cProfile
import io
import pstats
import statistics
import sys
import time

import bpy

from examples import humanoid
from examples.blender import add_posed_mesh
from tools.extension import load_extension

N_LEVELS = 20


def main(arguments: list[str]) -> int:
    """Print one row of a Markdown table for each size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vertices", type=int, nargs="+", default=[10_000, 50_000])
    parser.add_argument("--profile", action="store_true", help="tell where the time goes")
    options = parser.parse_args(arguments)
    load_extension().register()
    sys.stdout.write(f"bpy {bpy.app.version_string}\n\n")
    sys.stdout.write(
        "| vertices | faces | levels | median | slowest | fingerprint alone | median, corrected |\n"
        "|---|---|---|---|---|---|---|\n"
    )
    for n_vertices in options.vertices:
        obj = _analyzed(n_vertices)
        seconds = _times(obj)
        _correct(obj)
        sys.stdout.write(_row(obj.data, seconds, statistics.median(_times(obj))))
        if options.profile:
            _profile(obj)
    return 0


def _analyzed(n_vertices: int) -> bpy.types.Object:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    obj = add_posed_mesh(humanoid(n_vertices))
    bpy.context.view_layer.objects.active = obj
    bpy.ops.eigenparts.analyze()
    return obj


def _levels(obj: bpy.types.Object) -> list[int]:
    """Return levels in an order in which each differs from the one before."""
    n_levels = obj.data["eigenparts_state"]["hierarchy"]["n_levels"]
    return [(7 * step) % n_levels for step in range(N_LEVELS)]


def _times(obj: bpy.types.Object) -> list[float]:
    times = []
    for level in _levels(obj):
        start = time.perf_counter()
        bpy.ops.eigenparts.segment(level=level)
        times.append(time.perf_counter() - start)
    return times


def _correct(obj: bpy.types.Object) -> None:
    """Make one correction of each kind that has to do with faces."""
    bpy.ops.eigenparts.segment()
    first, second = (row.part for row in sorted(obj.data.eigenparts.rows, key=lambda row: -row.n_faces)[:2])
    bpy.ops.eigenparts.move_border(part=first, offset=0.05)
    bpy.ops.eigenparts.split_part(part=second)
    obj.data.polygons.foreach_set("select", [index < 100 for index in range(len(obj.data.polygons))])
    bpy.ops.eigenparts.paint_part(part=first)


def _row(mesh: bpy.types.Mesh, seconds: list[float], corrected: float) -> str:
    from eigenparts.operators.mesh_data.mesh_arrays import fingerprint

    start = time.perf_counter()
    fingerprint(mesh)
    alone = time.perf_counter() - start
    cells = [f"{1000 * value:.1f} ms" for value in (statistics.median(seconds), max(seconds), alone, corrected)]
    counts = [len(mesh.vertices), len(mesh.polygons), mesh["eigenparts_state"]["hierarchy"]["n_levels"]]
    return f"| {' | '.join(map(str, counts + cells))} |\n"


def _profile(obj: bpy.types.Object) -> None:
    profile = cProfile.Profile()
    profile.enable()
    for level in _levels(obj):
        bpy.ops.eigenparts.segment(level=level)
    profile.disable()
    text = io.StringIO()
    pstats.Stats(profile, stream=text).sort_stats("tottime").print_stats(18)
    sys.stdout.write(text.getvalue())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
