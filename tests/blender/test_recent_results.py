"""What was computed last is at hand for the next step, as long as the meshes are what they were."""

from collections import Counter

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object
from tests.compute.registration.shapes import lumpy_ball


@pytest.fixture
def pair():
    """A target with its vertices in another order, and the source, which is active."""
    ball = lumpy_ball(2)
    order = np.random.default_rng(3).permutation(len(ball.vertices))
    target = add_object(1.7 * ball.vertices[order], np.argsort(order)[ball.triangles], "target")
    source = add_object(1.3 * ball.vertices, ball.triangles, "source")
    source.vertex_groups.new(name="Upper").add([0, 1, 2], 1.0, "REPLACE")
    source.data.attributes.new("height", "FLOAT", "POINT")
    return source, target


@pytest.fixture
def calls(monkeypatch):
    """How often the engine is asked for what takes time."""
    from eigenparts import compute as engine

    counts = Counter()

    def counted(name, function):
        return lambda *arguments, **named: counts.update([name]) or function(*arguments, **named)

    for name in ("analyze", "match", "correspond"):
        monkeypatch.setattr(engine, name, counted(name, getattr(engine, name)), raising=False)
    return counts


def test_a_reference_that_was_just_analyzed_is_not_analyzed_again(pair, calls):
    source, _ = pair
    # No other test has it so, so its registration is not at hand either.
    source.data.vertices[0].co *= 1.02
    bpy.ops.eigenparts.analyze()
    calls.clear()
    bpy.ops.eigenparts.register_selected()
    assert calls["analyze"] <= 1


def test_other_layers_of_the_same_two_meshes_need_no_new_map(pair, calls):
    _, target = pair
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    calls.clear()
    bpy.ops.eigenparts.transfer(layers={"ATTRIBUTES"})
    assert not calls
    assert "height" in target.data.attributes


def test_a_mesh_that_changed_is_mapped_anew(pair, calls):
    _, target = pair
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    target.data.vertices[0].co *= 1.01
    calls.clear()
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    # The source is as it was.
    assert calls == {"analyze": 1, "match": 1, "correspond": 1}


def test_a_mirrored_transfer_is_another_map(pair, calls):
    _, target = pair
    target.data.vertices[0].co *= 1.03
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    calls.clear()
    bpy.ops.eigenparts.transfer(layers={"GROUPS"}, mirrored=True)
    assert calls["correspond"] == 1
