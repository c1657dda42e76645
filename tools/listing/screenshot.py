"""The picture of the window: the zip in the real application, on a screen of its own, with two characters in it."""

import shutil
import tempfile
from pathlib import Path

from PIL import Image

from examples import Character, humanoid
from tools.listing.scenes import LEFT, WIDTH, titled
from tools.window import Window

# Pixels of the screen, which fills the sheet below its lettering but for a margin, and where its picture begins.
SCREEN, TOP = (WIDTH - 2 * LEFT, 814), 232
# Seconds that the application may take to draw itself, and to compute.
CALM, PATIENCE = 4.0, 900.0
REFERENCE, OTHER = ("stand", 6000, 0.0), ("walk", 4000, 1.05)
# What a part is, by the middle of its faces: those of limbs lie beside the middle.
NAMES = """
def name_of(x, z):
    side = "" if abs(x) < 0.04 else " L" if x > 0 else " R"
    return ("Head" if z > 1.4 else "Arm" if abs(x) > 0.2 else "Chest" if z > 1 else "Leg" if z < 0.7 else "Hips") + side

data = bpy.context.object.data
for row in data.eigenparts.rows[1:]:
    middles = [face.center for face in data.polygons if data.attributes["part"].data[face.index].value == row.part]
    row.title = name_of(*(sum(middle[axis] for middle in middles) / len(middles) for axis in (0, 2)))
"""
# One large 3D view, smooth, with nothing over it that is not needed.
ARRANGED = """
with over_view() as context:
    context.preferences.view.ui_scale = 1.15
    bpy.ops.screen.screen_full_area(use_hide_panels=False)
with over_view() as context:
    view = context.space_data
    view.show_region_ui, view.show_region_toolbar = True, False
    view.overlay.show_cursor = view.overlay.show_object_origins = False
    view.shading.show_cavity, view.shading.cavity_type = True, "WORLD"
    view.lens = 85
"""
SIDEBAR = """
with over_view() as context:
    sidebar = next(region for region in context.area.regions if region.type == 'UI')
    sidebar.active_panel_category = 'Eigenparts'
    bpy.ops.view3d.view_axis(type='FRONT')
    bpy.ops.view3d.view_orbit(angle=0.32, type='ORBITLEFT')
    bpy.ops.view3d.view_orbit(angle=0.12, type='ORBITUP')
    bpy.ops.view3d.view_all()
    context.region_data.view_location.x += 0.3
    bpy.context.screen.show_statusbar = False
    for obj in bpy.data.objects: obj.select_set(False)
    context.area.tag_redraw()
"""


def window(title: str, line: str, archive: Path) -> Image.Image:
    """Return a sheet with the window after one character got parts, and another the same ones."""
    # The application must be able to see the folder.
    with tempfile.TemporaryDirectory(prefix="eigenparts-listing-") as folder:
        application = Window(Path(folder), SCREEN)
        try:
            _prepare(application, Path(shutil.copy(archive, folder)))
            application.settle(CALM)
            shown = _without_bar(Image.fromarray(application.pixels()), application)
        finally:
            application.close()
    sheet = titled(title, line)
    sheet.paste(shown, (LEFT, TOP))
    return sheet


def _without_bar(screen: Image.Image, application: Window) -> Image.Image:
    """Return what is below the bar of menus, in which Blender has its logo; pictures of extensions may not show it."""
    top: int = application.value("max(area.y + area.height for area in bpy.context.screen.areas)")
    return screen.crop((0, screen.height - top, *screen.size))


def _prepare(application: Window, archive: Path) -> None:
    install = f"package_install_files(filepath={str(archive)!r}, repo='user_default', enable_on_install=True)"
    application.run(f"bpy.ops.extensions.{install}")
    application.run("bpy.data.batch_remove([*bpy.data.objects])")
    application.run("with over_view(): bpy.ops.outliner.orphans_purge(do_recursive=True)")
    for pose, n_vertices, shift in (OTHER, REFERENCE):
        _add(application, humanoid(n_vertices), pose, shift)
    _give_parts(application, "analyze", REFERENCE[0])
    application.run(NAMES)
    application.run("for obj in bpy.data.objects: obj.select_set(True)")
    _give_parts(application, "register_selected", OTHER[0])
    application.run(ARRANGED)
    application.settle(CALM)
    application.run(SIDEBAR)
    application.settle(CALM)
    application.point(10, 10)


def _give_parts(application: Window, operator: str, name: str) -> None:
    """Run an operator as a button does, and wait until the object has parts."""
    application.run(f"with over_view(): bpy.ops.eigenparts.{operator}('INVOKE_DEFAULT')")
    application.wait_for(f"'part' in bpy.data.objects[{name!r}].data.attributes", PATIENCE)


def _add(application: Window, character: Character, pose: str, shift: float) -> None:
    vertices, faces = character.mesh_in_pose(pose).tolist(), character.quads.tolist()
    application.run(
        f"data = bpy.data.meshes.new({pose!r})\n"
        f"data.from_pydata({vertices}, [], {faces})\n"
        "data.shade_smooth()\n"
        f"obj = bpy.data.objects.new({pose!r}, data)\n"
        f"obj.location.x = {shift}\n"
        "bpy.context.scene.collection.objects.link(obj)"
    )
    _select(application, pose)


def _select(application: Window, name: str) -> None:
    application.run(
        f"for obj in bpy.data.objects: obj.select_set(obj.name == {name!r})\n"
        f"bpy.context.view_layer.objects.active = bpy.data.objects[{name!r}]"
    )
