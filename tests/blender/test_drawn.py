"""Panels, menus and lists in every state that a user meets: all they name is there, and every action is in reach."""

from pathlib import Path

import bpy
import pytest

from examples import quadruped
from examples.blender import add_character
from tests.blender.conftest import add_object
from tests.blender.drawn import MisnamedError, draw_everything, draw_options_of_operators, draw_preferences
from tests.shapes import star

SAVED = Path(__file__).parent / "data" / "parts_of_0_1_0.blend"
ALL_OUTPUTS = {"VERTEX_ATTRIBUTE", "CORNER_COLORS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS", "FIELD"}


def small_star(name="star", size=1.0):
    shape = star(n_arms=5, n_subdivisions=2)
    return add_object(size * shape.vertices, shape.triangles, name)


def nothing_at_all():
    pass


def nothing_selected():
    small_star().select_set(False)
    bpy.context.view_layer.objects.active = None


def a_new_mesh():
    return small_star()


def a_new_mesh_with_a_field_of_its_own():
    small_star().data.attributes.new("heat", "FLOAT", "POINT")
    bpy.context.scene.eigenparts.field = "ATTRIBUTE"


def a_field_of_its_own_without_a_mesh():
    bpy.context.scene.eigenparts.field = "ATTRIBUTE"


def an_analyzed_mesh():
    obj = small_star()
    bpy.ops.eigenparts.analyze(order="1")
    return obj


def an_active_part():
    obj = an_analyzed_mesh()
    obj.data.eigenparts.active_row = 1
    return obj


def an_eigenfunction_with_hints():
    obj = small_star()
    bpy.context.scene.eigenparts.field = "EIGENFUNCTION"
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=4, order="1")
    return obj


def all_outputs():
    obj = an_analyzed_mesh()
    bpy.ops.eigenparts.write_outputs(outputs=ALL_OUTPUTS, softness=0.1)
    return obj


def corrections():
    obj = an_active_part()
    part = obj.data.eigenparts.active_part
    bpy.ops.eigenparts.move_border(part=part, offset=0.05)
    bpy.ops.eigenparts.set_branch_level(part=part, level=1)
    assert len(obj.data.eigenparts.correction_rows) == 2
    return obj


def a_resting_correction():
    obj = corrections()
    bpy.ops.eigenparts.segment(level=0)
    assert any(row.rests for row in obj.data.eigenparts.correction_rows)


def edit_mode():
    an_active_part()
    bpy.ops.object.mode_set(mode="EDIT")


def sculpt_mode():
    an_active_part()
    bpy.ops.object.mode_set(mode="SCULPT")


def several_meshes_and_named_groups():
    others = [small_star("first", 1.1), small_star("second", 1.2)]
    an_analyzed_mesh()
    options = bpy.context.scene.eigenparts_transfer
    options.layers, options.groups = {"GROUPS"}, "NAMED"
    for other in others:
        other.select_set(True)


def a_registered_mesh():
    bpy.ops.wm.open_mainfile(filepath=str(SAVED))
    registered = bpy.data.objects["runner"]
    bpy.context.view_layer.objects.active = registered
    return registered


def a_registered_mesh_with_alternatives():
    match = a_registered_mesh().data["eigenparts_state"]["registration"]
    match["n_alternatives"], match["confidence"], match["by_diagrams"] = 2, 0.3, [1, -2, 0]


def points_that_were_given():
    for name in ("gone", "there"):
        small_star(name)
        bpy.ops.eigenparts.add_point_pair(source=name, source_vertex=1, target=small_star().name, target_vertex=2)
    bpy.data.objects.remove(bpy.data.objects["gone"])


def a_job(operator):
    def running():
        an_analyzed_mesh()
        status = bpy.context.window_manager.eigenparts
        status.is_running, status.job, status.fraction, status.text = True, operator, 0.5, "Solving"

    running.__name__ = f"job {operator}"
    return running


def parts_being_picked():
    an_analyzed_mesh()
    bpy.context.window_manager.eigenparts.is_picking = True


def an_error_that_nobody_foresaw():
    from eigenparts.operators.messages import unexpected_errors

    a_new_mesh()
    unexpected_errors.remember(KeyError("lost"))


def a_change_that_the_panel_refuses():
    obj = an_analyzed_mesh()
    obj.data.vertices[0].co.x += 1
    obj.data.eigenparts.level = 1
    assert bpy.context.window_manager.eigenparts.problem


def a_damaged_state():
    an_analyzed_mesh().data["eigenparts_state"] = 7


def a_newer_state():
    an_analyzed_mesh().data["eigenparts_state"]["schema"] += 1


def a_traced_complex():
    an_analyzed_mesh()
    bpy.ops.eigenparts.trace_complex(order="1")
    bpy.context.window_manager.eigenparts_complex_through = True


def a_rig_that_was_just_made():
    an_analyzed_mesh()
    bpy.ops.eigenparts.create_armature(weights="NONE", order="1")
    assert bpy.context.object.type == "ARMATURE"


def a_character_of_somebody():
    mesh, _ = add_character(quadruped(2000))
    bpy.context.view_layer.objects.active = mesh


def another_kind(name, data=None):
    def active():
        obj = bpy.data.objects.new(name, data() if data else None)
        bpy.context.collection.objects.link(obj)
        bpy.context.view_layer.objects.active = obj
        obj.select_set(True)

    active.__name__ = name
    return active


STATES = [
    *(nothing_at_all, nothing_selected, a_new_mesh, a_new_mesh_with_a_field_of_its_own),
    *(a_field_of_its_own_without_a_mesh, an_analyzed_mesh, an_active_part, an_eigenfunction_with_hints, all_outputs),
    *(corrections, a_resting_correction, edit_mode, sculpt_mode, several_meshes_and_named_groups, a_registered_mesh),
    *(points_that_were_given, a_registered_mesh_with_alternatives, parts_being_picked, an_error_that_nobody_foresaw),
    *(a_change_that_the_panel_refuses, a_damaged_state, a_newer_state, a_traced_complex, a_rig_that_was_just_made),
    a_character_of_somebody,
    *map(a_job, ("eigenparts.analyze", "eigenparts.register_selected", "eigenparts.transfer")),
    *map(a_job, ("eigenparts.create_armature", "eigenparts.plot_diagram")),
    another_kind("empty"),
    another_kind("camera", lambda: bpy.data.cameras.new("camera")),
    another_kind("curve", lambda: bpy.data.curves.new("curve", "CURVE")),
    another_kind("text", lambda: bpy.data.curves.new("text", "FONT")),
    another_kind("lattice", lambda: bpy.data.lattices.new("lattice")),
    another_kind("mesh without faces", lambda: bpy.data.meshes.new("bare")),
]


@pytest.fixture
def preferences():
    addon = bpy.context.preferences.addons.new()
    addon.module = "eigenparts"
    yield addon.preferences
    bpy.context.preferences.addons.remove(addon)


@pytest.fixture(autouse=True)
def nothing_foreseen(extension):
    from eigenparts.operators.messages import unexpected_errors

    yield
    unexpected_errors.forget()


@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_everything_that_is_drawn_is_there(state):
    state()
    assert len(draw_everything().drawn) > 10


def test_what_operators_show_afterwards_is_there():
    small_star()
    assert draw_options_of_operators().drawn >= {"EIGENPARTS_OT_segment", "EIGENPARTS_OT_create_armature"}


def test_every_operator_is_in_reach(preferences):
    in_reach = set(draw_preferences(preferences).operators)
    states = corrections, points_that_were_given, a_registered_mesh_with_alternatives, a_job("eigenparts.analyze")
    for state in states:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        state()
        in_reach |= draw_everything().operators
    ours = {f"eigenparts.{name}" for name in dir(bpy.ops.eigenparts)}
    assert ours <= in_reach, ours - in_reach


def test_every_panel_menu_and_list_of_ours_is_drawn():
    ours = {name for name in dir(bpy.types) if name.startswith(("EIGENPARTS_PT_", "EIGENPARTS_MT_", "EIGENPARTS_UL_"))}
    an_eigenfunction_with_hints()
    part = next(row.part for row in bpy.context.object.data.eigenparts.rows if row.part)
    bpy.ops.eigenparts.move_border(part=part, offset=0.05)
    bpy.context.object.data.eigenparts.active_part = part
    assert draw_everything().drawn >= ours


SLIPS = {
    "an operator": lambda layout, obj: layout.operator("eigenparts.analyse"),
    "a property of an operator": lambda layout, obj: setattr(layout.operator("eigenparts.cut"), "kind", "INSERT"),
    "a choice of an operator": lambda layout, obj: setattr(layout.operator("eigenparts.cut"), "method", "INSERTED"),
    "the type of a property": lambda layout, obj: setattr(layout.operator("eigenparts.split_part"), "part", "1"),
    "a property": lambda layout, obj: layout.prop(obj.data.eigenparts, "levels"),
    "a collection": lambda layout, obj: layout.prop_search(obj, "name", obj.data, "attribute"),
    "an icon": lambda layout, obj: layout.label(text="Parts", icon="MOD_EXPLODES"),
    "a menu": lambda layout, obj: layout.menu("EIGENPARTS_MT_merges"),
    "a panel for a menu": lambda layout, obj: layout.menu("EIGENPARTS_PT_analyze"),
    "a popover": lambda layout, obj: layout.popover(panel="EIGENPARTS_PT_presets"),
    "a list": lambda layout, obj: layout.template_list("EIGENPARTS_UL_part", "", obj.data.eigenparts, "rows", obj, "x"),
    "an option": lambda layout, obj: layout.row(aligned=True),
    "a call": lambda layout, obj: layout.rows(),
    "a switch": lambda layout, obj: setattr(layout, "use_property_splitting", True),
    "an alignment": lambda layout, obj: setattr(layout, "alignment", "MIDDLE"),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_in_a_panel_is_found(slip, monkeypatch):
    obj = a_new_mesh()
    draw_everything()
    monkeypatch.setattr(bpy.types.EIGENPARTS_PT_topology, "draw", lambda panel, context: SLIPS[slip](panel.layout, obj))
    with pytest.raises(MisnamedError):
        draw_everything()
