"""Parts are picked by clicking them, and what was done last is changed in its panel."""

from tests.window.conftest import labels, unfold

SETTINGS = "bpy.context.object.data.eigenparts"
IS_PICKING = "bpy.context.window_manager.eigenparts.is_picking"
# On the humanoid, seen from the front.
PLACES = {"hand": (0.7, -0.02, 1.3), "belly": (0.0, -0.1, 1.05), "head": (0.0, -0.1, 1.65)}


def part_at(window, place):
    """The part of the face of the active object that is nearest to a place."""
    return window.value(
        "(lambda mesh, face: mesh.attributes['part'].data[face].value)"
        f"(bpy.context.object.data, bpy.context.object.closest_point_on_mesh({place})[3])"
    )


def start_picking(window):
    window.run("with over_view(): bpy.ops.eigenparts.pick_part('INVOKE_DEFAULT', True)")
    window.wait_for(IS_PICKING)


def test_each_click_makes_a_part_active_until_escape(pair, show):
    unfold(pair, "Parts")
    start_picking(pair)
    picked = []
    for place in PLACES.values():
        pair.click(*pair.place(place))
        pair.settle()
        picked.append(pair.value(f"{SETTINGS}.active_part"))
        assert picked[-1] == part_at(pair, place)
    assert len(set(picked)) == len(PLACES)
    show("picked")
    pair.press("ESC")
    pair.wait_for(f"not {IS_PICKING}")
    pair.click(*pair.place(PLACES["hand"]))
    pair.settle()
    assert pair.value(f"{SETTINGS}.active_part") == picked[-1]


def test_the_view_can_be_turned_while_parts_are_picked(pair):
    start_picking(pair)
    pair.point(*pair.place(PLACES["head"]))
    pair.press("NUMPAD_3")
    pair.settle()
    pair.press("RIGHTMOUSE")
    pair.wait_for(f"not {IS_PICKING}")
    assert pair.value("bpy.context.object.mode") == "OBJECT"


def test_picking_ends_when_a_file_is_loaded(pair):
    start_picking(pair)
    path = pair.folder / "pair.blend"
    pair.run(f"bpy.ops.wm.open_mainfile(filepath={str(path)!r}, load_ui=False)")
    pair.wait_for(f"not {IS_PICKING}")


def test_the_last_division_is_changed_in_its_panel(pair):
    pair.run("with over_view(): bpy.ops.eigenparts.segment('INVOKE_DEFAULT', True, n_parts=3)")
    assert len(set(labels(pair))) == 3
    pair.run(
        "with over_view():\n"
        "    bpy.context.window_manager.operators[-1].properties.n_parts = 6\n"
        "    bpy.ops.ed.undo_redo()"
    )
    pair.settle()
    assert len(set(labels(pair))) == 6
