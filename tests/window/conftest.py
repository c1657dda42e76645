"""The zip, installed in the real application as a user would; run by ``make test-window``."""

import os
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import examples
from tools.window import Window, what_is_missing

ROOT = Path(__file__).parents[2]
PACKAGE = "EIGENPARTS_PACKAGE"
PICTURES = ROOT / "demo" / "window"
MODULE = "bl_ext.user_default.eigenparts"
# Pixels.
PICTURE_WIDTH, PICTURE_HEIGHT = 1000, 760
HEADER, HALF_HEADER = 28, 16

PLACE_OF_VIEW = "next((a.x, a.y, a.width, a.height) for a in bpy.context.screen.areas if a.type == 'VIEW_3D')"
PLACE_OF_SIDEBAR = (
    "next((region.x + region.width // 3, region.y + region.height) for area in bpy.context.screen.areas "
    "if area.type == 'VIEW_3D' for region in area.regions if region.type == 'UI')"
)
TITLES_OF_PANELS = (
    "[panel.bl_label for panel in sorted((panel for panel in bpy.types.Panel.__subclasses__() "
    "if getattr(panel, 'bl_category', '') == 'Eigenparts' and panel.is_registered "
    "and not hasattr(panel, 'bl_parent_id')), key=lambda panel: panel.bl_order)]"
)


@pytest.fixture(scope="session")
def application():
    """Blender with the extension installed from the zip."""
    with installed() as window:
        yield window


@contextmanager
def installed():
    """Start Blender with settings of its own, and install the extension from the zip."""
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
        try:
            yield window
        finally:
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


@pytest.fixture
def show(window):
    """Keep a picture of the 3D view with the sidebar, for the pages of the guide."""
    PICTURES.mkdir(parents=True, exist_ok=True)

    def show_as(name, width=PICTURE_WIDTH, height=PICTURE_HEIGHT):
        window.picture(PICTURES / f"window_{name}.png", view_with_sidebar(window, width, height))

    return show_as


@pytest.fixture(scope="session")
def hand():
    """The smallest of the characters."""
    return examples.hand(2000)


@pytest.fixture(scope="session")
def humanoid():
    """A character that takes some seconds to analyze."""
    return examples.humanoid()


@pytest.fixture(scope="session")
def walker():
    """The same character with other faces."""
    return examples.humanoid(5000)


@pytest.fixture
def pair(window, humanoid, walker):
    """A character that is analyzed, has weights and is active; walking beside it, the one of other faces."""
    path = window.folder / "pair.blend"
    if not path.exists():
        add_character(window, walker, "walk", shift=1.3)
        add_character(window, humanoid)
        add_weights(window, humanoid)
        analyze(window)
        window.run(f"bpy.ops.wm.save_as_mainfile(filepath={str(path)!r}, copy=True)")
    window.run(f"bpy.ops.wm.open_mainfile(filepath={str(path)!r}, load_ui=False)")
    look_from_the_front(window)
    return window


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
        "    bpy.context.object.data.validate()"
    )
    look_from_the_front(window)


def add_weights(window, character):
    """Give the active mesh the weights of its character, as vertex groups called after the bones."""
    weights = {
        bone.name: [(vertex, column[vertex]) for vertex in np.flatnonzero(column).tolist()]
        for bone, column in zip(character.bones, character.weights.T.round(6).tolist(), strict=True)
    }
    window.run(
        f"for name, weights in {weights}.items():\n"
        "    group = bpy.context.object.vertex_groups.new(name=name)\n"
        "    for vertex, weight in weights:\n"
        "        group.add([vertex], weight, 'REPLACE')"
    )


def look_from_the_front(window):
    """Let the view show everything, from the front."""
    window.run("with over_view():\n    bpy.ops.view3d.view_axis(type='FRONT')\n    bpy.ops.view3d.view_all()")
    window.settle()


def select(window, *names):
    """Select objects by name, the last one as the active one."""
    window.run(
        "with over_view():\n"
        "    bpy.ops.object.select_all(action='DESELECT')\n"
        f"    for name in {names}:\n"
        "        bpy.data.objects[name].select_set(True)\n"
        "        bpy.context.view_layer.objects.active = bpy.data.objects[name]\n"
        "    bpy.ops.ed.undo_push(message='Select')"
    )


def unfold(window, *panels):
    """Open some panels of the tab beside Analyze, which is always open, and fold all others, by clicks on headers."""
    x, top = window.value(PLACE_OF_SIDEBAR)
    headers = {title: top - HALF_HEADER - k * HEADER for k, title in enumerate(window.value(TITLES_OF_PANELS))}
    window.click(x, headers["Analyze"])
    window.settle()
    # Ctrl folds all others, but only where a panel has none within it.
    window.click(x, headers["Level"], ctrl=True)
    window.settle()
    window.click(x, headers["Level"])
    for title in sorted(("Analyze", *panels), key=headers.get):
        window.settle()
        window.click(x, headers[title])
    window.point(500, 200)
    window.settle()


def view_with_sidebar(window, width, height):
    """Return the rows and columns of the screen that a picture of the 3D view with the sidebar is cut from."""
    left, bottom, n_columns, n_rows = window.value(PLACE_OF_VIEW)
    top, right = window.pixels().shape[0] - bottom - n_rows, left + n_columns
    return slice(top, top + height), slice(max(0, right - width), right)


def labels(window, mesh="bpy.context.object.data"):
    """Return the part of each face of a mesh."""
    return window.value(f"[attribute.value for attribute in {mesh}.attributes['part'].data]")


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


def nearest_quads(source, target):
    """Return for each quad of a character the one of another with the nearest middle, both at rest."""
    middles = [character.vertices[character.quads].mean(axis=1) for character in (source, target)]
    return cKDTree(middles[0]).query(middles[1])[1]
