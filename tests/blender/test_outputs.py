"""Outputs: what the parts are written to follows the level, spares what is the user's, and can be taken back."""

import time

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, solve_eigenbasis
from tests.blender.conftest import add_object, everything_on, values_of
from tests.blender.drawn import Layout, draw_panels


def labels_of(obj):
    return values_of(obj.data, "part")


def write(*names, **options):
    assert bpy.ops.eigenparts.write_outputs(outputs=set(names), **options) == {"FINISHED"}


def weights_of(obj, name):
    group = obj.vertex_groups[name].index
    weights = np.zeros(len(obj.data.vertices))
    for vertex in obj.data.vertices:
        weights[vertex.index] = sum(entry.weight for entry in vertex.groups if entry.group == group)
    return weights


def materials_of_faces(mesh):
    return [mesh.materials[polygon.material_index].name for polygon in mesh.polygons]


def test_face_sets_follow_the_level(analyzed):
    write("FACE_SETS")
    np.testing.assert_array_equal(values_of(analyzed.data, ".sculpt_face_set"), labels_of(analyzed) + 1)
    analyzed.data.eigenparts.level = 1
    np.testing.assert_array_equal(values_of(analyzed.data, ".sculpt_face_set"), labels_of(analyzed) + 1)


def test_outputs_that_are_not_chosen_are_taken_back(analyzed):
    write("FACE_SETS")
    assert {"part_vertex", "part_color"}.isdisjoint(analyzed.data.attributes.keys())
    analyzed.data.eigenparts.face_sets = False
    analyzed.data.eigenparts.corner_colors = True
    assert ".sculpt_face_set" not in analyzed.data.attributes
    assert analyzed.data.color_attributes.active_color_name == "part_color"


def test_face_sets_of_the_user_are_never_overwritten(analyzed):
    analyzed.data.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", np.full(1280, 7))
    before = everything_on(analyzed.data)
    with pytest.raises(RuntimeError, match="not from Eigenparts"):
        write("FACE_SETS")
    assert everything_on(analyzed.data) == before
    assert set(values_of(analyzed.data, ".sculpt_face_set")) == {7}


def test_vertex_groups_have_the_names_of_the_parts_and_weight_every_vertex_once(analyzed):
    write("VERTEX_GROUPS", "VERTEX_ATTRIBUTE")
    names = [row.title for row in analyzed.data.eigenparts.rows]
    assert sorted(group.name for group in analyzed.vertex_groups) == sorted(names)
    assert {len(vertex.groups) for vertex in analyzed.data.vertices} == {1}
    np.testing.assert_array_equal(weights_of(analyzed, "Part 2"), values_of(analyzed.data, "part_vertex") == 2)


def test_soft_weights_add_up_to_one_and_pass_over_the_width(analyzed, star):
    write("VERTEX_GROUPS", softness=0.5)
    weights = np.stack([weights_of(analyzed, group.name) for group in analyzed.vertex_groups])
    np.testing.assert_allclose(weights.sum(axis=0), 1, atol=1e-5)
    in_between = (weights > 0.1) & (weights < 0.9)
    write("VERTEX_GROUPS", softness=1.0)
    wider = np.stack([weights_of(analyzed, group.name) for group in analyzed.vertex_groups])
    assert 0 < in_between.sum() < ((wider > 0.1) & (wider < 0.9)).sum()


def test_vertex_groups_of_the_user_stay(analyzed):
    mine = analyzed.vertex_groups.new(name="Part 1")
    mine.add([3, 4], 0.25, "REPLACE")
    write("VERTEX_GROUPS")
    analyzed.data.eigenparts.level = 2
    write()
    assert [group.name for group in analyzed.vertex_groups] == ["Part 1"]
    np.testing.assert_allclose(weights_of(analyzed, "Part 1")[[2, 3, 4]], [0, 0.25, 0.25])


def test_every_face_has_the_material_of_its_part(analyzed):
    write("MATERIALS")
    title = {row.part: row.title for row in analyzed.data.eigenparts.rows}
    assert materials_of_faces(analyzed.data) == [title[label] for label in labels_of(analyzed).tolist()]
    analyzed.data.eigenparts.level = 1
    assert sorted(slot.name for slot in analyzed.data.materials) == sorted(
        row.title for row in analyzed.data.eigenparts.rows
    )


def test_materials_of_the_user_come_back(star_object):
    mesh = star_object.data
    for name in ("skin", "Part 1"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons)) % 2)
    before = materials_of_faces(mesh)
    bpy.ops.eigenparts.analyze()
    write("MATERIALS")
    assert [slot.name for slot in mesh.materials][:2] == ["skin", "Part 1"]
    mesh.eigenparts.level = 2
    mesh.eigenparts.materials = False
    assert materials_of_faces(mesh) == before
    assert [material.name for material in bpy.data.materials] == ["Part 1", "skin"]


def test_a_copy_with_other_names_and_colours_leaves_the_materials_of_the_original(analyzed):
    write("MATERIALS")
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    part = copy.data.eigenparts.rows[1].part
    copy.data.eigenparts.rows[1].title = "tail"
    copy.data.eigenparts.rows[2].color = (0.25, 0.5, 0.75)
    assert [copy.data.materials[part].name, analyzed.data.materials[part].name] == ["tail", "Part 1"]
    colours = [obj.data.materials[2].diffuse_color[:3] for obj in (analyzed, copy)]
    assert colours == [tuple(analyzed.data.eigenparts.rows[2].color), (0.25, 0.5, 0.75)]
    assert materials_of_faces(copy.data).count("tail") == copy.data.eigenparts.rows[1].n_faces


def test_a_material_follows_the_name_of_its_part_also_to_one_with_the_same_beginning(analyzed):
    write("MATERIALS")
    row = analyzed.data.eigenparts.rows[1]
    for name in ("Leg.L", "Leg", "Leg.R"):
        row.title = name
        assert analyzed.data.materials[row.part].name == name


def test_the_field_rises_towards_the_tips(analyzed, star):
    write("FIELD")
    field = values_of(analyzed.data, "eigenparts_field", dtype=np.float32)
    assert np.corrcoef(field, np.linalg.norm(star.vertices, axis=1))[0, 1] > 0.9


def test_clear_takes_all_outputs_back(star_object):
    before = everything_on(star_object.data)
    bpy.ops.eigenparts.analyze()
    write("VERTEX_ATTRIBUTE", "CORNER_COLORS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS", "FIELD")
    bpy.ops.eigenparts.clear()
    assert everything_on(star_object.data) == before
    assert (len(star_object.vertex_groups), len(star_object.data.materials), len(bpy.data.materials)) == (0, 0, 0)


def test_choices_outlive_a_new_analysis(analyzed):
    write("FACE_SETS", softness=0.25)
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION")
    assert analyzed.data.eigenparts.face_sets
    assert not analyzed.data.eigenparts.corner_colors
    assert analyzed.data.eigenparts.softness == pytest.approx(0.25)


def test_outputs_need_an_analysis(star):
    add_object(star.vertices, star.triangles)
    with pytest.raises(RuntimeError, match="Analyze the mesh first"):
        write("FACE_SETS")


def test_eigenfunctions_are_those_of_the_engine(star_object, star):
    bpy.ops.eigenparts.write_eigenfunctions(n_functions=4)
    bpy.ops.eigenparts.write_eigenfunctions(n_functions=3)
    basis = solve_eigenbasis(TriangleMesh(np.float32(star.vertices), star.triangles), 3)
    written = [values_of(star_object.data, f"eigenfunction_{k}", dtype=np.float32) for k in (1, 2, 3)]
    np.testing.assert_allclose(np.stack(written, axis=1), basis.functions[: len(star.vertices)], atol=1e-5)
    assert "eigenfunction_4" not in star_object.data.attributes


def test_an_eigenfunction_attribute_of_the_user_is_not_overwritten(star_object):
    star_object.data.attributes.new("eigenfunction_2", "FLOAT", "POINT")
    with pytest.raises(RuntimeError, match="not from Eigenparts"):
        bpy.ops.eigenparts.write_eigenfunctions()
    assert "eigenfunction_1" not in star_object.data.attributes


def test_more_eigenfunctions_than_there_are_are_refused_at_once(star_object):
    start = time.process_time()
    with pytest.raises(RuntimeError, match="carries only"):
        bpy.ops.eigenparts.write_eigenfunctions(n_functions=2**31 - 1)
    assert time.process_time() - start < 10


def test_the_group_that_is_active_stays_active(analyzed):
    analyzed.vertex_groups.new(name="mine")
    for outputs in ({"VERTEX_GROUPS"}, {"VERTEX_GROUPS", "FIELD"}, {"FIELD"}):
        write(*outputs)
        assert analyzed.vertex_groups.active.name == "mine"
    write("VERTEX_GROUPS")
    analyzed.vertex_groups.active = analyzed.vertex_groups["Part 1"]
    bpy.ops.eigenparts.segment(level=1)
    assert analyzed.vertex_groups.active.name == "Part 1"


def test_every_output_has_a_tick_box_and_a_row_in_the_panel(analyzed, extension, monkeypatch):
    from eigenparts.operators.outputs.output_registry import OUTPUTS

    items = bpy.ops.eigenparts.write_outputs.get_rna_type().properties["outputs"].enum_items
    assert [item.identifier for item in items] == list(OUTPUTS)
    shown = []
    monkeypatch.setattr(Layout, "prop", lambda self, owner, name, **options: shown.append(name))
    draw_panels()
    for output in OUTPUTS.values():
        box = type(analyzed.data.eigenparts).bl_rna.properties[output.property_name]
        assert (box.name, box.description) == (output.name, output.description)
        assert {output.property_name, *output.options} <= set(shown)


def test_no_two_outputs_write_the_same_attribute(extension):
    from eigenparts.operators.outputs import output_registry as registry

    names = [attribute.name for attribute in registry.attributes_of(tuple(registry.OUTPUTS.values()))]
    assert len(set(names)) == len(names)
