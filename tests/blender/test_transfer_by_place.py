"""Transfer by place: clothes on a body, wherever the objects stand, and what is told of it."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, values_of
from tests.blender.test_transfer import mesh_positions, weights_of
from tests.compute.registration.dense.test_by_place import BODY, tube
from tests.compute.registration.shapes import lumpy_ball
from tests.shapes import joined


@pytest.fixture
def body():
    """A body with one group, whose weights are the heights, and a shape key; in the world twice as large and turned."""
    obj = add_object(BODY.vertices, BODY.triangles, "body")
    group = obj.vertex_groups.new(name="Height")
    for vertex, height in enumerate((BODY.vertices[:, 2] / 10).tolist()):
        group.add([vertex], height, "REPLACE")
    obj.shape_key_add(name="Basis")
    raised = obj.shape_key_add(name="Raised")
    raised.data.foreach_set("co", np.float32(BODY.vertices + np.array([0, 0, 0.5])).ravel())
    stand(obj, (1, 2, 3), (0.3, 0.5, 0.1), 2.0)
    return obj


def stand(obj, location, rotation, scale):
    obj.location, obj.rotation_euler, obj.scale = location, rotation, (scale,) * 3
    bpy.context.view_layer.update()


def dressed(body, mesh, name="shirt"):
    """Add clothes that lie on the body in the world, with another origin, turn and size of their own."""
    obj = add_object(mesh.vertices, mesh.triangles, name)
    stand(obj, (-4, 0, 1), (0, 0, 1.2), 0.5)
    to_own = obj.matrix_world.inverted() @ body.matrix_world
    obj.data.transform(to_own)
    return obj


def transfer(source, target, **options):
    bpy.ops.object.select_all(action="DESELECT")
    target.select_set(True)
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    return bpy.ops.eigenparts.transfer(**options)


def test_a_shirt_gets_the_weights_under_it_without_an_analysis(body, capfd, monkeypatch):
    from eigenparts.tasks import recent_analyses

    monkeypatch.setattr(recent_analyses, "recall", None)
    shirt = dressed(body, tube(1.03, 4.0, 8.0, n_around=31))
    assert transfer(body, shirt) == {"FINISHED"}
    heights = tube(1.03, 4.0, 8.0, n_around=31).vertices[:, 2] / 10
    np.testing.assert_allclose(weights_of(shirt, "Height"), heights, atol=0.002)
    assert "The mesh lies on the other one, so nearest points were taken." in capfd.readouterr().out


def test_a_shape_key_moves_clothes_as_it_moves_the_body_in_the_world(body):
    shirt = dressed(body, tube(1.03, 4.0, 8.0))
    shirt.shape_key_add(name="Basis")
    transfer(body, shirt, layers={"SHAPE_KEYS"})
    basis, raised = (keyed(shirt, name) @ np.array(shirt.matrix_world)[:3, :3].T for name in ("Basis", "Raised"))
    expected = np.array(body.matrix_world)[:3, :3] @ [0, 0, 0.5]
    np.testing.assert_allclose(raised - basis, np.tile(expected, (len(basis), 1)), atol=1e-5)


def keyed(obj, name):
    places = np.empty(3 * len(obj.data.vertices), dtype=np.float32)
    obj.data.shape_keys.key_blocks[name].data.foreach_get("co", places)
    return places.reshape(-1, 3)


def test_the_body_gets_what_clothes_have(body):
    shirt = dressed(body, tube(1.03, 4.0, 8.0))
    shirt.data.attributes.new("paint", "FLOAT", "POINT").data.foreach_set(
        "value", np.float32(tube(1.03, 4.0, 8.0).vertices[:, 2])
    )
    transfer(shirt, body, layers={"ATTRIBUTES"})
    heights, values = BODY.vertices[:, 2], values_of(body.data, "paint", 1, np.float32, "value").ravel()
    under = (heights > 4.2) & (heights < 7.8)
    np.testing.assert_allclose(values[under], heights[under], atol=0.05)
    assert values.min() >= 4 - 1e-5
    assert values.max() <= 8 + 1e-5


def test_a_loose_part_that_lies_nowhere_is_told(body, capfd):
    lost = tube(0.2, 0.0, 1.0, x=30.0)
    shirt = dressed(body, joined(tube(1.03, 4.0, 8.0), lost))
    assert transfer(body, shirt, method="PLACE") == {"FINISHED"}
    assert "Loose parts of shirt that lie nowhere on body: 1; they are given what is nearest." in capfd.readouterr().out


@pytest.mark.parametrize(
    ("options", "told"),
    [({}, "does not lie on body anywhere"), ({"mirrored": True}, "Points and Mirrored are for transfers by shape")],
)
def test_what_cannot_be_carried_by_place_is_refused_and_left_alone(body, options, told):
    shirt = dressed(body, tube(1.03, 4.0, 8.0))
    shirt.location.x += 100
    before = mesh_positions(shirt.data)
    with pytest.raises(RuntimeError, match=told):
        transfer(body, shirt, method="PLACE", **options)
    assert not shirt.vertex_groups
    np.testing.assert_array_equal(mesh_positions(shirt.data), before)


def test_what_is_neither_alike_nor_there_is_told_of_both_ways(body):
    helmet = dressed(body, lumpy_ball(2), "helmet")
    helmet.location.x += 100
    with pytest.raises(RuntimeError, match=r"not alike enough.*choose Mirrored.*choose By Place"):
        transfer(body, helmet)


def test_weights_of_what_hangs_over_sum_to_what_they_sum_to_on_the_body(body):
    lower = body.vertex_groups.new(name="Rest")
    for vertex, height in enumerate((BODY.vertices[:, 2] / 10).tolist()):
        lower.add([vertex], 1 - height, "REPLACE")
    skirt = dressed(body, flared())
    transfer(body, skirt, method="PLACE")
    np.testing.assert_allclose(weights_of(skirt, "Height") + weights_of(skirt, "Rest"), 1, atol=1e-5)


def test_what_does_not_lie_there_is_told_as_a_share(body, capfd):
    transfer(body, dressed(body, flared(), "skirt"), method="PLACE")
    assert "of skirt does not lie on body; if it stands in another pose, bring both into the same." in (
        capfd.readouterr().out
    )


def flared():
    """Return a tube around the body whose lower half goes away from it."""
    shirt = tube(1.03, 4.0, 8.0, n_along=24)
    wider = 1 + np.maximum(0, 6.2 - shirt.vertices[:, 2])
    return type(shirt)(shirt.vertices * np.stack([wider, wider, np.ones_like(wider)], axis=1), shirt.triangles)
