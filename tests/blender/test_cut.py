"""Cut: edges along the borders, and nothing lost of what the mesh carries."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from examples import humanoid
from tests.blender.conftest import add_object, corner_normals_of, everything_on, give_custom_normals, values_of
from tests.blender.test_analyze import two_triangles_a_polygon


def area_of(mesh):
    return sum(polygon.area for polygon in mesh.polygons)


def faces_of_edges(mesh):
    return np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))


def positions(mesh):
    return values_of(mesh, "position", 3, np.float32, "vector")


@pytest.fixture
def quads(scene, star):
    """The star as quads, with all that a mesh can carry."""
    return scene(analyzed_quads, star)


def analyzed_quads(star):
    vertices, polygons = two_triangles_a_polygon(star)
    obj = add_object(vertices, polygons)
    mesh = obj.data
    for name, direction in (("left", -1), ("right", 1)):
        weight = np.clip(0.5 + direction * vertices[:, 0] / 10, 0, 1)
        group = obj.vertex_groups.new(name=name)
        for vertex, value in enumerate(weight.tolist()):
            group.add([vertex], value, "REPLACE")
    layer = mesh.uv_layers.new(name="map")
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    layer.uv.foreach_set("vector", np.float32(vertices[corners][:, :2]).ravel())
    heat = mesh.attributes.new("heat", "FLOAT", "POINT")
    heat.data.foreach_set("value", np.float32(vertices @ [1, 2, 3]))
    tag = mesh.attributes.new("tag", "INT", "FACE")
    tag.data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.int32))
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="sheared")
    key.data.foreach_set("co", np.float32(vertices @ np.array([[1, 0, 0], [0.5, 1, 0], [0, 0, 2]])).ravel())
    bpy.ops.eigenparts.analyze()


def test_area_is_kept_and_no_hole_is_left(quads):
    before = area_of(quads.data)
    bpy.ops.eigenparts.cut()
    assert area_of(quads.data) == pytest.approx(before, rel=1e-3)
    assert set(faces_of_edges(quads.data)) == {2}
    assert not quads.data.validate()


def test_flat_faces_keep_their_area_exactly(analyzed):
    before = area_of(analyzed.data)
    bpy.ops.eigenparts.cut()
    assert area_of(analyzed.data) == pytest.approx(before, rel=1e-6)


def test_what_was_linear_in_space_still_is(quads):
    """UVs, attributes, weights and shape keys that are linear functions of the place stay so at new vertices."""
    bpy.ops.eigenparts.cut()
    mesh = quads.data
    places = positions(mesh)
    assert len(places) > len(mesh.attributes["heat"].data) - 1
    np.testing.assert_allclose(values_of(mesh, "heat", dtype=np.float32), places @ [1, 2, 3], atol=1e-4)
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    uv = np.array([entry.vector for entry in mesh.uv_layers["map"].uv])
    np.testing.assert_allclose(uv, places[corners][:, :2], atol=1e-4)
    key = np.array([point.co for point in mesh.shape_keys.key_blocks["sheared"].data])
    np.testing.assert_allclose(key, places @ np.array([[1, 0, 0], [0.5, 1, 0], [0, 0, 2]]), atol=1e-4)
    weights = np.array([sum(entry.weight for entry in vertex.groups) for vertex in mesh.vertices])
    np.testing.assert_allclose(weights, 1, atol=1e-5)


def test_custom_normals_stay_and_are_interpolated(quads):
    give_custom_normals(quads.data)
    bpy.ops.eigenparts.cut()
    assert quads.data.has_custom_normals
    np.testing.assert_allclose(*corner_normals_of(quads.data), atol=0.03)


def test_faces_that_no_border_crosses_stay_and_pieces_keep_the_attributes_of_theirs(quads):
    faces = [tuple(polygon.vertices) for polygon in quads.data.polygons]
    bpy.ops.eigenparts.cut()
    tags = values_of(quads.data, "tag")
    after = [tuple(polygon.vertices) for polygon in quads.data.polygons]
    n_kept = sum(faces[tag] == face for tag, face in zip(tags.tolist(), after, strict=True))
    assert n_kept > 0.8 * len(faces)
    assert set(tags) == set(range(len(faces)))
    centres = np.array([polygon.center for polygon in quads.data.polygons])
    old = np.array([positions(quads.data)[list(face)].mean(axis=0) for face in faces])
    size = np.sqrt(area_of(quads.data) / len(faces))
    assert np.linalg.norm(centres - old[tags], axis=1).max() < 3 * size


def test_no_slivers_are_cut_off(quads):
    """A corner cut off at 5 % of both its edges has 1/400 of the area of a triangle, a little less of a bent quad."""
    before = np.array([polygon.area for polygon in quads.data.polygons])
    quads.data.eigenparts.level = 1000
    bpy.ops.eigenparts.cut()
    after = np.array([polygon.area for polygon in quads.data.polygons])
    assert (after / before[values_of(quads.data, "tag")]).min() > 1e-3


def test_every_part_is_one_piece_and_the_numbers_stay(analyzed):
    level = analyzed.data.eigenparts.level
    titles = [row.title for row in analyzed.data.eigenparts.rows]
    bpy.ops.eigenparts.cut()
    assert analyzed.data.eigenparts.level == level
    assert [row.title for row in analyzed.data.eigenparts.rows] == titles
    assert set(values_of(analyzed.data, "part")) == set(range(len(titles)))


@pytest.mark.parametrize(
    ("borders", "level", "is_told"), [("EXACT", 3, True), ("EXACT", 4, False), ("EDGES", 3, True), ("EDGES", 4, False)]
)
def test_a_part_that_falls_apart_is_told(capfd, monkeypatch, borders, level, is_told):
    """At level 3 the head and an arm of a body are one part, joined within single faces, if it has no twins."""
    alone = lambda net, basis, extrema, saddles, *_: (np.arange(len(extrema)), np.arange(len(saddles)))  # noqa: E731
    monkeypatch.setattr("eigenparts.compute.segmentation.hierarchy.measured_hierarchy.find_twins", alone)
    character = humanoid(5000)
    mesh = add_object(character.mesh_in_pose("rest"), character.quads).data
    bpy.ops.eigenparts.analyze(order="1", borders=borders)
    bpy.ops.eigenparts.segment(level=level, joints=False)
    n_before = np.bincount(values_of(mesh, "part"))
    bpy.ops.eigenparts.cut()
    n_after = np.bincount(values_of(mesh, "part"), minlength=len(n_before))
    assert (n_after < 0.6 * n_before).any() == is_told
    assert ("as parts meet within single faces there" in capfd.readouterr().out) == is_told


def test_borders_lie_at_the_height_of_their_saddles(star):
    """Where the field is linear in space, borders lie in planes, but for vertices they were snapped to."""
    direction = np.array([0.3, 1.0, 0.05])
    obj = add_object(star.vertices, star.triangles)
    heights = np.float32(star.vertices @ direction)
    obj.data.attributes.new("height", "FLOAT", "POINT").data.foreach_set("value", heights)
    bpy.ops.eigenparts.analyze(field="ATTRIBUTE", attribute="height")
    bpy.ops.eigenparts.segment(level=3, mode="FEATURES")
    bpy.ops.eigenparts.cut()
    engine = analyze(TriangleMesh(np.float32(star.vertices), star.triangles), field=heights.astype(float))
    parts = engine.segment(level=3, mode="features").parts
    saddles = heights[parts.saddle[1:]]
    mesh, labels = obj.data, values_of(obj.data, "part")
    labels_of_edge = [set() for _ in mesh.edges]
    for polygon, label in zip(mesh.polygons, labels.tolist(), strict=True):
        for loop in polygon.loop_indices:
            labels_of_edge[mesh.loops[loop].edge_index].add(label)
    border = [edge for edge, found in zip(mesh.edges, labels_of_edge, strict=True) if len(found) > 1]
    ends = np.unique([edge.vertices[:] for edge in border])
    is_new = ends >= len(star.vertices)
    distance = np.abs((positions(mesh)[ends] @ direction)[:, None] - saddles).min(axis=1)
    assert is_new.mean() > 0.8
    np.testing.assert_allclose(distance[is_new], 0, atol=1e-5)
    edge_length = np.linalg.norm(np.diff(star.vertices[star.edges.vertices], axis=1), axis=-1)
    assert distance.max() < 0.05 * edge_length.max() * np.linalg.norm(direction)


def test_the_area_of_each_part_is_that_of_its_level_set(star):
    obj = add_object(star.vertices, star.triangles)
    heights = np.float32(np.linalg.norm(star.vertices, axis=1))
    obj.data.attributes.new("height", "FLOAT", "POINT").data.foreach_set("value", heights)
    bpy.ops.eigenparts.analyze(field="ATTRIBUTE", attribute="height")
    bpy.ops.eigenparts.segment(mode="FEATURES")
    engine = analyze(TriangleMesh(np.float32(star.vertices), star.triangles), field=heights.astype(float))
    exact = exact_areas(engine)
    bpy.ops.eigenparts.cut()
    areas = np.bincount(values_of(obj.data, "part"), [polygon.area for polygon in obj.data.polygons])
    # What is left is the snapping to vertices.
    np.testing.assert_allclose(areas[list(exact)], list(exact.values()), rtol=0.01)


def exact_areas(analysis):
    """Return the area of each part of the default level, by cutting every triangle of the net."""
    from compute.segmentation.faces.arc_areas import arc_areas

    areas = {}
    cuts = analysis.part_tree().cut_arcs(analysis.hierarchy.default_level, "features")
    for tree, arc, cut in zip(analysis.hierarchy.trees, analysis._arc_of_vertex, cuts, strict=True):
        shares = arc_areas(analysis.field.values, arc, tree, analysis.net, np.arange(len(analysis.net.triangles)))
        labels = tree.spread(cut)[shares.arc]
        areas |= {part: shares.area[labels == part].sum() for part in np.unique(labels).tolist() if part}
    return areas


def test_levels_can_still_be_chosen_after_a_cut(analyzed):
    bpy.ops.eigenparts.cut()
    after_cut = values_of(analyzed.data, "part")
    analyzed.data.eigenparts.level = 1
    assert len(analyzed.data.eigenparts.rows) < 6
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), after_cut)


def test_a_second_cut_needs_a_new_analysis(analyzed):
    bpy.ops.eigenparts.cut()
    with pytest.raises(RuntimeError, match="cut already"):
        bpy.ops.eigenparts.cut()
    bpy.ops.eigenparts.analyze()
    assert bpy.ops.eigenparts.cut() == {"FINISHED"}


def test_attributes_and_properties_of_the_user_are_all_there(quads):
    quads.data["mine"] = 3
    names = {attribute.name: attribute.domain for attribute in quads.data.attributes}
    bpy.ops.eigenparts.cut()
    after = {attribute.name: attribute.domain for attribute in quads.data.attributes}
    assert {name for name in names if "eigenparts" not in name} <= set(after)
    assert quads.data["mine"] == 3
    assert [group.name for group in quads.vertex_groups] == ["left", "right"]


def test_undo_brings_the_uncut_mesh_back(analyzed):
    n_before = len(analyzed.data.polygons)
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        bpy.ops.eigenparts.cut()
        assert len(analyzed.data.polygons) > n_before
        bpy.ops.ed.undo_push(message="cut")
        bpy.ops.ed.undo()
    undone = bpy.data.objects["star"]
    assert len(undone.data.polygons) == n_before
    bpy.context.view_layer.objects.active = undone
    assert bpy.ops.eigenparts.cut() == {"FINISHED"}


def test_a_mesh_that_others_use_is_not_cut(analyzed):
    bpy.context.collection.objects.link(bpy.data.objects.new("other", analyzed.data))
    before = everything_on(analyzed.data)
    with pytest.raises(RuntimeError, match="single-user"):
        bpy.ops.eigenparts.cut()
    assert everything_on(analyzed.data) == before


def test_an_open_mesh_stays_as_open_as_it_was(star):
    half = star.triangles[star.vertices[star.triangles].mean(axis=1)[:, 2] > 0]
    obj = add_object(star.vertices, half)
    before = (faces_of_edges(obj.data) == 1).sum()
    length = boundary_length(obj.data)
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.cut()
    after = faces_of_edges(obj.data)
    assert set(after) <= {1, 2, 0}
    assert (after == 1).sum() >= before
    assert boundary_length(obj.data) == pytest.approx(length, rel=1e-6)


def boundary_length(mesh):
    places = positions(mesh)
    ends = np.array([edge.vertices[:] for edge in mesh.edges])[faces_of_edges(mesh) == 1]
    return np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1).sum()


def border_length(mesh, labels):
    """Return the length of all edges between faces of different labels."""
    total = 0.0
    label_of_edge = {}
    for polygon, label in zip(mesh.polygons, labels.tolist(), strict=True):
        for loop in polygon.loop_indices:
            edge = mesh.loops[loop].edge_index
            if label_of_edge.setdefault(edge, label) != label:
                first, second = (mesh.vertices[vertex].co for vertex in mesh.edges[edge].vertices)
                total += (first - second).length
    return total


def test_existing_edges_make_shorter_borders_and_no_geometry(quads):
    mesh = quads.data
    labels, faces = values_of(mesh, "part"), [tuple(polygon.vertices) for polygon in mesh.polygons]
    before = border_length(mesh, labels)
    bpy.ops.eigenparts.cut(method="EXISTING")
    moved = values_of(mesh, "part")
    assert [tuple(polygon.vertices) for polygon in mesh.polygons] == faces
    assert set(moved) == set(labels)
    assert border_length(mesh, moved) < before
    assert (moved != labels).mean() < 0.2


def test_a_cut_that_is_refused_does_not_touch_the_faces(analyzed):
    twin = analyzed.copy()
    bpy.context.collection.objects.link(twin)
    mesh = analyzed.data
    for elements in (mesh.vertices, mesh.edges, mesh.polygons):
        elements.foreach_set("select", np.arange(len(elements)) == 3)
    with pytest.raises(RuntimeError, match="used 2 times"):
        bpy.ops.eigenparts.cut()
    assert [vertex.index for vertex in mesh.vertices if vertex.select] == [3]
