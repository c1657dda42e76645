"""What is stored on a mesh may be damaged in any way: every operator works or says so, and every panel draws."""

import ast
import sys
from pathlib import Path

import bpy
import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from compute import TriangleMesh
from tests.blender.conftest import add_object, everything_on
from tests.blender.damage import ATTRIBUTE_DAMAGES, STATE, damage, damage_attribute, damages_of, own_attributes
from tests.blender.drawn import draw_panels
from tests.blender.pressed import press
from tests.selection import draws
from tests.shapes import joined

ROOT = Path(__file__).resolve().parents[2]
OUTPUTS = {"VERTEX_ATTRIBUTE", "CORNER_COLORS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS", "FIELD"}
# Meshes are damaged one after the other; the fixtures stay the same. Each draw has other damages.
DAMAGED = settings(
    deadline=None,
    max_examples=15,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@pytest.fixture(scope="module")
def small_star():
    from tests.shapes import star

    return star(n_arms=5, n_subdivisions=2)


@pytest.fixture
def divided(scene, small_star):
    """A star with two trees, all outputs and a name and a colour of the user's."""
    return scene(divided_star, small_star)


def divided_star(small_star):
    obj = add_object(small_star.vertices, small_star.triangles)
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=4, order="1")
    bpy.ops.eigenparts.segment(level=3)
    bpy.ops.eigenparts.write_outputs(outputs=OUTPUTS, softness=0.1)
    row = obj.data.eigenparts.rows[1]
    row.title, row.color = "Mine", (0.1, 0.2, 0.3)


@pytest.fixture
def corrected(scene, small_star):
    """The same with a split, a moved border and a painted part."""
    return scene(corrected_star, small_star)


def corrected_star(small_star):
    divided_star(small_star)
    divided = bpy.context.object
    first, second = [row.part for row in divided.data.eigenparts.rows if row.part][:2]
    bpy.ops.eigenparts.split_part(part=first, position=0.3)
    bpy.ops.eigenparts.move_border(part=second, offset=-0.05)
    divided.data.polygons.foreach_set("select", [face < 20 for face in range(len(divided.data.polygons))])
    bpy.ops.eigenparts.paint_part(new=True)
    assert len(divided.data.eigenparts.correction_rows) == 3


@pytest.fixture
def registered(scene, small_star):
    """A star with all outputs, registered to another."""
    return scene(registered_star, small_star)


def registered_star(small_star):
    divided_star(small_star)
    divided = bpy.context.object
    add_object(1.1 * small_star.vertices, small_star.triangles, "reference")
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.register_selected(order="1")
    bpy.context.view_layer.objects.active = divided


@pytest.fixture
def apart(scene, small_star):
    """Two stars in one mesh, each analyzed by itself, the first with a split and a level of its own."""
    return scene(stars_apart, small_star)


def stars_apart(small_star):
    both = joined(small_star, TriangleMesh(0.7 * small_star.vertices + [6, 0, 0], small_star.triangles))
    obj = add_object(both.vertices, both.triangles)
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=4, order="1", shells="SEPARATE")
    bpy.ops.eigenparts.segment(n_parts=6)
    bpy.ops.eigenparts.split_part(part=1, position=0.3)
    bpy.ops.eigenparts.set_branch_level(part=1, level=1)
    assert len(obj.data.eigenparts.correction_rows) == 2


def use_everything_that_reads(mesh):
    """Draw the panels, set every property and call every quick operator."""
    draw_panels()
    shown = mesh.eigenparts
    shown.active_part = 1
    for name, value in {
        **{"level": 2, "n_parts": 3, "mode": "FEATURES", "active_row": 1, "part_level": 2, "part_border": 0.1},
        **{"vertex_attribute": False, "vertex_groups": False, "materials": False, "softness": 0.0, "field": True},
    }.items():
        setattr(shown, name, value)
    if len(shown.rows):
        shown.rows[0].title, shown.rows[-1].color = "Trunk", (0, 1, 0)
    for operator, options in {
        "segment": {"n_parts": 3, "mode": "NESTED"},
        "write_outputs": {"outputs": OUTPUTS, "softness": 0.05},
        "split_part": {"part": 1, "position": 0.5},
        "move_border": {"part": 2, "offset": 0.1},
        "merge_parts": {"part": 2, "into": 0},
        "set_branch_level": {"part": 1, "level": 1},
        "paint_part": {"part": 1},
        "remove_correction": {"index": 0},
        "clear_corrections": {},
        "copy_report": {},
        "select_part": {"part": 1},
    }.items():
        press(operator, **options)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    draw_panels()


def take_a_copy(obj, template):
    """Put an undamaged mesh in place of the object's."""
    used = obj.data
    obj.data = template.copy()
    if used.users == 0:
        bpy.data.meshes.remove(used)
    bpy.context.view_layer.objects.active = obj
    return obj.data


def hurt(mesh, place, kind):
    if isinstance(place, str):
        damage_attribute(mesh, place, kind)
    else:
        damage(mesh, place, kind)


def all_damages(mesh):
    return damages_of(mesh) + [(name, kind) for name in own_attributes(mesh) for kind in ATTRIBUTE_DAMAGES]


@pytest.mark.parametrize("draw", draws(4))
@pytest.mark.parametrize("situation", ["divided", "corrected", "registered", "apart"])
def test_whatever_is_damaged_everything_quick_works_or_refuses(request, situation, tracebacks, draw):
    obj = request.getfixturevalue(situation)
    template = obj.data.copy()

    @seed(draw)
    @DAMAGED
    @given(st.lists(st.sampled_from(all_damages(template)), min_size=1, max_size=2, unique_by=lambda one: one[0]))
    def check(damages):
        mesh = take_a_copy(obj, template)
        for place, kind in damages:
            try:
                hurt(mesh, place, kind)
            except (KeyError, TypeError):
                # The first damage took away what the second was to hurt.
                continue
        use_everything_that_reads(mesh)

    check()


@pytest.mark.parametrize("draw", draws(4))
@pytest.mark.parametrize("method", ["INSERT", "EXISTING"])
def test_whatever_is_damaged_a_cut_works_or_refuses(corrected, method, tracebacks, draw):
    template = corrected.data.copy()

    @seed(draw)
    @DAMAGED
    @given(st.sampled_from(all_damages(template)))
    def check(one):
        mesh = take_a_copy(corrected, template)
        hurt(mesh, *one)
        press("cut", method=method)
        assert not mesh.validate()

    check()


@pytest.mark.parametrize("draw", draws(4))
def test_whatever_is_damaged_parts_are_separated_or_left(divided, tracebacks, draw):
    template = divided.data.copy()

    @seed(draw)
    @DAMAGED
    @given(st.sampled_from(all_damages(template)))
    def check(one):
        hurt(take_a_copy(divided, template), *one)
        press("separate")
        for obj in set(bpy.data.objects) - {divided}:
            bpy.data.objects.remove(obj)

    check()


@pytest.mark.parametrize(
    ("operator", "options"),
    [
        ("flip_function", {"number": 1}),
        ("next_alternative", {}),
        ("transfer", {"layers": {"GROUPS", "PARTS", "FACES"}}),
        ("create_armature", {"order": "1"}),
        ("create_skeleton_curves", {"order": "1"}),
    ],
)
@pytest.mark.parametrize("draw", draws(2))
def test_whatever_is_damaged_longer_work_is_done_or_refused(registered, operator, options, tracebacks, draw):
    template = registered.data.copy()
    told = [one for one in all_damages(template) if one[0][1:2] in (("registration",), ("part_names",), ("parts",))]

    @seed(draw)
    @settings(DAMAGED, max_examples=4)
    @given(st.sampled_from(told))
    def check(one):
        hurt(take_a_copy(registered, template), *one)
        before = set(bpy.data.objects)
        press(operator, **options)
        for obj in set(bpy.data.objects) - before:
            bpy.data.objects.remove(obj)

    check()


@pytest.mark.parametrize("draw", draws(3))
def test_a_new_analysis_heals_any_damage(divided, tracebacks, draw):
    template = divided.data.copy()

    @seed(draw)
    @settings(DAMAGED, max_examples=8)
    @given(st.sampled_from(damages_of(template)))
    def check(one):
        mesh = take_a_copy(divided, template)
        hurt(mesh, *one)
        bpy.ops.eigenparts.analyze(order="1")
        assert bpy.ops.eigenparts.segment(level=2) == {"FINISHED"}

    check()


LISTS = {
    "gone": None,
    "no text": 7,
    "empty": "",
    "others": "heat\nposition\nUVMap",
    "cut short": "eigenparts_branch\n.eigenparts_arc\npar",
}


@pytest.mark.parametrize("listed", LISTS)
@pytest.mark.parametrize(
    ("operator", "options"),
    [
        ("analyze", {"order": "1"}),
        ("segment", {"level": 2}),
        ("write_outputs", {"outputs": OUTPUTS}),
        ("cut", {}),
        ("merge_parts", {"part": 4, "into": 0}),
    ],
)
def test_what_is_ours_is_known_again_without_the_list_of_it(corrected, listed, operator, options):
    mesh = corrected.data
    before = set(mesh["eigenparts_attributes"].split("\n"))
    corrected.data.attributes.new("heat", "FLOAT", "POINT")
    del mesh["eigenparts_attributes"]
    if LISTS[listed] is not None:
        mesh["eigenparts_attributes"] = LISTS[listed]
    getattr(bpy.ops.eigenparts, operator)(**options)
    assert set(own_attributes(mesh)) - {"heat", "position"} <= before
    draw_panels()
    bpy.ops.eigenparts.clear()
    assert not [name for name in mesh.attributes.keys() if "eigenparts" in name or name.startswith("part")]  # noqa: SIM118
    assert "heat" in mesh.attributes


@pytest.mark.parametrize("name", ["part_color", ".sculpt_face_set"])
def test_an_output_that_was_not_chosen_is_never_taken_for_ours(small_star, name):
    obj = add_object(small_star.vertices, small_star.triangles)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_ATTRIBUTE"})
    kind = ("FLOAT_COLOR", "CORNER") if name == "part_color" else ("INT", "FACE")
    obj.data.attributes.new(name, *kind)
    del obj.data["eigenparts_attributes"]
    bpy.ops.eigenparts.segment(level=1)
    bpy.ops.eigenparts.clear()
    assert name in obj.data.attributes


def test_a_part_attribute_with_absurd_labels_is_refused(divided):
    for kind in ("huge", "negative"):
        damage_attribute(divided.data, "part", kind)
        before = everything_on(divided.data)
        for operator in ("write_outputs", "separate"):
            with pytest.raises(RuntimeError, match="damaged"):
                getattr(bpy.ops.eigenparts, operator)()
        assert everything_on(divided.data) == before


def test_a_shape_larger_than_its_numbers_allocates_nothing(divided):
    divided.data[STATE]["branches_0"]["area"]["shape"] = [2**31 - 1, 2**31 - 1]
    with pytest.raises(RuntimeError, match="damaged"):
        bpy.ops.eigenparts.segment(level=1)


FORBIDDEN_CALLS = {"eval", "exec", "compile", "__import__", "execfile"}
FORBIDDEN_MODULES = {"pickle", "marshal", "shelve", "dill", "subprocess", "socket", "urllib", "http", "requests"}


# What Blender and its worker process send each other, and keep in their own folder; a .blend reaches none of it.
OF_THE_WORKER = {
    ("jobs", "worker_process.py"),
    *(("tasks", f"{name}.py") for name in ("parcels", "processes", "recent_results", "worker_loop", "worker_start")),
}


@pytest.mark.parametrize("folder", ["operators", "ui", "tasks", "compute"])
def test_nothing_read_from_a_file_can_be_run(folder):
    """No code that a .blend reaches evaluates text, unpickles, starts programs or opens connections."""
    paths = (ROOT / folder).rglob("*.py")
    trees = [ast.parse(path.read_text()) for path in paths if (path.parent.name, path.name) not in OF_THE_WORKER]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    called = {node.func.id for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    modules = {alias.name.split(".")[0] for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    modules |= {(node.module or "").split(".")[0] for node in nodes if isinstance(node, ast.ImportFrom)}
    assert len(trees) > 10
    assert not called & FORBIDDEN_CALLS
    assert not modules & FORBIDDEN_MODULES


def test_a_hostile_file_touches_no_other_file(corrected, tmp_path):
    """Opening, drawing and dividing with text for code and paths in the state opens no file but the .blend."""
    state = corrected.data[STATE]
    state["description"] = state["mode"] = "__import__('os').abort()"
    state["part_names"] = {"1": "/etc/passwd", "2": "//../secret.txt"}
    path = str(tmp_path / "hostile.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    opened, watching = [], True
    sys.addaudithook(lambda event, values: opened.append(values[0]) if watching and event == "open" else None)
    draw_panels()
    bpy.ops.eigenparts.segment(level=2)
    draw_panels()
    watching = False
    assert [name for name in opened if not str(name).endswith((".py", ".pyc"))] == []
