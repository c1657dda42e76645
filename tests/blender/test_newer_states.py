"""What a newer version has stored is refused in one sentence, and left as it is until it is analyzed or cleared."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, everything_on, values_of
from tests.blender.drawn import draw_panels

STATE = "eigenparts_state"
SENTENCE = "analyzed by a newer version of Eigenparts; update the extension or analyze the mesh again"
READERS = {
    "segment": {"level": 1},
    "write_outputs": {"outputs": {"MATERIALS", "VERTEX_GROUPS"}},
    "merge_parts": {"part": 1, "into": 0},
    "split_part": {"part": 1},
    "move_border": {"part": 1, "offset": 0.1},
    "set_branch_level": {"part": 1, "level": 1},
    "paint_part": {"new": True},
    "clear_corrections": {},
    "cut": {"method": "INSERT"},
    "create_armature": {"order": "1"},
    "create_skeleton_curves": {"order": "1"},
}


@pytest.fixture
def newer(analyzed):
    """The star as the next version of the state would leave it, with something that is not known yet."""
    analyzed.data[STATE]["schema"] += 1
    analyzed.data[STATE]["to come"] = {"of": "the next version"}
    analyzed.data.polygons[0].select = True
    return analyzed


def all_of(mesh):
    return everything_on(mesh), str(mesh[STATE].to_dict()), values_of(mesh, "part").tobytes(), len(mesh.materials)


@pytest.mark.parametrize("operator", READERS)
def test_no_operator_reads_or_changes_it(newer, operator):
    before = all_of(newer.data)
    with pytest.raises(RuntimeError, match=SENTENCE):
        getattr(bpy.ops.eigenparts, operator)(**READERS[operator])
    assert all_of(newer.data) == before
    assert list(bpy.data.objects) == [newer]


@pytest.mark.parametrize(
    ("name", "value"), [("level", 1), ("n_parts", 3), ("mode", "FEATURES"), ("materials", True), ("softness", 0.5)]
)
def test_no_setting_reads_or_changes_it(newer, name, value):
    before = all_of(newer.data)
    setattr(newer.data.eigenparts, name, value)
    assert SENTENCE in bpy.context.window_manager.eigenparts.problem
    assert all_of(newer.data) == before


@pytest.mark.parametrize("is_reference", [True, False])
def test_registering_replaces_it_on_no_mesh(newer, star, is_reference):
    other = add_object(star.vertices, star.triangles, "other")
    newer.select_set(True)
    bpy.context.view_layer.objects.active = newer if is_reference else other
    before = all_of(newer.data)
    with pytest.raises(RuntimeError, match=SENTENCE):
        bpy.ops.eigenparts.register_selected(order="1")
    assert all_of(newer.data) == before
    assert STATE not in other.data


def test_panels_draw_and_leave_it(newer):
    before = all_of(newer.data)
    draw_panels()
    assert all_of(newer.data) == before


@pytest.mark.parametrize("operator", ["analyze", "clear"])
def test_a_new_analysis_or_clearing_is_the_way_out(newer, operator):
    getattr(bpy.ops.eigenparts, operator)()
    if operator == "clear":
        assert STATE not in newer.data
        bpy.ops.eigenparts.analyze(order="1")
    assert "to come" not in newer.data[STATE]
    bpy.ops.eigenparts.segment(level=1)
    assert len(np.unique(values_of(newer.data, "part"))) > 1
