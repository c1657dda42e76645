"""Mirror, subdivision and armature modifiers: the mesh itself is divided, and what modifiers make of it follows."""

import bmesh
import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, values_of
from tests.blender.failing import all_of

STACKS = {
    "mirror": ("MIRROR",),
    "subdivision": ("SUBSURF",),
    "both": ("MIRROR", "SUBSURF"),
    "the other way round": ("SUBSURF", "MIRROR"),
}


@pytest.fixture
def half(star):
    """The upper half of the star, which a Mirror modifier makes whole."""
    obj = add_object(star.vertices, star.triangles)
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    everything = [*edited.verts, *edited.edges, *edited.faces]
    plane = {"plane_co": (0, 0, 0), "plane_no": (0, 0, 1)}
    bmesh.ops.bisect_plane(edited, geom=everything, dist=1e-4, clear_inner=True, **plane)
    for vertex in edited.verts:
        if vertex.is_boundary:
            vertex.co.z = 0
    edited.to_mesh(obj.data)
    edited.free()
    return obj


def add_modifiers(obj, kinds):
    for kind in kinds:
        modifier = obj.modifiers.new(kind.title(), kind)
        if kind == "MIRROR":
            modifier.use_axis = (False, False, True)
            modifier.use_clip = modifier.use_mirror_merge = True
            modifier.merge_threshold = 1e-4


def evaluated(obj):
    return obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def places_of_parts(mesh):
    """Return (F, 3) centres of faces and (F,) their parts."""
    centres = np.empty(3 * len(mesh.polygons), dtype=np.float32)
    mesh.polygons.foreach_get("center", centres)
    return centres.reshape(-1, 3), values_of(mesh, "part")


def n_open_edges(mesh):
    return int((np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges)) == 1).sum())


@pytest.mark.parametrize("kinds", STACKS.values(), ids=STACKS)
def test_the_mesh_itself_is_divided_whatever_modifiers_it_has(half, kinds):
    bpy.ops.eigenparts.analyze(order="1")
    labels = values_of(half.data, "part")
    add_modifiers(half, kinds)
    bpy.ops.eigenparts.analyze(order="1")
    np.testing.assert_array_equal(values_of(half.data, "part"), labels)
    assert len(np.unique(labels)) == 6


@pytest.mark.parametrize("kinds", STACKS.values(), ids=STACKS)
def test_what_modifiers_make_has_the_parts_of_what_it_was_made_from(half, kinds):
    bpy.ops.eigenparts.analyze(order="1")
    add_modifiers(half, kinds)
    centres, parts = places_of_parts(half.data)
    result, result_parts = places_of_parts(evaluated(half))
    n_faces = len(half.data.loops) if "SUBSURF" in kinds else len(parts)
    assert len(result_parts) == n_faces * (2 if "MIRROR" in kinds else 1)
    folded = np.column_stack([result[:, :2], np.abs(result[:, 2])])
    for part in np.unique(parts):
        nearest = np.linalg.norm(folded[result_parts == part][:, None] - centres[parts == part], axis=2).min(axis=1)
        assert nearest.max() < 0.3


@pytest.mark.parametrize("kinds", STACKS.values(), ids=STACKS)
def test_modifiers_that_make_faces_are_refused_where_they_are_to_be_analyzed(half, kinds):
    add_modifiers(half, kinds)
    before = all_of(half.data)
    with pytest.raises(RuntimeError, match="modifiers change the faces"):
        bpy.ops.eigenparts.analyze(use_modifiers=True)
    assert all_of(half.data) == before


def test_weights_reach_the_mirrored_half_and_the_refined_mesh(half):
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_GROUPS", "MATERIALS"}, softness=0.1)
    add_modifiers(half, ("MIRROR", "SUBSURF"))
    mesh = evaluated(half)
    total = np.array([sum(element.weight for element in vertex.groups) for vertex in mesh.vertices])
    np.testing.assert_allclose(total, 1.0, atol=1e-4)
    assert len({polygon.material_index for polygon in mesh.polygons}) == 6


@pytest.mark.parametrize("kinds", [("MIRROR",), ("MIRROR", "SUBSURF")])
def test_a_cut_leaves_no_gap_where_the_halves_meet(half, kinds):
    add_modifiers(half, kinds)
    assert n_open_edges(evaluated(half)) == 0
    bpy.ops.eigenparts.analyze(order="1")
    n_faces = len(half.data.polygons)
    bpy.ops.eigenparts.cut()
    assert len(half.data.polygons) > n_faces
    assert n_open_edges(evaluated(half)) == 0
    assert not half.data.validate()


@pytest.mark.parametrize("weights", ["PARTS", "AUTOMATIC"])
def test_an_armature_moves_the_whole_and_what_refines_it_follows(half, weights):
    add_modifiers(half, ("MIRROR", "SUBSURF"))
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.create_armature(weights=weights)
    kinds = [modifier.type for modifier in half.modifiers]
    assert sorted(kinds) == ["ARMATURE", "MIRROR", "SUBSURF"]
    if weights == "PARTS":
        assert kinds == ["MIRROR", "ARMATURE", "SUBSURF"]
    assert n_open_edges(evaluated(half)) == 0


def test_a_mesh_posed_by_its_armature_can_still_be_analyzed_as_it_is_posed(star_object):
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.create_armature()
    labels = values_of(star_object.data, "part")
    rig = star_object.parent
    bone = next(bone for bone in rig.pose.bones if bone.parent and bone.bone.use_deform)
    bone.rotation_mode, bone.rotation_euler = "XYZ", (0.4, 0, 0.4)
    bpy.context.view_layer.objects.active = star_object
    bpy.ops.eigenparts.analyze(use_modifiers=True)
    assert len(np.unique(values_of(star_object.data, "part"))) == len(np.unique(labels))
    star_object.modifiers.new("Subdivision", "SUBSURF")
    with pytest.raises(RuntimeError, match="modifiers change the faces"):
        bpy.ops.eigenparts.analyze(use_modifiers=True)
