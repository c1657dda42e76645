"""Meshes that only their modifiers make whole are told where they cannot be matched."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object
from tests.compute.registration.shapes import lumpy_ball


@pytest.fixture
def half():
    """Half a ball with a Mirror modifier; the whole one, with weights, is active."""
    ball = lumpy_ball(2)
    inside = (ball.vertices[ball.triangles][:, :, 0] >= 0).all(axis=1)
    obj = add_object(ball.vertices, ball.triangles[inside], "half")
    obj.modifiers.new("To the Left", "MIRROR")
    whole = add_object(ball.vertices, ball.triangles, "whole")
    whole.vertex_groups.new(name="All").add(range(len(ball.vertices)), 1.0, "REPLACE")
    return obj


def refused_transfer():
    with pytest.raises(RuntimeError) as refusal:
        bpy.ops.eigenparts.transfer(layers={"GROUPS"}, method="SHAPE")
    return str(refusal.value)


def test_a_half_that_takes_nothing_is_told_by_its_modifier(half, monkeypatch):
    from eigenparts.tasks import layer_mapping

    monkeypatch.setattr(layer_mapping, "NO_MATCH", 1.1)
    assert 'The modifier "To the Left" of half adds to the mesh' in refused_transfer()


def test_modifiers_that_leave_the_shape_are_not_named(half, monkeypatch):
    from eigenparts.operators.mesh_data.unfinished_meshes import modifiers_that_add

    half.modifiers["To the Left"].show_viewport = False
    half.modifiers.new("Finer", "SUBSURF")
    # Nodes often smooth normals only.
    half.modifiers.new("Smooth by Angle", "NODES").node_group = passing_nodes()
    assert modifiers_that_add(half) == ()
    half.modifiers["To the Left"].show_viewport = True
    half.modifiers.new("Row", "ARRAY")
    assert modifiers_that_add(half) == ("To the Left", "Row")


def test_nodes_that_make_the_mesh_longer_are_named(half):
    from eigenparts.operators.mesh_data.unfinished_meshes import modifiers_that_add

    half.modifiers.clear()
    half.modifiers.new("Copies", "NODES").node_group = passing_nodes(then="GeometryNodeTransform")
    assert modifiers_that_add(half) == ("Copies",)


def passing_nodes(then="GeometryNodeSetShadeSmooth"):
    """Return nodes that smooth the faces, or double the length."""
    nodes = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        nodes.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    first, between, last = (nodes.nodes.new(kind) for kind in ("NodeGroupInput", then, "NodeGroupOutput"))
    if "Scale" in between.inputs:
        between.inputs["Scale"].default_value = 1, 2, 1
    nodes.links.new(first.outputs[0], between.inputs["Geometry"])
    nodes.links.new(between.outputs[0], last.inputs[0])
    return nodes


def test_a_half_that_is_registered_in_doubt_is_told_by_its_modifier(half, monkeypatch):
    from eigenparts.operators.mesh_state import registration_record
    from eigenparts.operators.messages import sentences

    told = []
    monkeypatch.setattr(sentences, "tell", lambda operator, kind, *texts: told.extend(texts))
    monkeypatch.setattr(registration_record, "SURE", 1.1)
    bpy.ops.eigenparts.register_selected(order="1")
    assert any('The modifier "To the Left" of half' in text for text in told)
    assert not any("of whole" in text for text in told if "modifier" in text)


def test_applied_the_modifier_is_no_obstacle(half):
    with bpy.context.temp_override(object=half, active_object=half):
        bpy.ops.object.modifier_apply(modifier="To the Left")
    bpy.context.view_layer.update()
    assert np.ptp([vertex.co.x for vertex in half.data.vertices]) > 1
    from eigenparts.operators.mesh_data.unfinished_meshes import modifiers_that_add

    assert modifiers_that_add(half) == ()
