"""Vertices doubled along seams, as exports have them, get one value, so that nothing tears when it is posed."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, values_of
from tests.shapes import star


@pytest.fixture(scope="module")
def shape():
    return star(n_arms=5, n_subdivisions=3)


def with_seams(mesh):
    """Return vertices and faces split along bands, as UV maps or hard edges split them."""
    bands = np.floor(3 * mesh.vertices[mesh.triangles].mean(axis=1)).astype(int)
    corners = np.column_stack([np.repeat(bands, 3, axis=0), mesh.triangles.ravel()])
    kinds, corner = np.unique(corners, axis=0, return_inverse=True)
    return mesh.vertices[kinds[:, 3]], corner.reshape(-1, 3)


def flat_shaded(mesh):
    """Return vertices and faces of which no two share a vertex."""
    return mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(mesh.triangles.size).reshape(-1, 3)


SPLIT = [with_seams, flat_shaded]


def widest_tear(obj, values):
    """Return how far values differ at most between vertices at one place."""
    places = values_of(obj.data, "position", 3, np.float32, "vector")
    _, place = np.unique(places, axis=0, return_inverse=True)
    order = np.argsort(place.reshape(-1), kind="stable")
    steps = np.abs(np.diff(np.asarray(values, dtype=float).reshape(len(places), -1)[order], axis=0)).max(axis=1)
    return steps[np.diff(place.reshape(-1)[order]) == 0].max()


def weights_of(obj):
    weights = np.zeros((len(obj.data.vertices), len(obj.vertex_groups)))
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            weights[vertex.index, element.group] = element.weight
    return weights


@pytest.mark.parametrize("split", SPLIT)
@pytest.mark.parametrize("softness", [0, 0.2])
def test_parts_and_groups_of_parts_do_not_tear(shape, split, softness):
    obj = add_object(*split(shape))
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_ATTRIBUTE", "VERTEX_GROUPS"}, softness=softness)
    for level in range(1, obj.data.eigenparts.level + 1):
        bpy.ops.eigenparts.segment(level=level)
        assert widest_tear(obj, values_of(obj.data, "part_vertex")) == 0
        assert widest_tear(obj, weights_of(obj)) == 0


def test_parts_do_not_tear_where_borders_were_cut(shape):
    obj = add_object(*with_seams(shape))
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.cut()
    assert widest_tear(obj, values_of(obj.data, "part_vertex")) == 0


def test_a_mesh_without_seams_remembers_no_places(shape):
    obj = add_object(shape.vertices, shape.triangles)
    bpy.ops.eigenparts.analyze(order="1")
    assert ".eigenparts_place" not in obj.data.attributes


@pytest.mark.parametrize("split", SPLIT)
def test_what_is_transferred_does_not_tear(shape, split):
    vertices, faces = split(star(n_arms=5, n_subdivisions=2))
    target = add_object(vertices, faces, "target")
    target.shape_key_add(name="Basis")
    source = add_object(shape.vertices, shape.triangles, "source")
    group = source.vertex_groups.new(name="Up")
    for vertex, height in enumerate(np.clip(shape.vertices[:, 0], 0, 1).tolist()):
        group.add([vertex], height, "REPLACE")
    for name, size in (("Basis", [1, 1, 1]), ("Fat", [1.3, 1.1, 2])):
        source.shape_key_add(name=name).data.foreach_set("co", np.float32(shape.vertices * size).ravel())
    bpy.ops.eigenparts.transfer(layers={"GROUPS", "SHAPE_KEYS"})
    assert widest_tear(target, weights_of(target)) < 1e-6
    moved = np.empty(3 * len(vertices), dtype=np.float32)
    target.data.shape_keys.key_blocks["Fat"].data.foreach_get("co", moved)
    assert widest_tear(target, moved) < 1e-6


def test_what_is_unsure_is_filled_in_across_seams(shape):
    """The fill of a piece whose vertices are all unsure comes from beyond its seams."""
    from eigenparts import compute
    from eigenparts.operators.mesh_data.mesh_arrays import read_mesh
    from eigenparts.tasks.layer_mapping import ShapeMap, TransferShape, _LayerMapper
    from eigenparts.tasks.layers import Layer

    vertices, faces = flat_shaded(shape)
    arrays = read_mesh(add_object(vertices, faces).data)
    is_sure = vertices[:, 0] < 1
    mesh = compute.TriangleMesh(arrays.vertices, arrays.triangles)
    analysis = compute.analyze(mesh, order=1)
    found = compute.correspond(analysis, analysis)
    object.__setattr__(found, "confidence", is_sure.astype(float))
    flat = TransferShape("flat", arrays, faces, faces.ravel(), np.repeat(np.arange(len(faces)), 3))
    mapper = _LayerMapper(ShapeMap(found, analysis.surface.vertex_of_input, (), ()), flat, flat)
    filled = mapper.filled(Layer("GROUP", "Arm", np.where(is_sure, 1.0, 0.0)[:, None])).values
    np.testing.assert_allclose(filled, 1)


@pytest.mark.parametrize("damage", [-1, 10**6])
def test_damaged_places_are_refused(shape, damage):
    obj = add_object(*with_seams(shape))
    bpy.ops.eigenparts.analyze(order="1")
    obj.data.attributes[".eigenparts_place"].data[0].value = damage
    with pytest.raises(RuntimeError, match="damaged"):
        bpy.ops.eigenparts.segment(level=1)
