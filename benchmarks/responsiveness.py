"""How long the window is silent while a mesh is analyzed, registered or transferred to, and how soon ESC gives it back.

usage: python -m benchmarks.responsiveness ZIP [--vertices N ...] [--large N]

Before, what a first analysis takes whose worker process is started for it, one whose worker is there, and one that a
script waits for; and the memory of Blender and its worker around the analysis of a large mesh.
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
# Vertices of the mesh that is analyzed first, and how often each way.
FIRST_VERTICES, N_TIMES = 5_000, 5
# Where both processes can be told apart.
WORKER = "sys.modules[next(name for name in sys.modules if name.endswith('jobs.worker_process'))]"
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
    parser.add_argument("--large", type=int, default=200_000, help="vertices of the mesh that memory is read for")
    options = parser.parse_args(arguments)
    if what_is_missing():
        sys.exit(what_is_missing())
    with tempfile.TemporaryDirectory() as folder:
        window = _open(Path(folder), options.archive)
        try:
            sys.stdout.write(_first_told(window))
            _measure(window, options.vertices)
            sys.stdout.write(_memory_told(window, options.large))
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


def _first_told(window: Window) -> str:
    """Analyze a small mesh with a worker that has to be started, with one that is there, and in Blender itself."""
    character = humanoid(FIRST_VERTICES)
    _add(window, character, character)
    window.run("import sys, time")
    invoke, wait = JOBS["analyze"], "bpy.ops.eigenparts.analyze()"
    # Imports and the first solve of a process are in its first analysis, whoever does it.
    window.run(f"with over_view(): {wait}")
    started = [_seconds_of(window, invoke, before=f"{WORKER}.stop_worker()") for _ in range(N_TIMES)]
    told = {
        "worker started for it": started,
        "worker there": [_seconds_of(window, invoke) for _ in range(N_TIMES)],
        "synchronous, in Blender": [_seconds_of(window, wait) for _ in range(N_TIMES)],
    }
    n_vertices = window.value("len(mesh.vertices)")
    rows = (
        f"| {name} | {statistics.median(seconds):.2f} | {min(seconds):.2f} to {max(seconds):.2f} |\n"
        for name, seconds in told.items()
    )
    return f"| analyze {n_vertices} vertices | s | of {N_TIMES} |\n|---|---|---|\n{''.join(rows)}\n"


def _seconds_of(window: Window, call: str, before: str = "None") -> float:
    """Return what a call takes until it has ended, by Blender's own clock."""
    window.run(before)
    # The status is set at the first tick.
    window.run(
        "ended = []\n"
        "def look():\n"
        f"    if not {STATUS}.is_running and time.monotonic() - began > 0.03: ended.append(time.monotonic())\n"
        "    return None if ended else 0.005\n"
        "began = time.monotonic()\n"
        f"with over_view(): {call}\n"
        "bpy.app.timers.register(look, first_interval=0.03)"
    )
    window.wait_for("ended")
    return float(window.value("ended[0] - began"))


def _memory_told(window: Window, n_vertices: int) -> str:
    """Analyze a large mesh, and tell the memory of both processes before, at most meanwhile, and afterwards."""
    character = humanoid(n_vertices)
    _add(window, character, humanoid(FIRST_VERTICES))
    _seconds_of(window, JOBS["analyze"], before="bpy.context.view_layer.objects.active = bpy.data.objects['walker']")
    window.run("bpy.context.view_layer.objects.active = body")
    window.run("import os")
    ids = {"Blender": window.value("os.getpid()"), "worker": window.value(f"{WORKER}._worker.process.pid")}
    before = {name: _resident(number) for name, number in ids.items()}
    most = dict(before)
    _invoke(window, JOBS["analyze"])
    window.wait_for(f"{STATUS}.is_running")
    while window.value(f"{STATUS}.is_running"):
        most = {name: max(most[name], _resident(number)) for name, number in ids.items()}
        time.sleep(0.05)
    window.settle(2.0)
    rows = (
        f"| {name} | {before[name]:.2f} | {most[name]:.2f} | {_resident(number):.2f} |\n"
        for name, number in ids.items()
    )
    told = f"| GB, {window.value('len(mesh.vertices)')} vertices | before | at most | afterwards |\n|---|---|---|---|\n"
    return f"\n{told}{''.join(rows)}"


def _resident(process: int) -> float:
    """Return the memory of a process in GB."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e9


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
