"""What the worker computes is what Blender computes for scripts, bit by bit, and without any module of Blender."""

from functools import partial

import bpy
import pytest

from tests.blender import worker_tasks as tasks
from tests.blender.conftest import add_object
from tests.blender.test_background import ended

ALONE = ["analyze", "trace_complex", "create_armature", "create_skeleton_curves", "plot_diagram"]


@pytest.fixture
def in_worker(extension, monkeypatch):
    """From now on, let a script wait for the worker, as the window does."""
    from eigenparts.operators.jobs import background, job
    from eigenparts.operators.messages.user_errors import refusals_told

    def execute(self, context):
        with refusals_told(self):
            work, handle = self.begin(context)
            assert ended(job.Job(partial(tasks.modules_of_blender, work))).result() == []
            return self.finish(context, handle, bits_compared(work, ended(job.Job(work)).result()))
        return {"CANCELLED"}

    return lambda: monkeypatch.setattr(background.BackgroundOperator, "execute", execute)


def bits_compared(work, of_worker):
    """Return the result of the worker, if it is that of Blender."""
    assert bits(of_worker) == bits(work(lambda fraction, text: None))
    return of_worker


def bits(value):
    """Return a value as numbers, texts and bytes; how long something took is left out."""
    if hasattr(value, "__dataclass_fields__"):
        fields = (name for name in value.__dataclass_fields__ if name != "seconds")
        return type(value).__name__, [(name, bits(getattr(value, name))) for name in fields]
    if hasattr(value, "tobytes"):
        return str(value.dtype), value.shape, value.tobytes()
    if isinstance(value, dict):
        return [(key, bits(item)) for key, item in value.items()]
    if isinstance(value, list | tuple):
        return [bits(item) for item in value]
    return value if isinstance(value, str | int | float | None) else type(value).__name__


@pytest.mark.parametrize("operator", ALONE)
def test_an_operator_gives_by_way_of_the_worker_what_it_gives_a_script(analyzed, in_worker, operator):
    in_worker()
    assert getattr(bpy.ops.eigenparts, operator)(order="1") == {"FINISHED"}


def test_eigenfunctions_of_the_worker_are_those_of_a_script(analyzed, in_worker):
    in_worker()
    assert bpy.ops.eigenparts.write_eigenfunctions() == {"FINISHED"}


@pytest.mark.parametrize("operator", ["register_selected", "transfer"])
def test_two_meshes_get_by_way_of_the_worker_what_a_script_gives_them(analyzed, star, in_worker, operator):
    other = add_object(1.1 * star.vertices, star.triangles, "other")
    analyzed.vertex_groups.new(name="group").add([0, 1], 1.0, "REPLACE")
    for obj in (other, analyzed):
        obj.select_set(True)
    bpy.context.view_layer.objects.active = analyzed
    in_worker()
    assert getattr(bpy.ops.eigenparts, operator)() == {"FINISHED"}
