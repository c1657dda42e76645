"""What an analysis warns of is told by everything that analyzes on the way."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object
from tests.shapes import icosphere

LOOSE = "has 2 loose parts"


def add_with_a_ball(mesh, name, scale=1.0):
    """Add a mesh with a ball out of its reach, which analyses warn of."""
    ball = icosphere(1)
    vertices = scale * np.vstack([mesh.vertices, 0.3 * ball.vertices + [9, 0, 0]])
    return add_object(vertices, np.vstack([mesh.triangles, ball.triangles + len(mesh.vertices)]), name)


@pytest.fixture
def pair(star):
    """Two stars with a ball beside each; the second one is active and analyzed."""
    first, second = (add_with_a_ball(star, name, scale) for name, scale in (("first", 1.2), ("second", 1.0)))
    first.vertex_groups.new(name="group").add([0], 1.0, "REPLACE")
    second.vertex_groups.new(name="group").add([0], 1.0, "REPLACE")
    bpy.ops.eigenparts.analyze(order="1")
    return first, second


def warnings_of(capfd, operator, **options):
    capfd.readouterr()
    assert getattr(bpy.ops.eigenparts, operator)(**options) == {"FINISHED"}
    return [line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning: ")]


@pytest.mark.parametrize(
    "operator",
    ["analyze", "create_armature", "create_skeleton_curves", "plot_diagram", "trace_complex", "write_eigenfunctions"],
)
def test_loose_parts_are_told_by_all_that_analyze_the_active_mesh(pair, capfd, operator):
    options = {"n_functions": 2} if operator == "write_eigenfunctions" else {"order": "1"}
    (warning,) = [
        line for line in warnings_of(capfd, operator, **options) if "were analyzed" in line or "and 0" in line
    ]
    assert LOOSE in warning


@pytest.mark.parametrize("operator", ["register_selected", "transfer"])
def test_loose_parts_are_told_by_name_where_there_are_two_meshes(pair, capfd, operator):
    options = {"order": "1"} if operator == "register_selected" else {"layers": {"GROUPS"}}
    warnings = warnings_of(capfd, operator, **options)
    assert [line.split(": ")[1] for line in warnings if LOOSE in line] == ["second", "first"]


def test_loose_parts_are_told_again_when_an_object_is_registered_again(pair, capfd):
    first, _ = pair
    bpy.ops.eigenparts.register_selected(order="1")
    again = warnings_of(capfd, "flip_function", object_name=first.name, number=1)
    assert [line.split(": ")[1] for line in again if LOOSE in line] == ["second", "first"]


def test_other_layers_of_the_same_two_meshes_are_warned_of_alike(pair, capfd):
    """The map is at hand then, and no analysis is made."""
    once, again = (warnings_of(capfd, "transfer", layers={"GROUPS"}) for _ in range(2))
    assert once == again != []
