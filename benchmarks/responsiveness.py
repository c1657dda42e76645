"""How long the window is silent while a mesh is analyzed, registered or transferred to, and how soon ESC gives it back.

usage: python -m benchmarks.responsiveness ZIP [--vertices N ...]
"""

import argparse
import os
import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path

from examples import humanoid
from examples.character import Character
from tools.window import Window, what_is_missing

STATUS = "bpy.context.window_manager.eigenparts"
TICKS = f"ticks = Ticks(lambda: {STATUS}.text if {STATUS}.is_running else 'before and after')"
# What runs, one after the other; the walker is selected, the body active.
JOBS = {
    "analyze": "bpy.ops.eigenparts.analyze('INVOKE_DEFAULT')",
    "register": "bpy.ops.eigenparts.register_selected('INVOKE_DEFAULT')",
    "transfer": "bpy.ops.eigenparts.transfer('INVOKE_DEFAULT', layers={'GROUPS', 'PARTS'})",
}
# The other mesh has this share of the vertices.
WALKER = 0.8
# At which part of the way ESC is pressed.
FRACTIONS = (0.02, 0.2, 0.4, 0.6, 0.8)
# What is redrawn while nothing is computed, as often as progress redraws the sidebar ("UI").
REDRAW = """
def redraw():
    with over_view() as context:
        for region in context.area.regions:
            if region.type == {region!r}:
                region.tag_redraw()
    return 0.1 if redrawing else None
redrawing = True
bpy.app.timers.register(redraw)
"""


def main(arguments: list[str]) -> int:
    """Print two Markdown tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("archive", type=Path, help="the zip for this machine")
    parser.add_argument("--vertices", type=int, nargs="+", default=[13_000, 50_000])
    options = parser.parse_args(arguments)
    if what_is_missing():
        sys.exit(what_is_missing())
    with tempfile.TemporaryDirectory() as folder:
        window = _open(Path(folder), options.archive)
        try:
            _measure(window, options.vertices)
        finally:
            window.close()
    return 0


def _open(folder: Path, archive: Path) -> Window:
    window = Window(folder)
    copy = shutil.copy(archive, folder)
    window.run(
        f"bpy.ops.extensions.package_install_files(filepath={str(copy)!r}, repo='user_default', enable_on_install=True)"
    )
    window.run("with over_view(): bpy.ops.object.select_all(action='SELECT'); bpy.ops.object.delete()")
    window.run("with over_view() as context: context.space_data.show_region_ui = True")
    window.settle(3.0)
    window.run(
        "with over_view() as context:\n"
        "    next(r for r in context.area.regions if r.type == 'UI').active_panel_category = 'Eigenparts'"
    )
    return window


def _measure(window: Window, sizes: list[int]) -> None:
    version, load = window.value("bpy.app.version_string"), os.getloadavg()[0]
    sys.stdout.write(f"Blender {version}, {os.cpu_count()} cores, load before {load:.1f}\n\n")
    sys.stdout.write(f"Idle, sidebar redrawn ten times a second: longest gap {1000 * _idle(window, 'UI'):.0f} ms\n\n")
    headings = ("vertices", "job", "s", "median gap", "longest", "over 150 ms", "the longest, and when")
    sys.stdout.write(f"| {' | '.join(headings)} |\n{'|---' * len(headings)}|\n")
    told = []
    for size in sizes:
        _add(window, humanoid(size), humanoid(int(WALKER * size)))
        for name, call in JOBS.items():
            sys.stdout.write(_gaps_told(window, name, call))
            sys.stdout.flush()
        alone = _idle(window, "WINDOW")
        sys.stdout.write(f"| {size} | none, view redrawn | | | {1000 * alone:.0f} ms | | |\n")
        told.append(_cancelling_told(window))
    sys.stdout.write(
        "\n| vertices | " + " | ".join(f"ESC at {f:.0%}" for f in FRACTIONS) + " |\n|---|---|---|---|---|---|\n"
    )
    sys.stdout.write("".join(told))


def _idle(window: Window, region: str) -> float:
    """Return the longest gap while a region is redrawn and nothing is computed."""
    window.run(REDRAW.format(region=region) + "ticks = Ticks()")
    time.sleep(4.0)
    window.run("redrawing = False")
    return max(gap for gap, _ in window.value("ticks.stop()"))


def _add(window: Window, standing: Character, walking: Character) -> None:
    """Put one character into the file, the other beside it in another pose and selected too."""
    window.run("for other in list(bpy.data.objects): bpy.data.objects.remove(other)")
    places = {"walker": walking.mesh_in_pose("walk"), "body": standing.vertices}
    for (name, vertices), character in zip(places.items(), (walking, standing), strict=True):
        window.run(
            f"mesh = bpy.data.meshes.new('{name}')\n"
            f"mesh.from_pydata({vertices.round(6).tolist()}, [], {character.quads.tolist()})\n"
            f"body = bpy.data.objects.new('{name}', mesh)\n"
            "bpy.context.scene.collection.objects.link(body)\n"
            "body.select_set(True)"
        )
    window.run(
        "bpy.data.objects['walker'].location.x = 1.5\n"
        "body.vertex_groups.new(name='half').add(range(len(mesh.vertices) // 2), 1.0, 'REPLACE')\n"
        "bpy.context.view_layer.objects.active = body\n"
        "with over_view(): bpy.ops.view3d.view_axis(type='FRONT'); bpy.ops.view3d.view_all()"
    )
    window.settle(2.0)


def _gaps_told(window: Window, name: str, call: str) -> str:
    window.run(TICKS)
    start = time.monotonic()
    _invoke(window, call)
    window.wait_for(f"{STATUS}.is_running")
    window.wait_for(f"not {STATUS}.is_running", 600)
    seconds = time.monotonic() - start
    window.settle(2.0)
    gaps = sorted(window.value("ticks.stop()"), reverse=True)
    longest = ", ".join(f"{1000 * gap:.0f} {text}" for gap, text in gaps[:5])
    median = statistics.median(gap for gap, _ in gaps)
    n_long = sum(gap > 0.15 for gap, _ in gaps)
    told = (f"{1000 * value:.0f} ms" for value in (median, gaps[0][0]))
    size = window.value("len(mesh.vertices)")
    return f"| {' | '.join([f'{size}', name, f'{seconds:.1f}', *told, f'{n_long}', longest])} |\n"


def _cancelling_told(window: Window) -> str:
    seconds = []
    for fraction in FRACTIONS:
        _invoke(window, JOBS["analyze"])
        window.wait_for(f"{STATUS}.is_running and {STATUS}.fraction >= {fraction}")
        start = time.monotonic()
        window.press("ESC")
        window.wait_for(f"not {STATUS}.is_running")
        seconds.append(f"{1000 * (time.monotonic() - start):.0f} ms")
    return f"| {window.value('len(mesh.vertices)')} | {' | '.join(seconds)} |\n"


def _invoke(window: Window, call: str) -> None:
    window.run(f"with over_view(): {call}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
