"""Many steps in a row."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import values_of

N_STEPS = 100


@pytest.fixture
def many_undo_steps():
    """Blender keeps 32 steps by default."""
    edit = bpy.context.preferences.edit
    usual, edit.undo_steps = edit.undo_steps, 2 * N_STEPS
    yield
    edit.undo_steps = usual


def test_a_hundred_levels_are_undone_one_by_one(analyzed, many_undo_steps):
    n_levels = analyzed.data["eigenparts_state"]["hierarchy"]["n_levels"]
    window = bpy.context.window_manager.windows[0]
    shown = []
    with bpy.context.temp_override(window=window, screen=window.screen):
        for step in range(N_STEPS):
            bpy.ops.eigenparts.segment(level=step % n_levels)
            bpy.ops.ed.undo_push(message=f"step {step}")
            shown.append(values_of(analyzed.data, "part"))
        assert len({labels.tobytes() for labels in shown}) == n_levels
        for labels in reversed(shown[:-1]):
            bpy.ops.ed.undo()
            np.testing.assert_array_equal(values_of(bpy.data.objects["star"].data, "part"), labels)
