"""Panels count the meshes that operators write to."""

import bpy
import pytest

from tests.blender.conftest import add_object
from tests.blender.drawn import draw_panels


@pytest.fixture
def twins(star):
    """Two objects with one mesh, and a source that is active."""
    first = add_object(star.vertices, star.triangles, "first")
    second = bpy.data.objects.new("second", first.data)
    bpy.context.collection.objects.link(second)
    second.select_set(True)
    source = add_object(1.2 * star.vertices, star.triangles, "source")
    source.vertex_groups.new(name="group").add([0], 1.0, "REPLACE")
    return first, second, source


def test_linked_duplicates_are_one_mesh(twins):
    from eigenparts.operators.mesh_data.selected_meshes import other_meshes

    assert [obj.data for obj in other_meshes(bpy.context)] == [twins[0].data]


def test_linked_duplicates_are_announced_as_one(twins):
    texts = draw_panels()
    assert not any("2 others" in text for text in texts)
    assert any("source to" in text for text in texts)


@pytest.mark.parametrize("operator", ["register_selected", "transfer"])
def test_linked_duplicates_are_written_to_once(twins, capfd, operator):
    options = {"order": "1"} if operator == "register_selected" else {"layers": {"GROUPS"}}
    capfd.readouterr()
    getattr(bpy.ops.eigenparts, operator)(**options)
    infos = [line for line in capfd.readouterr().out.splitlines() if line.startswith("Info: ")]
    assert len(infos) == 1
    assert "Registered 1 object" in infos[0] or "1 layer of source" in infos[0]


def test_the_shared_mesh_of_the_active_object_is_no_target(twins):
    from eigenparts.operators.mesh_data.selected_meshes import other_meshes

    first, _, source = twins
    bpy.context.view_layer.objects.active = first
    assert other_meshes(bpy.context) == [source]
