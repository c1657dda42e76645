"""The zip, installed in the real application as a user would; run by ``make test-window``."""

import os
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest

import examples
from tools.window import Window, what_is_missing

ROOT = Path(__file__).parents[2]
PACKAGE = "EIGENPARTS_PACKAGE"
PICTURES = ROOT / "demo" / "window"
MODULE = "bl_ext.user_default.eigenparts"


@pytest.fixture(scope="session")
def application():
    """Blender with the extension installed from the zip."""
    missing = what_is_missing() if PACKAGE in os.environ else "make test-window runs these."
    if missing:
        pytest.skip(missing)
    # Not pytest's own folder: the application must be able to see it.
    with tempfile.TemporaryDirectory(prefix="eigenparts-window-") as folder:
        archive = shutil.copy(os.environ[PACKAGE], folder)
        window = Window(Path(folder))
        window.run(
            f"bpy.ops.extensions.package_install_files("
            f"filepath={str(archive)!r}, repo='user_default', enable_on_install=True)"
        )
        yield window
        window.close()


@pytest.fixture
def window(application):
    """The application with an empty file, its sidebar open at our tab, and the mouse over the 3D view."""
    application.run(
        "bpy.ops.wm.read_homefile(use_factory_startup=True, use_factory_startup_app_template_only=True)\n"
        "bpy.context.preferences.view.show_splash = False"
    )
    application.run(
        "with over_view() as context:\n"
        "    bpy.ops.object.select_all(action='SELECT')\n"
        "    bpy.ops.object.delete()\n"
        "    bpy.data.batch_remove(bpy.data.meshes)\n"
        "    context.space_data.show_region_ui = True"
    )
    application.settle(2.0)
    application.run(
        "with over_view() as context:\n"
        "    sidebar = next(region for region in context.area.regions if region.type == 'UI')\n"
        "    sidebar.active_panel_category = 'Eigenparts'\n"
        "    context.area.tag_redraw()"
    )
    application.point(500, 500)
    begin = len(application.log.read_text())
    yield application
    assert "Traceback" not in application.log.read_text()[begin:]


@pytest.fixture
def take(window):
    """Keep a picture of the screen, to be looked at."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    return lambda name: window.picture(PICTURES / f"{name}.png")


@pytest.fixture(scope="session")
def hand():
    """The smallest of the characters."""
    return examples.hand(2000)


@pytest.fixture(scope="session")
def humanoid():
    """A character that takes some seconds to analyze."""
    return examples.humanoid()


def add_character(window, character, pose="rest", shift=0.0):
    """Import a character as a user would, select it and look at it from the front."""
    path = window.folder / f"{character.name} {pose}.obj"
    vertices = character.mesh_in_pose(pose) + np.array([shift, 0, 0])
    corners = (" ".join(map(str, quad)) for quad in (character.quads + 1).tolist())
    lines = [*(f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in vertices), *(f"f {quad}" for quad in corners)]
    path.write_text("\n".join(lines) + "\n")
    window.run(
        "with over_view():\n"
        f"    bpy.ops.wm.obj_import(filepath={str(path)!r}, forward_axis='Y', up_axis='Z')\n"
        "    bpy.ops.view3d.view_axis(type='FRONT')\n"
        "    bpy.ops.view3d.view_all()\n"
        "    bpy.context.object.data.validate()"
    )
    window.settle()


def choose(window, action):
    """Call an action from the menu search."""
    window.press("F3")
    window.settle()
    window.write(action)
    window.settle()
    window.press("RET")


def analyze(window):
    """Analyze the active mesh from the menu search, and wait."""
    choose(window, "analyze")
    window.wait_for("bpy.context.object and 'eigenparts_state' in bpy.context.object.data")
    window.settle()
