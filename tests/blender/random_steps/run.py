"""Random steps in a row, and what must hold after each.

A run is a list of steps that is drawn before anything is done. Each step has a number of its own by which it chooses
among what it finds, so a run repeats itself, and goes on where a step is left out.
"""

import sys
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from random import Random
from typing import NamedTuple
from unittest import mock

import bpy

from tests.blender.drawn import draw_everything, registered
from tests.blender.pressed import press
from tests.blender.random_steps import cast, rules, soundness, user
from tests.blender.random_steps.belongings import Place, belongings, changed, names_on
from tests.blender.random_steps.options import options_of
from tests.blender.random_steps.readiness import make_ready

# Seconds of CPU that an operator may take on meshes of some hundred faces.
MOST_SECONDS = 30
PRESS, PANEL, SAVE = "press", "panel", "save"
# Operators that take seconds, and the rounds in which they are pressed.
SLOW, ROUNDS_BETWEEN = {"register_selected", "transfer", "plot_diagram"}, 3
# How often the user does something, for each time that every operator is pressed.
USERS_SHARE = 0.6


class Step(NamedTuple):
    """An operator to be pressed or an action of the user's, and the number by which it chooses."""

    action: str
    seed: int


@dataclass
class Taken:
    """What became of a step.

    Attributes
    ----------
    step : Step
    text : str
        All that was chosen.
    outcome : str
        "done", "refused" or "user".
    findings : list of str
        All that must not be, without names and numbers of the occasion.
    left : dict or None
        Everything in the file as the step has left it, if that is known; while it is taken only.
    """

    step: Step
    text: str = ""
    outcome: str = "user"
    findings: list[str] = field(default_factory=list)
    left: dict[Place, object] | None = None


def operators() -> list[str]:
    """Return the names of all operators that are registered."""
    return sorted(one.bl_idname.partition(".")[2] for one in registered(bpy.types.Operator))


def draw_steps(seed: int, n_steps: int) -> list[Step]:
    """Return the steps of a run: rounds in which each operator is pressed once, among what users do."""
    chance, steps = Random(seed), []
    for number in count():
        slow = SLOW if number % ROUNDS_BETWEEN else set()
        pressed = [*(name for name in operators() if name not in slow), PANEL, PANEL, SAVE]
        actions = pressed + chance.choices(sorted(user.ACTIONS), k=int(USERS_SHARE * len(pressed)))
        chance.shuffle(actions)
        steps += [Step(action, chance.randrange(2**32)) for action in actions]
        if len(steps) >= n_steps:
            return steps[:n_steps]


def take_all(seed: int, steps: list[Step], folder: Path) -> Iterator[Taken]:
    """Take steps in a new file with a cast that is drawn by a seed."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    cast.add_cast(Random(seed))
    user.push_undo()
    for step in steps:
        yield take(step, folder)


def take(step: Step, folder: Path) -> Taken:
    """Take one step and look at everything."""
    taken, chance = Taken(step), Random(step.seed)
    user.tidy(chance)
    with _traps(taken, folder):
        if step.action in user.ACTIONS:
            _let_user(taken, chance)
        elif step.action == SAVE:
            _save_and_load(taken, folder)
        elif step.action == PANEL:
            _set_in_panel(taken, chance)
        else:
            _press(taken, chance)
        before = taken.left or belongings()
        draw_everything()
        taken.findings += [f"drawing the panels changes {_path(place)}" for place in changed(before, belongings())]
    taken.left = None
    if bpy.context.mode == "OBJECT":
        user.push_undo()
    return taken


@contextmanager
def _traps(taken: Taken, folder: Path) -> Iterator[None]:
    """Take for findings what is raised, printed by Blender or warned of."""

    def printed(kind, error, trace):
        taken.findings.append(f"printed: {_last_lines(error)}")

    # Presets go to a folder of the user's.
    resource = mock.patch.object(bpy.utils, "user_resource", return_value=str(folder))
    with warnings.catch_warnings(), mock.patch.object(sys, "excepthook", printed), resource:
        warnings.simplefilter("error")
        try:
            yield
        except Exception as error:
            taken.findings.append(f"raised: {_last_lines(error)}")


def _last_lines(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)[-3:]
    places = [f"{Path(frame.filename).name}:{frame.lineno}" for frame in frames]
    return f"{type(error).__name__}: {str(error)[-300:]} ({', '.join(places)})"


def _let_user(taken: Taken, chance: Random) -> None:
    if taken.step.action not in user.ANYWHERE:
        user.leave_mode()
    taken.text = user.ACTIONS[taken.step.action](chance)


def _save_and_load(taken: Taken, folder: Path) -> None:
    user.leave_mode()
    bpy.data.orphans_purge(do_recursive=True)
    before = belongings()
    user.save_and_load(folder)
    taken.findings += [f"saving and loading changes {_path(place)}" for place in changed(before, belongings())]


def _set_in_panel(taken: Taken, chance: Random) -> None:
    """Set a property of the active mesh, of a row of its list, or none if it has no parts."""
    make_ready("segment", chance)
    obj = bpy.context.object
    if obj is None or obj.type != "MESH":
        return
    settings = obj.data.eigenparts
    groups = [settings, settings, *settings.rows]
    group = groups[chance.randrange(len(groups))]
    declared = [
        one
        for one in group.bl_rna.properties
        if one.type in ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM") and one.identifier not in BLENDERS
    ]
    with _unchanged_beyond(taken, PANEL, belongings()):
        taken.text = f"{obj.name}: {user.set_property(group, chance.choice(declared), chance)}"


# Of rows, what setters write and nobody sets; `name` is Blender's own.
BLENDERS = {"name", "part", "depth", "share", "n_faces"}


def _press(taken: Taken, chance: Random) -> None:
    """Press an operator, on an object that it takes or on whatever is active."""
    name = taken.step.action
    is_ready = chance.random() < 0.8
    if is_ready:
        make_ready(name, chance)
    options = options_of(name, chance, is_likely=is_ready and chance.random() < 0.8)
    mode, obj = bpy.context.mode, bpy.context.object
    taken.text = f"{obj.name if obj else None} [{mode}, {len(bpy.context.selected_objects)} selected] {options}"
    is_undone = mode == "OBJECT" and "UNDO" in _class_of(name).bl_options and chance.random() < 0.3
    if is_undone:
        user.push_undo()
    before, start = belongings(), time.process_time()
    with _job(name, chance), _unchanged_beyond(taken, name, before):
        pressed = press(name, **options)
        taken.outcome = "done" if pressed.is_done else "refused"
        taken.text += f" -> {pressed.sentence or 'done'}"
    if time.process_time() - start > MOST_SECONDS:
        taken.findings.append(f"{name} takes longer than {MOST_SECONDS} s")
    if is_undone and pressed.is_done:
        _undo_and_redo(taken, before)


def _undo_and_redo(taken: Taken, before: dict[Place, object]) -> None:
    user.push_undo()
    after, taken.left = belongings(), None
    name = taken.step.action
    for step, wanted in (("undo", before), ("redo", after)):
        user.in_window(getattr(bpy.ops.ed, step))
        taken.findings += [f"{step} of {name} leaves {_path(place)}" for place in changed(wanted, belongings())]


@contextmanager
def _job(name: str, chance: Random) -> Iterator[None]:
    """Let a job be under way, where it is to be cancelled and now and then."""
    from eigenparts.operators.jobs import background

    runs = chance.random() < (0.7 if name == "cancel" else 0.02)
    with mock.patch.object(background, "_running", mock.Mock() if runs else None):
        yield


@contextmanager
def _unchanged_beyond(taken: Taken, name: str, before: dict[Place, object]) -> Iterator[None]:
    """Look whether the block changes what it may, and leaves what it changes sound."""
    scope, complaints = _scope(), _complaints()
    mode = bpy.context.mode
    yield
    if mode == "OBJECT":
        user.leave_mode()
    after = belongings()
    taken.left = after
    places = changed(before, after)
    if mode == "EDIT_MESH":
        # What cannot be read while it is edited cannot be compared.
        places = [place for place in places if place in before and place in after]
    scope = replace(scope, ours=_ours_after(scope.ours, before))
    if taken.outcome == "refused":
        taken.findings += [f"{name} refused changes {_path(place)}" for place in places]
    else:
        wrong = rules.beyond(name, scope, before, after, places)
        taken.findings += [f"{name} changes {_path(place)}" for place in wrong]
    taken.findings += _new_complaints(name, complaints, places)
    if name == "clear" and taken.outcome == "done":
        taken.findings += [f"clear leaves {left}" for left in soundness.left_on(bpy.context.object.data)]


def _new_complaints(name: str, before: dict[str, set[str]], places: list[Place]) -> Iterator[str]:
    """Yield what does not fit together after an operator, and did before or was written by it."""
    written = {mesh for kind, mesh, what in places if kind == "meshes" and what in ("layer part", "rows")}
    for mesh, complaints in _complaints().items():
        for complaint in complaints - (set() if mesh in written else before.get(mesh, set())):
            yield f"after {name} {complaint}"
    shaped = {mesh for kind, mesh, what in places if kind == "meshes" and what in ("faces", "layer .corner_vert")}
    for mesh in shaped & set(bpy.data.meshes.keys()):
        if soundness.invalid(bpy.data.meshes[mesh]):
            yield f"after {name} a mesh is invalid"


def _complaints() -> dict[str, set[str]]:
    return {mesh.name_full: soundness.unsound(mesh) for mesh in bpy.data.meshes}


# The kind of data-block that `belongings` names each type by.
KINDS = {
    **dict(OBJECT="objects", MESH="meshes", KEY="shape_keys", MATERIAL="materials"),
    **dict(CURVE="curves", ARMATURE="armatures"),
}


def _scope() -> rules.Scope:
    active = bpy.context.object
    others = [obj for obj in bpy.context.selected_objects if obj != active]
    of_active = _with_data([active] if active else [])
    traced = [obj for obj in bpy.data.objects if "eigenparts_role" in obj]
    return rules.Scope(of_active, _with_data(others) - of_active, _ours(), _with_data(traced))


def _with_data(objects: list[bpy.types.Object]) -> set[tuple[str, str]]:
    """Return objects, their data, shape keys and materials of parts, and all objects that share these."""
    data = {obj.data for obj in objects if obj.data is not None}
    keys = {keys for one in data if (keys := getattr(one, "shape_keys", None))}
    dressed = {slot for one in data for slot in getattr(one, "materials", ()) if slot and "eigenparts_part" in slot}
    sharing = {obj for obj in bpy.data.objects if obj.data in data}
    return {(KINDS.get(one.id_type, ""), one.name_full) for one in {*objects, *sharing, *data, *keys, *dressed}}


def _ours() -> dict[str, set[str]]:
    """Return what is marked as ours, by the names of meshes and of the objects that have them."""
    ours = {mesh.name_full: names_on(mesh) for mesh in bpy.data.meshes}
    for obj in bpy.data.objects:
        if obj.type == "MESH":
            ours[obj.name_full] = ours.get(obj.name_full, set()) | names_on(obj.data)
    return ours


def _ours_after(ours: dict[str, set[str]], before: dict[Place, object]) -> dict[str, set[str]]:
    """Return what was ours, with what is and was not there before."""
    taken = {(name, what.removeprefix("layer ")) for _, name, what in before}
    return {
        name: ours.get(name, set()) | {what for what in names if (name, what) not in taken}
        for name, names in _ours().items()
    }


def _class_of(name: str) -> type[bpy.types.Operator]:
    return next(one for one in registered(bpy.types.Operator) if one.bl_idname == f"eigenparts.{name}")


def _path(place: Place) -> str:
    """Return the place without the name of the data-block."""
    kind, _, what = place
    return f"{kind}/{what}" if what else kind
