"""The outline of the part that was clicked in the list; the drawing itself needs a window."""

import importlib

import bpy
import numpy as np
import pytest

from tests.blender.conftest import values_of


@pytest.fixture
def outline(extension):
    return importlib.import_module(f"{extension.__name__}.operators.parts.part_outline").outline


def click(obj, part):
    settings = obj.data.eigenparts
    settings.active_row = [row.part for row in settings.rows].index(part)


def lines_of(outline, obj):
    return outline(obj, bpy.context.evaluated_depsgraph_get())


def test_nothing_is_outlined_until_a_part_is_clicked(outline, analyzed):
    assert analyzed.data.eigenparts.active_row == -1
    assert len(lines_of(outline, analyzed)) == 0


def test_the_outline_is_one_ring_of_edges_between_inside_and_outside(outline, analyzed):
    click(analyzed, 2)
    lines = lines_of(outline, analyzed)
    labels = values_of(analyzed.data, "part")
    inside, outside = (
        {v for polygon in analyzed.data.polygons if (labels[polygon.index] == 2) == wanted for v in polygon.vertices}
        for wanted in (True, False)
    )
    positions = np.array([analyzed.data.vertices[v].co for v in inside & outside], dtype=np.float32)
    assert {tuple(point) for point in lines} == {tuple(point) for point in positions}
    # A ring passes each of its vertices twice.
    assert len(lines) == 2 * len(positions)


def test_the_part_stays_active_when_the_level_moves(outline, analyzed):
    click(analyzed, 3)
    for level in range(5):
        analyzed.data.eigenparts.level = level
        rows = [row.part for row in analyzed.data.eigenparts.rows]
        assert analyzed.data.eigenparts.active_row == (rows.index(3) if 3 in rows else -1)
        assert (len(lines_of(outline, analyzed)) > 0) == (3 in rows)


def test_the_outline_follows_the_pose(outline, analyzed):
    click(analyzed, 2)
    before = lines_of(outline, analyzed)
    modifier = analyzed.modifiers.new("push", "DISPLACE")
    modifier.strength, modifier.mid_level, modifier.direction = 2.0, 0.0, "X"
    bpy.context.view_layer.update()
    np.testing.assert_allclose(lines_of(outline, analyzed), before + np.float32([2, 0, 0]), atol=1e-5)


def test_there_is_none_in_edit_mode_and_without_the_map(outline, analyzed):
    click(analyzed, 2)
    bpy.ops.object.mode_set(mode="EDIT")
    assert len(lines_of(outline, analyzed)) == 0
    bpy.ops.object.mode_set(mode="OBJECT")
    analyzed.data.attributes.remove(analyzed.data.attributes["part"])
    assert len(lines_of(outline, analyzed)) == 0
