"""Registration: the same number, name and colour on the same part of every pose."""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from examples import hand, humanoid
from tests.blender.conftest import add_object, everything_on, values_of
from tests.compute.registration.shapes import lumpy_ball


@pytest.fixture(scope="session")
def character():
    return hand(1500)


def add_pose(character, pose, seed=None):
    """Add the hand in a pose; with a seed, its vertices and faces in random order."""
    vertices, quads = character.mesh_in_pose(pose), character.quads
    faces = np.arange(len(quads))
    if seed is not None:
        random = np.random.default_rng(seed)
        order, faces = random.permutation(len(vertices)), random.permutation(len(quads))
        vertices, quads = vertices[order], np.argsort(order)[quads][faces]
    obj = add_object(vertices, quads, pose)
    obj["faces"] = faces.tolist()
    return obj


@pytest.fixture
def rest(scene, character):
    """The reference: active, analyzed and divided."""
    return scene(analyzed_hand_and_fist, character)


@pytest.fixture
def fist(rest):
    """A fist to register, its mesh shuffled so that nothing corresponds by number."""
    return bpy.data.objects["fist"]


def analyzed_hand_and_fist(character):
    add_pose(character, "fist", seed=0)
    add_pose(character, "rest")
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}


@pytest.fixture(scope="module")
def registered_file(character, extension, tmp_path_factory):
    """A file with a fist registered to a hand at rest, of which one part has a name and a colour of its own."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    extension.register()
    add_pose(character, "fist", seed=0)
    rest = add_pose(character, "rest")
    bpy.ops.eigenparts.analyze()
    labels = values_of(rest.data, "part")
    rows = {row.part: row for row in rest.data.eigenparts.rows}
    rows[1].title, rows[1].color = "First", (0.25, 0.5, 0.75)
    bpy.ops.eigenparts.register_selected()
    np.testing.assert_array_equal(values_of(rest.data, "part"), labels)
    path = str(tmp_path_factory.mktemp("registered") / "hands.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    extension.unregister()
    return path


@pytest.fixture
def registered(registered_file, fresh_scene):
    """The two hands, registered; the reference is active."""
    bpy.ops.wm.open_mainfile(filepath=registered_file)
    return bpy.data.objects["rest"], bpy.data.objects["fist"]


def titles(obj):
    return {row.part: row.title for row in obj.data.eigenparts.rows}


def agreement(reference, target):
    """Return the share of the target's area that has the number of the same face of the reference."""
    expected = values_of(reference.data, "part")[np.array(target["faces"])]
    areas = np.array([polygon.area for polygon in target.data.polygons])
    return areas[values_of(target.data, "part") == expected].sum() / areas.sum()


def registration_of(obj):
    from eigenparts.operators.mesh_state.state import read

    return read(obj.data).match


def test_every_part_has_the_number_of_the_reference(registered):
    rest, fist = registered
    assert len(np.unique(values_of(rest.data, "part"))) >= 6
    assert agreement(rest, fist) > 0.93


def test_a_scale_that_mirrors_a_hand_makes_the_other_hand_of_it(rest, fist):
    fist.scale.x = -1
    bpy.ops.eigenparts.register_selected(mirrored=True)
    assert registration_of(fist).mirrored
    assert agreement(rest, fist) > 0.93


def test_every_part_has_the_name_and_the_colour_of_the_reference(registered):
    rest, fist = registered
    assert titles(fist) == titles(rest)
    assert titles(fist)[1] == "First"
    colours = values_of(fist.data, "part_color", 4, np.float32, "color").reshape(-1, 4, 4)[:, 0]
    shown = np.unique(colours[values_of(fist.data, "part") == 1], axis=0)
    np.testing.assert_allclose(shown, [[0.25, 0.5, 0.75, 1.0]])


def test_vertices_follow_their_faces(registered):
    _, fist = registered
    assert set(values_of(fist.data, "part_vertex")) == set(values_of(fist.data, "part"))


def test_it_is_told_which_functions_were_matched(registered):
    rest, fist = registered
    match = registration_of(fist)
    assert match.reference == rest.name
    assert match.confidence > 0.5
    assert len(set(match.order)) == len(match.signs) == 8
    assert set(match.signs) <= {-1, 1}
    assert len(match.by_diagrams) == 6
    # Each hand is its own left or right, so most signs show in the diagrams, and most are those that were found.
    told = [(abs(number), number > 0) for number in match.by_diagrams]
    found = [(place, sign > 0) for place, sign in zip(match.order, match.signs, strict=True)]
    assert sum(one == other for one, other in zip(told, found, strict=False)) >= 3
    assert registration_of(rest) is None


def test_a_match_that_the_others_contradict_is_told(rest, character, monkeypatch, capfd):
    add_pose(character, "point", seed=1)
    bpy.data.objects["fist"].select_set(True)
    bpy.context.view_layer.objects.active = rest
    rest.select_set(True)

    def agreed(reference, targets, matchings, match_pairs, progress):
        return [replace(matching, confidence=0.4, is_consistent=matching is matchings[0]) for matching in matchings]

    from eigenparts import compute

    monkeypatch.setattr(compute, "agreed_matchings", agreed, raising=False)
    assert bpy.ops.eigenparts.register_selected() == {"FINISHED"}
    told = capfd.readouterr().out
    assert told.count("contradicts those of the other shapes") == 1
    assert registration_of(bpy.data.objects["point"]).confidence == 0.4


def test_moving_the_level_brings_own_parts_and_names_back(registered):
    _, fist = registered
    fist.data.eigenparts.level = 5
    assert titles(fist)[1] == "Part 1"
    assert registration_of(fist) is None


def test_an_analysis_brings_own_parts_and_names_back(registered):
    _, fist = registered
    bpy.context.view_layer.objects.active = fist
    bpy.ops.eigenparts.analyze()
    assert titles(fist)[1] == "Part 1"
    assert registration_of(fist) is None


def test_the_level_of_the_reference_decides(rest, fist):
    bpy.ops.eigenparts.segment(level=2, mode="FEATURES")
    labels = values_of(rest.data, "part")
    bpy.ops.eigenparts.register_selected()
    np.testing.assert_array_equal(values_of(rest.data, "part"), labels)
    assert (rest.data.eigenparts.level, rest.data.eigenparts.mode) == (2, "FEATURES")
    assert agreement(rest, fist) > 0.93


def test_joints_of_the_reference_are_on_every_pose(fresh_scene):
    """They are carried over, wherever the limbs of the others narrow."""
    character = humanoid(6000)
    add_pose(character, "walk", seed=0)
    rest = add_pose(character, "rest")
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.segment(joints=True)
    bpy.ops.eigenparts.register_selected()
    walk = bpy.data.objects["walk"]
    np.testing.assert_array_equal(np.unique(values_of(walk.data, "part")), np.unique(values_of(rest.data, "part")))
    assert agreement(rest, walk) > 0.95


def test_a_mirrored_mesh_is_registered_as_told(rest, fist):
    fist.data.transform([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    fist.data.flip_normals()
    bpy.ops.eigenparts.register_selected(mirrored=True)
    assert agreement(rest, fist) > 0.93
    assert registration_of(fist).mirrored


def test_a_function_can_be_flipped(registered):
    rest, fist = registered
    first = registration_of(fist)
    bpy.ops.eigenparts.flip_function(object_name=fist.name, number=2)
    flipped = registration_of(fist)
    assert flipped.signs[1] == -first.signs[1]
    assert flipped.flips == {"2": flipped.signs[1]}
    assert flipped.confidence < first.confidence
    assert agreement(rest, fist) < 0.9


def test_the_next_alternative_is_another_matching(registered):
    _, fist = registered
    first = registration_of(fist)
    bpy.context.view_layer.objects.active = fist
    bpy.ops.eigenparts.next_alternative()
    second = registration_of(fist)
    assert (second.alternative, second.n_alternatives) == (1, first.n_alternatives)
    assert (second.order, second.signs) != (first.order, first.signs)
    assert second.confidence < first.confidence


def test_nothing_to_register_is_told(rest, fist):
    fist.select_set(False)
    with pytest.raises(RuntimeError, match="Select the meshes to register"):
        bpy.ops.eigenparts.register_selected()


def test_an_object_that_was_not_registered_cannot_be_flipped(rest):
    with pytest.raises(RuntimeError, match="not registered"):
        bpy.ops.eigenparts.flip_function(number=1)


def test_a_reference_has_parts_of_its_own(registered):
    _, fist = registered
    bpy.context.view_layer.objects.active = fist
    with pytest.raises(RuntimeError, match="fist shows the parts of rest"):
        bpy.ops.eigenparts.register_selected()


def test_edit_mode_is_refused(rest, fist):
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Leave edit mode"):
        bpy.ops.eigenparts.register_selected()


def test_an_attribute_of_the_user_is_never_overwritten(rest, fist):
    fist.data.attributes.new("part", "FLOAT", "POINT")
    before = everything_on(rest.data), everything_on(fist.data)
    with pytest.raises(RuntimeError, match=r'fist: .*attribute "part" that is not from Eigenparts'):
        bpy.ops.eigenparts.register_selected()
    assert (everything_on(rest.data), everything_on(fist.data)) == before


def test_a_mesh_that_cannot_be_analyzed_is_named_and_nothing_changes(rest, fist):
    add_object([], [], "hollow")
    bpy.context.view_layer.objects.active = rest
    before = everything_on(fist.data)
    with pytest.raises(RuntimeError, match=r"hollow: .*no faces"):
        bpy.ops.eigenparts.register_selected()
    assert everything_on(fist.data) == before


def test_borders_of_another_are_not_cut(registered):
    _, fist = registered
    bpy.context.view_layer.objects.active = fist
    with pytest.raises(RuntimeError, match="parts of another object"):
        bpy.ops.eigenparts.cut()


@pytest.fixture
def balls():
    """Two lumpy balls with the same faces, the second one active."""
    ball = lumpy_ball(2)
    return [add_object(ball.vertices * scale, ball.triangles, name) for name, scale in (("large", 2), ("small", 1))]


def test_meshes_with_the_same_faces_correspond_by_number(balls):
    bpy.ops.eigenparts.register_selected()
    match = registration_of(balls[0])
    assert match.same_topology
    assert match.confidence == 1
    assert match.n_alternatives == 0
    with pytest.raises(RuntimeError, match="no other matching"):
        bpy.ops.eigenparts.next_alternative(object_name="large")


def test_what_is_the_users_is_left_alone(balls):
    mesh = balls[0].data
    mesh.attributes.new("mine", "INT", "FACE").data.foreach_set("value", np.arange(len(mesh.polygons)))
    mesh["my property"] = 3
    before = everything_on(mesh)
    bpy.ops.eigenparts.register_selected()
    np.testing.assert_array_equal(values_of(mesh, "mine"), np.arange(len(mesh.polygons)))
    with bpy.context.temp_override(object=balls[0], active_object=balls[0]):
        bpy.ops.eigenparts.clear()
    assert everything_on(mesh) == before


def test_one_undo_takes_everything_back(balls):
    window = bpy.context.window_manager.windows[0]
    before = everything_on(balls[0].data)
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.eigenparts.register_selected()
        assert everything_on(balls[0].data) != before
        bpy.ops.ed.undo_push(message="registered")
        bpy.ops.ed.undo()
    assert everything_on(bpy.data.objects["large"].data) == before


def test_every_sign_that_is_shown_can_be_flipped_without_a_new_analysis(registered, monkeypatch):
    """The hand has no symmetry, so no flipped matching fits; it is shown all the same, as not sure."""
    from eigenparts import compute as engine

    _, fist = registered
    bpy.ops.eigenparts.flip_function(object_name=fist.name, number=1)
    monkeypatch.setattr(engine, "analyze", None, raising=False)
    for number in (3, 5):
        before = registration_of(fist)
        bpy.ops.eigenparts.flip_function(object_name=fist.name, number=number)
        flipped = registration_of(fist)
        assert flipped.signs[number - 1] == -before.signs[number - 1]
        assert flipped.confidence < 0.5
    assert set(flipped.flips) == {"1", "3", "5"}


def test_alternatives_need_no_new_analysis(registered, monkeypatch):
    from eigenparts import compute as engine

    _, fist = registered
    bpy.ops.eigenparts.next_alternative(object_name=fist.name)
    monkeypatch.setattr(engine, "analyze", None, raising=False)
    shown = [registration_of(fist)]
    for _ in range(shown[0].n_alternatives):
        bpy.ops.eigenparts.next_alternative(object_name=fist.name)
        shown.append(registration_of(fist))
    assert [match.alternative for match in shown] == [*range(1, shown[0].n_alternatives + 1), 0]


def test_a_reference_is_found_again_under_another_name(registered):
    rest, fist = registered
    rest.name = "renamed"
    assert registration_of(fist).reference == "renamed"
    bpy.ops.eigenparts.next_alternative(object_name=fist.name)
    assert registration_of(fist).alternative == 1


def test_a_reference_that_is_gone_is_told(registered):
    rest, fist = registered
    bpy.data.objects.remove(rest)
    bpy.context.view_layer.objects.active = fist
    with pytest.raises(RuntimeError, match=r'no mesh object "rest" here'):
        bpy.ops.eigenparts.flip_function(number=1)


def test_a_job_that_is_cancelled_changes_nothing(rest, fist):
    """Cancelled as the window does it: at a report of progress while the pair is matched."""
    from eigenparts import compute as engine
    from eigenparts.operators.parts.analysis_settings import AnalysisSettings
    from eigenparts.operators.registration.registration_operator import RegistrationOperator
    from eigenparts.tasks.match_options import MatchOptions

    def cancel(fraction, text):
        if "order and signs" in text:
            raise engine.Cancelled

    before = everything_on(fist.data)
    options, settings = MatchOptions(mirrored=True), AnalysisSettings()
    work, _ = RegistrationOperator.start(None, bpy.context, rest, [fist], options, settings)
    with pytest.raises(engine.Cancelled):
        work(cancel)
    assert everything_on(fist.data) == before


def test_parts_that_were_corrected_by_hand_are_registered_too(rest, fist):
    tip = values_of(rest.data, "part") == 1
    height = np.array([polygon.center.z for polygon in rest.data.polygons])
    painted = tip & (height > np.median(height[tip]))
    rest.data.polygons.foreach_set("select", painted)
    bpy.ops.eigenparts.paint_part(new=True)
    labels = values_of(rest.data, "part")
    assert len(np.unique(labels[painted])) == 1
    bpy.ops.eigenparts.register_selected()
    np.testing.assert_array_equal(values_of(rest.data, "part"), labels)
    assert set(values_of(fist.data, "part")) == set(labels)
    assert agreement(rest, fist) > 0.93


def cut(rest):
    bpy.ops.eigenparts.cut()


def edit(rest):
    rest.data.vertices[0].co.z += 1e-3


@pytest.mark.parametrize("change", [cut, edit])
def test_corrections_of_another_analysis_are_not_kept_for_the_reference_alone(rest, fist, change):
    bpy.ops.eigenparts.split_part(part=1)
    change(rest)
    with pytest.raises(RuntimeError, match="analyze it with these settings first"):
        bpy.ops.eigenparts.register_selected()
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.register_selected()
    assert set(values_of(fist.data, "part")) == set(values_of(rest.data, "part"))
