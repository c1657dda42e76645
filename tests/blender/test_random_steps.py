"""Operators pressed at random, with all that users do in between; and that the tester sees what goes wrong."""

import bpy
import pytest

from tests.blender.failing import module_of_operators
from tests.blender.random_steps.run import PANEL, Step, draw_steps, operators, take_all

N_STEPS = 400
# Some want much at once, such as a matching that has alternatives.
MOST_NEVER_DONE = 3


# The benchmark runs any other.
LONG_SEEDS = (3, 4, 16, 18, 19)


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in LONG_SEEDS)])
def test_nothing_is_lost_whatever_is_pressed(seed, tmp_path):
    taken = list(take_all(seed, draw_steps(seed, N_STEPS), tmp_path))
    repeat = f"python -m benchmarks.operators {seed} {N_STEPS}"
    assert [(number, one) for number, one in enumerate(taken) if one.findings] == [], repeat
    assert {one.step.action for one in taken} >= set(operators())
    never_done = set(operators()) - {one.step.action for one in taken if one.outcome == "done"}
    assert len(never_done) <= MOST_NEVER_DONE, never_done


def test_an_operator_that_is_new_is_pressed_too(monkeypatch):
    new = type(
        "EIGENPARTS_OT_new",
        (bpy.types.Operator,),
        {"bl_idname": "eigenparts.new", "bl_label": "New", "__module__": "eigenparts.new"},
    )
    bpy.utils.register_class(new)
    pressed = {step.action for step in draw_steps(0, 100)}
    bpy.utils.unregister_class(new)
    assert pressed >= {"new", *operators()}


def after(monkeypatch, function, slip):
    """Let something happen after each call of a function of the operators, on what it was called with."""
    module, name = function.split(".")
    owner = module_of_operators(module)
    original = getattr(owner, name)

    def slipping(*arguments, **options):
        result = original(*arguments, **options)
        slip(*arguments)
        return result

    monkeypatch.setattr(owner, name, slipping)


def overwrite_a_layer(mesh, *_):
    for name in {"heat", "marks", "seams"} & set(mesh.attributes.keys()):
        element = mesh.attributes[name].data[0]
        element.value = 1 - element.value


def leave_an_object(operator, state):
    from eigenparts.tasks.refusals import Refusal

    bpy.data.objects.new("left", None)
    raise Refusal("It cannot be.")


def deselect_all(context):
    for obj in context.selected_objects:
        obj.select_set(False)


def label_a_face(mesh, *_):
    mesh.attributes["part"].data[0].value = 4000


def move_a_vertex(mesh, *_):
    mesh.vertices[0].co.x += 1


def fail(*_):
    raise ZeroDivisionError


SLIPS = {
    "a layer of the user's is overwritten": (
        *("segment", "analyze changes meshes/layer "),
        lambda patch: after(patch, "division_writer.list_parts", overwrite_a_layer),
    ),
    "a refusal leaves an object": (
        *("merge_parts", "merge_parts refused changes objects"),
        lambda patch: patch.setattr(bpy.types.EIGENPARTS_OT_merge_parts, "correct", leave_an_object),
    ),
    "a panel raises": (
        *("select faces", "raised: ZeroDivisionError"),
        lambda patch: patch.setattr(bpy.types.EIGENPARTS_PT_topology, "draw", fail),
    ),
    "the selection changes": (
        *("segment", "segment changes objects/selected"),
        lambda patch: after(patch, "segment.show_vertex_colours", deselect_all),
    ),
    "a label is not listed": (
        *("segment", "after segment labels are not listed"),
        lambda patch: after(patch, "division_writer.list_parts", label_a_face),
    ),
    "a vertex moves": (
        *("segment", "analyze changes meshes/layer position"),
        lambda patch: after(patch, "division_writer.list_parts", move_a_vertex),
    ),
    "an operator breaks": (
        *("analyze", "raised: AssertionError"),
        lambda patch: after(patch, "mesh_segmentation.read_input", fail),
    ),
    "a setter breaks, which Blender only prints": (
        *(PANEL, "printed: ZeroDivisionError"),
        lambda patch: after(patch, "part_writer.segment", fail),
    ),
    "clearing leaves a property": (
        *("clear", "clear leaves eigenparts_forgotten"),
        lambda patch: after(patch, "clear.forget", lambda mesh: mesh.__setitem__("eigenparts_forgotten", 1)),
    ),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_noticed(slip, monkeypatch, tmp_path):
    action, finding, make = SLIPS[slip]
    make(monkeypatch)
    found = [finding for taken in take_all(1, steps_to(action), tmp_path) for finding in taken.findings]
    assert finding in {one[: len(finding)] for one in found}


def test_without_a_slip_nothing_is_noticed(tmp_path):
    steps = [step for action in {action for action, _, _ in SLIPS.values()} for step in steps_to(action)]
    assert [finding for taken in take_all(1, steps, tmp_path) for finding in taken.findings] == []


def steps_to(action):
    """Return steps that let an action have its chance some times."""
    return [Step(name, seed) for seed in range(6) for name in ("analyze", action)]
