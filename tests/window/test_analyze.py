"""Analyze in the window: the panel, progress, ESC, and what happens to the mesh meanwhile."""

from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import examples
from tests.blender.test_background import wait_for
from tests.window.conftest import MODULE, add_character, analyze, choose, installed

STATUS = "bpy.context.window_manager.eigenparts"
ERRORS = f"sys.modules['{MODULE}.operators.messages.unexpected_errors']"
WORKER = f"sys.modules['{MODULE}.operators.jobs.worker_process']._worker"
# Pixels.
SCREEN = 1600, 1000
# Seconds; a user who presses ESC wants the window back by then.
AT_ONCE = 0.5


@pytest.fixture
def running(window, humanoid):
    """An analysis under way."""
    add_character(window, humanoid)
    choose(window, "analyze")
    window.wait_for(f"{STATUS}.is_running")
    return window


def names_on_mesh(window):
    return window.value("sorted(a.name for a in bpy.data.meshes[0].attributes), sorted(bpy.data.meshes[0].keys())")


def test_the_tab_shows_all_panels_without_a_mesh_too(window, take, hand):
    take("tab_without_mesh")
    add_character(window, hand)
    take("tab_with_mesh")


def test_analyze_is_found_by_its_name_and_shows_parts(window, hand, take):
    add_character(window, hand)
    before = window.pixels()
    analyze(window)
    take("hand_analyzed")
    assert window.value("len(bpy.context.object.data.eigenparts.rows)") >= 6
    assert window.value(
        "[a.spaces[0].shading.color_type for a in bpy.context.screen.areas if a.type == 'VIEW_3D']"
    ) == ["VERTEX"]
    assert is_coloured(window.pixels()).mean() > is_coloured(before).mean() + 0.02


def is_coloured(pixels):
    """Which pixels are far from grey."""
    return np.ptp(pixels.astype(int), axis=2) > 60


def test_progress_rises_and_says_what_is_done(running, show):
    running.run("seen = []")
    running.run(
        f"def look():\n"
        f"    status = {STATUS}\n"
        f"    seen.append((status.fraction, status.text))\n"
        f"    return 0.05 if status.is_running else None\n"
        f"bpy.app.timers.register(look)"
    )
    running.wait_for(f"{STATUS}.fraction > 0.4")
    # With the status bar, and what it says on the left.
    show("progress", *SCREEN)
    running.wait_for(f"not {STATUS}.is_running")
    fractions, texts = zip(*running.value("seen"), strict=True)
    assert list(fractions) == sorted(fractions)
    assert len(set(texts)) >= 3


def test_escape_gives_the_window_back_and_changes_nothing(running, take):
    before = names_on_mesh(running)
    running.press("ESC")
    assert running.wait_for(f"not {STATUS}.is_running") < AT_ONCE
    running.settle()
    take("cancelled")
    assert names_on_mesh(running) == before


def test_the_cancel_button_does_as_escape(running):
    before = names_on_mesh(running)
    running.run("with over_view(): bpy.ops.eigenparts.cancel()")
    assert running.wait_for(f"not {STATUS}.is_running") < AT_ONCE
    assert names_on_mesh(running) == before


def test_after_a_cancelled_job_the_next_one_comes_to_its_end(running):
    running.press("ESC")
    running.wait_for(f"not {STATUS}.is_running")
    analyze(running)
    assert running.value("len(bpy.context.object.data.eigenparts.rows)") > 5


def test_a_worker_that_is_killed_changes_nothing_and_is_there_again(window, humanoid, take):
    add_character(window, humanoid)
    before = names_on_mesh(window)
    window.run(
        "import sys\n"
        "killed = []\n"
        "def kill():\n"
        f"    if {STATUS}.fraction == 0 or not {STATUS}.is_running:\n"
        "        return 0.01\n"
        f"    killed.append({WORKER}.process.pid)\n"
        f"    {WORKER}.process.kill()\n"
        "bpy.app.timers.register(kill)"
    )
    choose(window, "analyze")
    window.wait_for(f"killed and not {STATUS}.is_running")
    window.settle()
    take("worker_killed")
    assert names_on_mesh(window) == before
    # The message goes away when the mouse leaves it.
    window.point(250, 250)
    window.settle()
    analyze(window)


def test_quitting_in_the_middle_leaves_nothing(humanoid):
    with installed() as window:
        window.run("import sys")
        add_character(window, humanoid)
        window.run("with over_view(): bpy.ops.eigenparts.analyze('INVOKE_DEFAULT')")
        window.wait_for(f"{STATUS}.is_running")
        process, folder = window.value(f"({WORKER}.process.pid, str({WORKER}.folder))")
        assert Path(folder).is_dir()
        window.run("bpy.ops.wm.quit_blender()")
        wait_for(lambda: not Path(f"/proc/{process}").exists())
        wait_for(lambda: not Path(folder).exists())


def test_the_window_can_be_used_meanwhile(window):
    add_character(window, examples.humanoid(20000))
    window.run("with over_view(): bpy.ops.eigenparts.analyze('INVOKE_DEFAULT', order='3')")
    window.wait_for(f"{STATUS}.is_running")
    window.run("bpy.context.scene.cursor.location = (1, 2, 3)")
    window.press("N")
    window.settle()
    assert window.value(f"{STATUS}.is_running")
    window.wait_for("'eigenparts_state' in bpy.data.meshes[0]")


def test_a_mesh_that_is_renamed_meanwhile_is_found(running):
    running.run("bpy.context.object.name = bpy.context.object.data.name = 'Renamed'")
    running.wait_for("'eigenparts_state' in bpy.data.meshes['Renamed']")


@pytest.mark.parametrize(
    "change",
    [
        "bpy.data.meshes.remove(bpy.context.object.data)",
        "bpy.context.object.data.vertices[0].co.x += 0.01",
        "with over_view(): bpy.ops.object.mode_set(mode='EDIT')",
        "bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)",
    ],
    ids=["deleted", "edited", "edit mode", "another file"],
)
def test_a_mesh_that_is_gone_or_changed_meanwhile_is_left_alone(running, change):
    running.run(change)
    running.wait_for(f"not {STATUS}.is_running")
    running.settle()
    assert running.value("[mesh.name for mesh in bpy.data.meshes if 'eigenparts_state' in mesh]") == []


def test_undo_while_it_runs_leaves_no_half_results(running):
    running.press("Z", ctrl=True)
    running.wait_for(f"not {STATUS}.is_running")
    running.settle()
    analyzed = "['part' in mesh.attributes for mesh in bpy.data.meshes if 'eigenparts_state' in mesh]"
    assert all(running.value(analyzed))


def test_a_script_that_waits_for_a_job_goes_on_when_it_has_ended(window, hand):
    add_character(window, hand)
    window.run(
        "rows = []\n"
        "def go_on():\n"
        f"    if {STATUS}.is_running:\n"
        "        return 0.05\n"
        "    rows.append(len(bpy.context.object.data.eigenparts.rows))\n"
        "with over_view(): bpy.ops.eigenparts.analyze('INVOKE_DEFAULT')\n"
        "bpy.app.timers.register(go_on)"
    )
    window.wait_for("rows")
    assert window.value("rows[0]") >= 6


def test_a_job_that_another_window_looks_at_is_shown_and_cancelled_there(window, humanoid, take):
    add_character(window, humanoid)
    with second_window(window):
        choose(window, "analyze")
        window.wait_for(f"{STATUS}.fraction > 0.1")
        take("two_windows")
        window.run("with window_1(): bpy.ops.eigenparts.cancel()")
        assert window.wait_for(f"not {STATUS}.is_running") < AT_ONCE
    window.settle()
    assert window.value("[mesh.name for mesh in bpy.data.meshes if 'eigenparts_state' in mesh]") == []


def test_a_job_ends_with_the_window_it_was_started_in(window, humanoid):
    add_character(window, humanoid)
    with second_window(window):
        window.run("with window_1(): bpy.ops.eigenparts.analyze('INVOKE_DEFAULT')")
        window.wait_for(f"{STATUS}.fraction > 0.1")
    window.wait_for(f"not {STATUS}.is_running")
    window.settle()
    assert window.value("[mesh.name for mesh in bpy.data.meshes if 'eigenparts_state' in mesh]") == []
    analyze(window)


@contextmanager
def second_window(window):
    """Open a window with a 3D view beside the first; afterwards it is closed."""
    window.run(
        "def window_1():\n"
        "    other = bpy.context.window_manager.windows[1]\n"
        "    area = next(area for area in other.screen.areas if area.type == 'VIEW_3D')\n"
        "    region = next(region for region in area.regions if region.type == 'WINDOW')\n"
        "    return bpy.context.temp_override(window=other, area=area, region=region)\n"
        "with over_view(): bpy.ops.wm.window_new()"
    )
    window.wait_for("len(bpy.context.window_manager.windows) == 2")
    window.settle()
    try:
        yield
    finally:
        window.run("with window_1(): bpy.ops.wm.window_close()")
        window.wait_for("len(bpy.context.window_manager.windows) == 1")


def test_an_error_that_nobody_foresaw_is_told_and_can_be_reported(window, hand, take):
    add_character(window, hand)
    before = names_on_mesh(window)
    window.run(
        "import sys\n"
        f"module = sys.modules['{MODULE}.operators.parts.mesh_segmentation']\n"
        "write = module.write\n"
        "def broken(*arguments): raise MemoryError('/home/somebody/file')\n"
        "module.write = broken"
    )
    choose(window, "analyze")
    window.wait_for(f"{ERRORS}.last() is not None")
    window.settle()
    take("unexpected_error")
    window.run("module.write = write")
    # The message goes away when the mouse leaves it.
    window.point(250, 250)
    window.settle()
    assert names_on_mesh(window) == before
    choose(window, "copy bug report")
    window.wait_for("'MemoryError' in bpy.context.window_manager.clipboard")
    assert "somebody" not in window.value("bpy.context.window_manager.clipboard")
    analyze(window)
    assert window.value(f"{ERRORS}.last() is None")
