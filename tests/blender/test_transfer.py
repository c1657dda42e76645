"""Transfer: what is on one pose of a character, on another pose with other triangles."""

import bpy
import numpy as np
import pytest

from examples import hand
from tests.blender.conftest import add_object, values_of
from tests.compute.registration.shapes import lumpy_ball


def add_copy(name, seed, bend=0.0):
    """Add the lumpy ball, bent, with its vertices and faces in random order."""
    ball = lumpy_ball(2)
    random = np.random.default_rng(seed)
    order, faces = random.permutation(len(ball.vertices)), random.permutation(len(ball.triangles))
    vertices = ball.vertices + bend * np.sin(ball.vertices[:, [1, 2, 0]])
    obj = add_object(vertices[order], np.argsort(order)[ball.triangles][faces], name)
    obj["order"], obj["faces"] = order.tolist(), faces.tolist()
    return obj


@pytest.fixture
def bent():
    """The target: another pose, shuffled, so that nothing corresponds by number."""
    return add_copy("bent", seed=0, bend=0.1)


@pytest.fixture
def rest(bent):
    """The source, active, with something of every kind."""
    ball = lumpy_ball(2)
    obj = add_object(ball.vertices, ball.triangles, "rest")
    mesh, n = obj.data, len(obj.data.vertices)
    heights = mesh_positions(mesh)[:, 2]
    share = (heights - heights.min()) / np.ptp(heights)
    upper, lower = obj.vertex_groups.new(name="Upper"), obj.vertex_groups.new(name="Lower")
    for vertex, weight in enumerate(share.tolist()):
        upper.add([vertex], weight, "REPLACE")
        lower.add([vertex], 1 - weight, "REPLACE")
    mesh.attributes.new("number", "INT", "POINT").data.foreach_set("value", np.arange(n, dtype=np.int32))
    mesh.attributes.new("height", "FLOAT", "POINT").data.foreach_set("value", np.float32(heights))
    mesh.attributes.new("face", "INT", "FACE").data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.int32))
    mesh.color_attributes.new("paint", "FLOAT_COLOR", "POINT").data.foreach_set(
        "color", np.float32(np.repeat(share, 4))
    )
    return obj


def mesh_positions(mesh):
    return values_of(mesh, "position", 3, np.float32, "vector")


def weights_of(obj, name):
    index = obj.vertex_groups[name].index
    return np.array([sum(g.weight for g in v.groups if g.group == index) for v in obj.data.vertices])


def add_lumpy(n_subdivisions, name, scale=1.0):
    ball = lumpy_ball(n_subdivisions)
    return add_object(ball.vertices * scale, ball.triangles, name)


@pytest.fixture
def balls():
    """The same surface in two resolutions: the fine one is the target, the coarse one the source and active."""
    return add_lumpy(3, "fine", 2.0), add_lumpy(2, "coarse")


def test_weights_go_to_the_same_vertices_under_other_numbers(rest, bent):
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    order = np.array(bent["order"])
    for name in ("Upper", "Lower"):
        np.testing.assert_allclose(weights_of(bent, name), weights_of(rest, name)[order], atol=1e-4)


def test_the_group_that_is_active_on_the_target_stays_active(rest, bent):
    bent.vertex_groups.new(name="mine")
    bpy.ops.eigenparts.transfer()
    assert [group.name for group in bent.vertex_groups] == ["mine", "Upper", "Lower"]
    assert bent.vertex_groups.active.name == "mine"


def test_poses_with_the_same_faces_correspond_by_number():
    """Also where Blender splits a quad one way in one pose and the other way in the other."""
    character = hand(800)
    bent, rest = (add_object(character.mesh_in_pose(pose), character.quads, pose) for pose in ("fist", "rest"))
    numbers = np.arange(len(character.quads), dtype=np.int32)
    rest.data.attributes.new("face", "INT", "FACE").data.foreach_set("value", numbers)
    rest.vertex_groups.new(name="Odd").add(list(range(1, len(rest.data.vertices), 2)), 0.5, "REPLACE")
    bpy.ops.eigenparts.transfer(layers={"GROUPS", "FACES"})
    np.testing.assert_array_equal(values_of(bent.data, "face"), numbers)
    np.testing.assert_array_equal(weights_of(bent, "Odd"), weights_of(rest, "Odd"))


def test_weights_of_each_vertex_have_the_sum_they_had(balls):
    fine, coarse = balls
    height = mesh_positions(coarse.data)[:, 2]
    share = (height - height.min()) / np.ptp(height)
    for name, column in (("a", share), ("b", 1 - share)):
        group = coarse.vertex_groups.new(name=name)
        for vertex, weight in enumerate(column.tolist()):
            group.add([vertex], weight, "REPLACE")
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    np.testing.assert_allclose(weights_of(fine, "a") + weights_of(fine, "b"), 1, atol=2e-4)


def test_a_linear_attribute_is_its_value_at_the_place(balls):
    fine, coarse = balls
    positions = mesh_positions(coarse.data)
    coarse.data.attributes.new("place", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", positions.ravel())
    bpy.ops.eigenparts.transfer(layers={"ATTRIBUTES"}, unsure="TAKE")
    found = values_of(fine.data, "place", 3, np.float32, "vector")
    away = np.linalg.norm(2 * found - mesh_positions(fine.data), axis=1)
    assert np.median(away) < 0.1
    assert away.max() < 0.5


def test_attributes_of_every_kind_come_along(rest, bent):
    bpy.ops.eigenparts.transfer(layers={"ATTRIBUTES", "FACES", "COLORS"})
    order, faces = np.array(bent["order"]), np.array(bent["faces"])
    np.testing.assert_array_equal(values_of(bent.data, "number"), order)
    np.testing.assert_array_equal(values_of(bent.data, "face"), faces)
    paint = [values_of(obj.data, "paint", 4, np.float32, "color") for obj in (rest, bent)]
    np.testing.assert_allclose(paint[1], paint[0][order], atol=1e-5)


def test_the_source_stays_as_it_is(rest, bent):
    names, weights = sorted(attribute.name for attribute in rest.data.attributes), weights_of(rest, "Upper")
    bpy.ops.eigenparts.transfer(layers={"GROUPS", "ATTRIBUTES", "FACES", "COLORS"})
    assert sorted(attribute.name for attribute in rest.data.attributes) == names
    np.testing.assert_array_equal(weights_of(rest, "Upper"), weights)
    assert rest.data.get("eigenparts") is None


def test_uv_maps_keep_their_seams(balls):
    """Each face of the fine ball lies within one of the two halves of the map, never across the seam."""
    fine, coarse = balls
    uv = coarse.data.uv_layers.new(name="Map")
    corner = values_of(coarse.data, ".corner_vert")
    middle = mesh_positions(coarse.data)[corner].reshape(-1, 3, 3).mean(axis=1)
    half = np.repeat(middle[:, 0] > 0, 3)
    places = mesh_positions(coarse.data)[corner][:, 1:]
    uv.uv.foreach_set("vector", np.float32(places + 100 * half[:, None]).ravel())
    bpy.ops.eigenparts.transfer(layers={"UVS"})
    found = values_of(fine.data, "Map", 2, np.float32, "vector").reshape(-1, 3, 2)
    assert np.ptp(found, axis=1).max() < 5
    assert (np.ptp(found.reshape(-1, 2), axis=0) > 90).all()


def test_shape_keys_are_turned_with_the_surface(balls):
    fine, coarse = balls
    positions = mesh_positions(fine.data)[:, [1, 0, 2]] * np.float32([-1, 1, 1])
    fine.data.attributes["position"].data.foreach_set("vector", positions.ravel())
    fine.data.update()
    for obj in (fine, coarse):
        obj.shape_key_add(name="Basis")
    key = coarse.shape_key_add(name="Push")
    positions = mesh_positions(coarse.data)
    key.data.foreach_set("co", np.float32(positions + np.array([0.25, 0, 0])).ravel())
    bpy.ops.eigenparts.transfer(layers={"SHAPE_KEYS"}, unsure="TAKE")
    block = fine.data.shape_keys.key_blocks["Push"]
    moved = np.empty(3 * len(fine.data.vertices), dtype=np.float32)
    block.data.foreach_get("co", moved)
    delta = moved.reshape(-1, 3) - mesh_positions(fine.data)
    np.testing.assert_allclose(np.median(delta, axis=0), [0, 0.5, 0], atol=0.05)


def test_materials_of_parts_are_not_taken_for_those_of_the_user(rest, bent):
    rest.data.materials.append(bpy.data.materials.new("Skin"))
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.write_outputs(outputs={"MATERIALS"})
    assert len(rest.data.materials) > 1
    bpy.ops.eigenparts.transfer(layers={"MATERIALS"})
    assert [material.name for material in bent.data.materials] == ["Skin"]
    assert set(values_of(bent.data, "material_index")) == {0}


def test_a_shape_key_that_starts_from_another_is_written_from_there(rest, bent):
    """What a key moves is the way from the key that it is relative to."""
    for obj, names in ((rest, ["Basis", "Push"]), (bent, ["Basis", "Twist", "Push"])):
        for name in names:
            obj.shape_key_add(name=name)
    keys = bent.data.shape_keys.key_blocks
    keys["Push"].relative_key = keys["Twist"]
    keys["Twist"].data.foreach_set("co", np.float32(mesh_positions(bent.data) + np.array([0, 0, 3])).ravel())
    bpy.ops.eigenparts.transfer(layers={"SHAPE_KEYS"})
    moved = [np.array([point.co for point in keys[name].data]) for name in ("Twist", "Push")]
    np.testing.assert_allclose(moved[1], moved[0], atol=1e-5)


def test_attributes_of_ours_are_not_taken_for_those_of_the_user(rest, bent):
    bpy.context.view_layer.objects.active = bent
    bpy.ops.eigenparts.analyze()
    labels = values_of(bent.data, "part")
    bpy.context.view_layer.objects.active = rest
    rest.data.attributes.new("part", "INT", "FACE")
    with pytest.raises(RuntimeError, match="is from Eigenparts"):
        bpy.ops.eigenparts.transfer(layers={"FACES"})
    np.testing.assert_array_equal(values_of(bent.data, "part"), labels)


def test_materials_and_parts_come_along(rest, bent):
    for name in ("Skin", "Glove"):
        rest.data.materials.append(bpy.data.materials.new(name))
    bent.data.materials.append(bpy.data.materials["Glove"])
    index = (np.arange(len(rest.data.polygons)) % 2).astype(np.int32)
    rest.data.polygons.foreach_set("material_index", index)
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.transfer(layers={"MATERIALS", "PARTS"})
    faces = np.array(bent["faces"])
    names = np.array([material.name for material in bent.data.materials])
    assert sorted(names) == ["Glove", "Skin"]
    expected = np.array(["Skin", "Glove"])[index][faces]
    np.testing.assert_array_equal(names[values_of(bent.data, "material_index")], expected)
    np.testing.assert_array_equal(values_of(bent.data, "part"), values_of(rest.data, "part")[faces])


def test_a_mask_and_a_factor_limit_what_changes(rest, bent):
    height = bent.data.attributes.new("height", "FLOAT", "POINT")
    height.data.foreach_set("value", np.full(len(bent.data.vertices), 7, dtype=np.float32))
    mask = bent.vertex_groups.new(name="Here")
    mask.add([0, 1, 2], 1.0, "REPLACE")
    bpy.ops.eigenparts.transfer(layers={"ATTRIBUTES"}, factor=0.5, mask="Here")
    found, source = values_of(bent.data, "height", 1, np.float32), values_of(rest.data, "height", 1, np.float32)
    assert (found[3:] == 7).all()
    np.testing.assert_allclose(found[:3], (7 + source[np.array(bent["order"])[:3]]) / 2, rtol=1e-5)


def test_a_mirrored_mesh_gets_swapped_names(rest, bent):
    bent.data.transform([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    bent.data.flip_normals()
    rest.vertex_groups["Upper"].name = "Upper.L"
    bpy.ops.eigenparts.transfer(layers={"GROUPS"}, mirrored=True)
    assert "Upper.L" not in bent.vertex_groups
    expected = weights_of(rest, "Upper.L")[np.array(bent["order"])]
    assert np.abs(weights_of(bent, "Upper.R") - expected).mean() < 0.02


def test_named_groups_only(rest, bent):
    bpy.ops.eigenparts.transfer(layers={"GROUPS"}, groups="NAMED", group_names="Lower")
    assert [group.name for group in bent.vertex_groups] == ["Lower"]


def test_groups_of_deform_bones_only(rest, bent):
    armature = bpy.data.armatures.new("rig")
    rig = bpy.data.objects.new("rig", armature)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, deforms in (("Upper", True), ("Lower", False)):
        bone = armature.edit_bones.new(name)
        bone.tail, bone.use_deform = (0, 0, 1), deforms
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = rest
    rest.modifiers.new("rig", "ARMATURE").object = rig
    rig.select_set(False)
    bpy.ops.eigenparts.transfer(layers={"GROUPS"}, groups="DEFORM")
    assert [group.name for group in bent.vertex_groups] == ["Upper"]


def test_several_targets_at_once(rest, bent):
    other = add_copy("other", seed=3, bend=0.05)
    bpy.context.view_layer.objects.active = rest
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    for obj in (bent, other):
        np.testing.assert_allclose(
            weights_of(obj, "Upper"), weights_of(rest, "Upper")[np.array(obj["order"])], atol=1e-4
        )


def test_unsure_vertices_are_selected(rest, bent):
    bent.data.vertices.foreach_set("select", np.ones(len(bent.data.vertices), dtype=bool))
    bpy.ops.eigenparts.transfer(layers={"GROUPS"}, selects_unsure=True)
    assert not any(vertex.select for vertex in bent.data.vertices)


def test_one_undo_takes_everything_back(rest, bent):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.eigenparts.transfer(layers={"GROUPS", "FACES"})
        assert bent.vertex_groups
        bpy.ops.ed.undo_push(message="transferred")
        bpy.ops.ed.undo()
    bent = bpy.data.objects["bent"]
    assert not bent.vertex_groups
    assert "face" not in bent.data.attributes


def refused(match, **options):
    """Whether nothing was written, and the sentence says why."""
    targets = [obj for obj in bpy.context.selected_objects if obj != bpy.context.object]
    before = [state_of(obj) for obj in targets]
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.eigenparts.transfer(**options)
    assert [state_of(obj) for obj in targets] == before


def state_of(obj):
    return (
        [(group.name, weights_of(obj, group.name).tobytes()) for group in obj.vertex_groups],
        sorted((attribute.name, attribute.domain) for attribute in obj.data.attributes),
        obj.data.shape_keys is None,
        len(obj.data.materials),
    )


def test_a_locked_group_is_refused(rest, bent):
    bent.vertex_groups.new(name="Lower").lock_weight = True
    refused(r'bent: The vertex group "Lower" is locked', layers={"GROUPS", "FACES"})


def test_an_attribute_of_another_kind_is_refused(rest, bent):
    bent.data.attributes.new("number", "FLOAT", "FACE")
    refused(r'bent: There is an attribute "number" of another kind', layers={"GROUPS", "ATTRIBUTES"})


def test_a_target_without_a_basis_is_refused(rest, bent):
    rest.shape_key_add(name="Basis")
    rest.shape_key_add(name="Push")
    refused("bent: The mesh has no Basis", layers={"GROUPS", "SHAPE_KEYS"})


def test_a_missing_mask_is_refused(rest, bent):
    refused('bent: There is no vertex group "Here"', layers={"GROUPS"}, mask="Here")


def test_nothing_to_transfer_is_refused(rest, bent):
    refused("rest has none of the layers", layers={"UVS"})
    refused("at least one layer", layers=set())


def test_deform_groups_without_an_armature_are_refused(rest, bent):
    refused("rest has no armature", layers={"GROUPS"}, groups="DEFORM")


def test_shapes_that_do_not_match_are_refused(rest, bent):
    ring = bpy.ops.mesh.primitive_torus_add(major_segments=40, minor_segments=20)
    assert ring == {"FINISHED"}
    bent.select_set(False)
    rest.select_set(True)
    bpy.context.view_layer.objects.active = rest
    refused("not alike enough", layers={"GROUPS"})


def test_linked_meshes_are_refused(rest, bent, tmp_path):
    path = str(tmp_path / "bent.blend")
    bpy.data.libraries.write(path, {bent})
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = ["bent"]
    linked = into.objects[0]
    bpy.context.collection.objects.link(linked)
    bent.select_set(False)
    linked.select_set(True)
    refused("linked from another file", layers={"GROUPS"})


def test_without_a_target_it_is_told(rest, bent):
    bent.select_set(False)
    with pytest.raises(RuntimeError, match="Select the meshes to transfer to"):
        bpy.ops.eigenparts.transfer()


def test_the_operator_and_the_panel_offer_the_layers_that_are_declared(extension):
    from eigenparts.operators.transfer.layer_choices import DEFAULT_LAYERS, LAYERS

    for layers in (
        bpy.ops.eigenparts.transfer.get_rna_type().properties["layers"],
        bpy.context.scene.eigenparts_transfer.bl_rna.properties["layers"],
    ):
        assert {item.identifier: (item.name, item.description) for item in layers.enum_items} == LAYERS
        assert layers.default_flag == set(DEFAULT_LAYERS)
