"""What passes through the command line in each format: the parts come to it, and nothing else is lost."""

import struct

import bpy
import numpy as np
import pytest

from tests.cli.files import add_object, write_blend
from tests.shapes import star

MARK = 1234.5
EXPORTERS = {
    ".obj": lambda path: bpy.ops.wm.obj_export(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_export(filepath=path),
    ".stl": lambda path: bpy.ops.wm.stl_export(filepath=path),
    ".glb": lambda path: bpy.ops.export_scene.gltf(
        filepath=path, export_extras=True, export_cameras=True, export_lights=True
    ),
    ".fbx": lambda path: bpy.ops.export_scene.fbx(
        filepath=path, add_leaf_bones=False, use_custom_props=True, path_mode="COPY", embed_textures=True
    ),
}
READERS = {
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".glb": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    ".fbx": lambda path: bpy.ops.import_scene.fbx(filepath=path),
}


def open_file(path):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    READERS[path.suffix](str(path))


def write(tmp_path, suffix, name="star"):
    path = tmp_path / f"{name}{suffix}"
    EXPORTERS[suffix](str(path))
    return path


def rows_of(report):
    return report["files"][0]["objects"]


def result_of(path):
    return path.with_name(f"{path.stem}_parts{path.suffix}")


def with_material(obj, name, colour, image=None):
    """Give an object one material more, with an image or a colour."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = colour
    if image:
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new(image, 4, 4)
        node.image.pack()
        material.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    obj.data.materials.append(material)


def images_of(material):
    return [node.image.name for node in material.node_tree.nodes if node.type == "TEX_IMAGE" and node.image]


def add_rig(name, actions):
    """Add an armature of two bones, in the actions of some names."""
    rig = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    root, arm = (rig.data.edit_bones.new(bone) for bone in ("root", "arm"))
    root.tail, arm.head, arm.tail, arm.parent = (0, 0, 1), (0, 0, 1), (1, 0, 1), root
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.animation_data_create()
    for number, action in enumerate(actions):
        rig.animation_data.action = bpy.data.actions.new(f"{action} of {name}")
        for frame in (1, 10 + 5 * number):
            rig.pose.bones["arm"].location.x = frame
            rig.pose.bones["arm"].keyframe_insert("location", frame=frame)
        rig.animation_data.nla_tracks.new().strips.new(action, 1, rig.animation_data.action).name = action
        rig.animation_data.action = None
    return rig


def actions_and_bones():
    actions = sorted((action.name, tuple(action.frame_range)) for action in bpy.data.actions)
    return actions, sorted(bone.name for armature in bpy.data.armatures for bone in armature.bones)


# Shapes of bones.


def add_bone_shape(mesh):
    shape = add_object(mesh, "a shape")
    add_rig("rig", ()).pose.bones["arm"].custom_shape = shape
    return shape


def test_the_shape_of_a_bone_is_no_mesh_of_the_file(run, tmp_path):
    add_object(star(5, 3))
    add_bone_shape(star(3, 3))
    path = write_blend(tmp_path / "rigged.blend")
    _, report, _ = run("register", path, "--source", path, "--json")
    assert [row["name"] for row in rows_of(report)] == ["star"]
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "rigged_parts.blend"))
    assert bpy.data.objects["a shape"].data.get("eigenparts_state") is None


def test_shapes_of_bones_alone_are_told(run, tmp_path):
    add_bone_shape(star(3, 3))
    _, _, errors = run("segment", write_blend(tmp_path / "rig.blend"))
    assert "no mesh in this file but the shapes of bones" in errors[0]


def test_no_shapes_for_bones_come_with_a_glb(run, tmp_path):
    star_object = add_object(star(5, 3))
    star_object.vertex_groups.new(name="root").add(list(range(642)), 1.0, "REPLACE")
    rig = add_rig("rig", ())
    star_object.parent, star_object.modifiers.new("Armature", "ARMATURE").object = rig, rig
    path = write(tmp_path, ".glb")
    _, report, _ = run("segment", path, "--json")
    assert [row["name"] for row in rows_of(report)] == ["star"]
    assert [obj.name for obj in bpy.data.objects if obj.type == "MESH"] == ["star"]


# What had to be mended.


@pytest.mark.parametrize(("suffix", "n_points"), [(".obj", 1), (".ply", 1), (".stl", 5)])
def test_points_that_are_no_numbers_are_moved_and_told(run, tmp_path, suffix, n_points):
    path = with_bad_point(tmp_path, suffix)
    _, report, _ = run("segment", path, "--json")
    (row,) = rows_of(report)
    assert len(row["parts"]) == 6
    assert f"no numbers in the file: {n_points};" in row["warnings"][0]
    assert not any(vertex.co.length < 0.5 for vertex in bpy.data.meshes[0].vertices)


@pytest.mark.parametrize("suffix", [".glb", ".fbx"])
def test_points_that_are_no_numbers_are_refused_where_the_format_has_none(run, tmp_path, suffix):
    code, _, errors = run("segment", with_bad_point(tmp_path, suffix))
    assert code == 1
    assert "the mesh 'star' has points that are no numbers" in errors[0]


def with_bad_point(tmp_path, suffix):
    mesh = star(5, 3)
    mesh.vertices[10] = MARK
    add_object(mesh)
    path = write(tmp_path, suffix)
    if suffix == ".fbx":
        bpy.data.meshes["star"].vertices[10].co.x = np.nan
        return write(tmp_path, suffix)
    mark, nan = (b"1234.5", b"nan") if suffix == ".obj" else (struct.pack("<f", MARK), struct.pack("<f", np.nan))
    path.write_bytes(path.read_bytes().replace(b"-" + mark, mark).replace(mark, nan))
    return path


def test_a_text_of_points_that_are_no_numbers_is_read_too(run, tmp_path):
    add_object(star(5, 3))
    path = tmp_path / "star.ply"
    bpy.ops.wm.ply_export(filepath=str(path), ascii_format=True)
    lines = path.read_text().splitlines()
    lines[lines.index("end_header") + 11] = "nan 1 1"
    path.write_text("\n".join(lines) + "\n")
    _, report, _ = run("segment", path, "--json")
    assert "no numbers in the file: 1;" in rows_of(report)[0]["warnings"][0]


def test_what_was_mended_of_the_reference_is_told_with_each_mesh(run, tmp_path, star_off):
    path = with_bad_point(tmp_path, ".obj")
    _, report, _ = run("register", star_off, "--source", path, "--output", tmp_path, "--json")
    assert any(told.startswith("star: Points that are no numbers") for told in rows_of(report)[0]["warnings"])


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl", ".fbx"])
def test_faces_that_cannot_be_held_are_counted(run, tmp_path, suffix):
    mesh = star(5, 3)
    obj = add_object(mesh)
    obj.data.clear_geometry()
    obj.data.from_pydata(mesh.vertices.tolist(), [], [*mesh.triangles.tolist(), mesh.triangles[7].tolist()])
    _, report, _ = run("segment", write(tmp_path, suffix), "--json")
    assert "The file lists 1281 faces and the mesh has 1280" in rows_of(report)[0]["warnings"][0]


def test_no_face_is_called_missing_where_the_mesh_has_more_than_the_file_lists(run):
    run("--help")
    from eigenparts.cli.formats.repairs import other_faces

    assert "lists 9 faces and the mesh has 8: those that repeat" in other_faces(9, 8)
    assert "lists 8 faces and the mesh has 9: Blender divided" in other_faces(8, 9)
    assert "left out" not in other_faces(8, 9)


def test_nothing_is_told_of_a_sound_file(run, tmp_path):
    add_object(star(5, 3))
    for suffix in EXPORTERS:
        _, report, _ = run("segment", write(tmp_path, suffix), "--output", tmp_path / "out", "--json")
        assert rows_of(report)[0]["warnings"] == []
        open_file(tmp_path / "star.obj")


# What a file had.


@pytest.mark.parametrize("suffix", [".glb", ".fbx"])
def test_cameras_lights_properties_and_images_stay(run, tmp_path, suffix):
    obj = add_object(star(5, 3))
    obj.data.uv_layers.new(name="UVMap")
    obj["likes"], obj.data["kind"] = "tea", 3
    with_material(obj, "Skin", (1, 1, 1, 1), "skin")
    for name, data in (("camera", bpy.data.cameras.new("camera")), ("sun", bpy.data.lights.new("sun", "SUN"))):
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, data))
    path = write(tmp_path, suffix)
    assert run("segment", path)[0] == 0
    open_file(result_of(path))
    assert (len(bpy.data.cameras), len(bpy.data.lights), bpy.data.objects["star"]["likes"]) == (1, 1, "tea")
    assert dict(bpy.data.objects["star"].data) == {"kind": 3}
    assert [images_of(material) for material in bpy.data.objects["star"].data.materials] == [["skin"]] * 6


@pytest.mark.parametrize("suffix", [".obj", ".glb", ".fbx"])
def test_materials_keep_their_look_and_tell_the_parts(run, tmp_path, suffix):
    obj = add_object(star(5, 3))
    with_material(obj, "Red", (1, 0, 0, 1))
    with_material(obj, "Blue", (0, 0, 1, 1))
    obj.data.polygons.foreach_set("material_index", np.int32([p.center.z > 0 for p in obj.data.polygons]))
    path = write(tmp_path, suffix)
    run("segment", path)
    open_file(result_of(path))
    (mesh,) = {obj.data for obj in bpy.data.objects if obj.type == "MESH"}
    names = {f"{part}.{look}" for part in ("body", *(f"part_{k}" for k in range(1, 6))) for look in ("Red", "Blue")}
    assert {material.name for material in mesh.materials} == names
    for material in mesh.materials:
        red, _, blue, _ = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value
        assert (red > 0.9, blue > 0.9) == (material.name.endswith("Red"), material.name.endswith("Blue"))


@pytest.mark.parametrize("actions", [("walk",), ("walk", "run")])
def test_bones_and_actions_of_an_fbx_are_the_same(run, tmp_path, actions):
    star_object = add_object(star(5, 3))
    star_object.shape_key_add(name="Basis")
    smile = star_object.shape_key_add(name="Smile")
    for frame, value in ((1, 0.0), (12, 1.0)):
        smile.value = value
        smile.keyframe_insert("value", frame=frame)
    for name in ("one", "two"):
        add_rig(name, actions)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    path = write(tmp_path, ".fbx")
    open_file(path)
    before = actions_and_bones()
    assert run("segment", path)[0] == 0
    open_file(result_of(path))
    assert len(before[0]) > 2
    assert actions_and_bones() == before


def test_colours_of_vertices_stay(run, tmp_path):
    obj = add_object(star(5, 3))
    paint = obj.data.color_attributes.new("Paint", "BYTE_COLOR", "POINT")
    paint.data.foreach_set("color", np.tile(np.float32([1, 0, 0, 1]), 642))
    obj.data.color_attributes.active_color = paint
    for suffix in (".ply", ".glb"):
        path = write(tmp_path, suffix)
        run("segment", path)
        open_file(result_of(path))
        colours = np.array([tuple(value.color) for value in bpy.data.meshes[0].color_attributes[0].data])
        np.testing.assert_allclose(colours, np.tile([1, 0, 0, 1], (len(colours), 1)), atol=0.03)
        open_file(path)


# Results of ours, given again.


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".glb", ".fbx"])
def test_a_result_can_be_divided_again_and_comes_out_the_same(run, tmp_path, suffix):
    add_object(star(5, 3))
    first = write(tmp_path, suffix)
    _, before, _ = run("segment", first, "--json")
    again = result_of(first).rename(tmp_path / f"again{suffix}")
    code, after, _ = run("segment", again, "--json")
    assert code == 0
    assert rows_of(after)[0]["warnings"] == []
    assert [part["faces"] for part in rows_of(after)[0]["parts"]] == [p["faces"] for p in rows_of(before)[0]["parts"]]
    assert {material.name for material in bpy.data.materials if material.users} <= {
        part["name"] for part in rows_of(after)[0]["parts"]
    }


def test_the_faces_of_a_ply_have_their_parts_and_give_them_to_others(run, tmp_path):
    add_object(star(5, 3))
    path = write(tmp_path, ".ply")
    run("segment", path)
    labels = np.empty(1280, dtype=np.int32)
    bpy.data.meshes[0].attributes["part"].data.foreach_get("value", labels)
    run("transfer", path, "--source", result_of(path), "--layers", "parts")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "star_ply_transferred.blend"))
    found = np.empty(1280, dtype=np.int32)
    bpy.data.meshes[0].attributes["part"].data.foreach_get("value", found)
    assert set(labels.tolist()) == set(range(6))
    np.testing.assert_array_equal(found, labels)


def test_a_new_division_of_a_result_has_new_colours(run, tmp_path):
    add_object(star(5, 3))
    path = write(tmp_path, ".ply")
    run("segment", path)
    again = result_of(path).rename(tmp_path / "again.ply")
    run("segment", again, "--level", 0)
    open_file(result_of(again))
    assert len({tuple(value.color) for value in bpy.data.meshes[0].color_attributes[0].data}) == 1


def test_an_attribute_that_is_only_called_like_ours_gets_out_of_the_way(run, tmp_path):
    obj = add_object(star(5, 3))
    obj.data.attributes.new("part_vertex", "FLOAT", "POINT").data.foreach_set("value", np.full(642, 0.5))
    path = write(tmp_path, ".ply")
    code, report, _ = run("segment", path, "--json")
    assert (code, len(rows_of(report)[0]["parts"])) == (0, 6)
    assert '"part_vertex" of the file is "part_vertex_of_file"' in rows_of(report)[0]["warnings"][0]
    open_file(result_of(path))
    values = np.empty(642, dtype=np.float32)
    bpy.data.meshes[0].attributes["part_vertex_of_file"].data.foreach_get("value", values)
    assert (values == 0.5).all()
