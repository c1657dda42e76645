"""Analyze: what the operator writes is what the engine says."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from tests.blender.conftest import add_object, exact_labels_of, values_of
from tests.shapes import icosphere


def two_triangles_a_polygon(mesh):
    """Return the mesh with flat triangles joined to quads where a face of the next finer mesh allows it."""
    corner = mesh.triangles
    middle = len(mesh.vertices) + np.arange(len(corner))
    vertices = np.vstack([mesh.vertices, mesh.vertices[corner].mean(axis=1)])
    edges = mesh.edges.neighbours
    shared = mesh.edges.vertices[mesh.edges.shared]
    return vertices, np.stack([shared[:, 0], middle[edges[:, 0]], shared[:, 1], middle[edges[:, 1]]], axis=1)


def test_parts_of_triangles_are_those_of_the_engine(analyzed, star):
    labels = analyze(TriangleMesh(star.vertices.astype(np.float32), star.triangles)).segment(mode="nested").labels
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels)


def test_a_star_has_its_arms_as_parts(analyzed, star):
    labels = values_of(analyzed.data, "part")
    centres = star.vertices[star.triangles].mean(axis=1)
    tips = [
        np.linalg.norm(centres - 9 * np.array([np.cos(a), np.sin(a), 0]), axis=1).argmin()
        for a in np.arange(5) * 0.4 * np.pi
    ]
    assert sorted(labels[tips]) == [1, 2, 3, 4, 5]
    assert labels[np.abs(centres[:, 2]).argmax()] == 0


def test_polygons_get_the_part_of_most_of_their_area(star):
    vertices, quads = two_triangles_a_polygon(star)
    obj = add_object(vertices, quads)
    bpy.ops.eigenparts.analyze()
    mesh = obj.data
    triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    engine = analyze(TriangleMesh(np.float32(vertices), triangles.reshape(-1, 3)))
    of_triangle = engine.segment(mode="nested").labels
    polygon = np.array([triangle.polygon_index for triangle in mesh.loop_triangles])
    # Borders along edges of polygons differ from those along edges of their triangles; what lies below does not.
    labels, of_triangle = exact_labels_of(mesh), engine.exact_labels(of_triangle)
    agree = of_triangle == labels[polygon]
    assert set(labels) == set(of_triangle)
    # Only polygons that a border crosses may differ from one of their two triangles, and never from both.
    assert np.bincount(polygon, agree).min() >= 1


def test_the_vertex_map_has_the_label_of_most_faces_around(analyzed):
    mesh = analyzed.data
    labels, of_vertex = values_of(mesh, "part"), values_of(mesh, "part_vertex")
    around = [[] for _ in mesh.vertices]
    for polygon, label in zip(mesh.polygons, labels, strict=True):
        for vertex in polygon.vertices:
            around[vertex].append(label)
    assert of_vertex.tolist() == [max(sorted(set(votes)), key=votes.count) for votes in around]


def test_corners_have_the_colour_of_their_part_and_it_is_active(analyzed):
    mesh = analyzed.data
    colours = values_of(mesh, "part_color", 4, np.float32, "color").reshape(-1, 3, 4)
    labels = values_of(mesh, "part")
    assert mesh.color_attributes.active_color_name == "part_color"
    assert (colours == colours[:, :1]).all()
    assert len(np.unique(np.column_stack([labels, colours[:, 0]]), axis=0)) == len(set(labels)) == 6
    assert len(np.unique(colours[:, 0], axis=0)) == 6


def test_a_sphere_is_one_part():
    sphere = icosphere(2)
    obj = add_object(sphere.vertices, sphere.triangles)
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}
    assert set(values_of(obj.data, "part")) == {0}
    assert (obj.data.eigenparts.level, obj.data.eigenparts.n_parts) == (0, 1)


def test_an_eigenfunction_divides_by_both_kinds_of_extrema(star_object, star):
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=3)
    labels = analyze(TriangleMesh(np.float32(star.vertices), star.triangles), field=3).segment(mode="nested").labels
    np.testing.assert_array_equal(values_of(star_object.data, "part"), labels)
    assert "eigenparts_branch_minima" in star_object.data.attributes
    assert len(set(labels)) > 2


def test_own_values_are_a_field_too(star_object, star):
    heights = np.float32(np.linalg.norm(star.vertices, axis=1))
    attribute = star_object.data.attributes.new("height", "FLOAT", "POINT")
    attribute.data.foreach_set("value", heights)
    bpy.ops.eigenparts.analyze(field="ATTRIBUTE", attribute="height")
    engine = analyze(TriangleMesh(np.float32(star.vertices), star.triangles), field=heights.astype(float))
    labels = engine.segment(mode="nested").labels
    np.testing.assert_array_equal(values_of(star_object.data, "part"), labels)


def test_modifiers_can_pose_what_is_analyzed(star_object, star):
    bend = star_object.modifiers.new("bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle = "BEND", 1.0
    bpy.ops.eigenparts.analyze(use_modifiers=True)
    posed = star_object.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    vertices = values_of(posed, "position", 3, np.float32, "vector")
    labels = analyze(TriangleMesh(vertices, star.triangles)).segment(mode="nested").labels
    np.testing.assert_array_equal(values_of(star_object.data, "part"), labels)


def test_modifiers_that_change_faces_are_refused(star_object):
    star_object.modifiers.new("subdivision", "SUBSURF")
    with pytest.raises(RuntimeError, match="modifiers change the faces"):
        bpy.ops.eigenparts.analyze(use_modifiers=True)


def test_an_analysis_by_eigenfunction_tells_which_one_suits(star_object, extension):
    room = extension.operators.mesh_state
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=1)
    found = room.state.read(star_object.data).function_hints
    assert {number for number, _, _ in found} == set(range(1, 9))
    assert {n_protrusions for _, _, n_protrusions in found} == {5}
    assert f"Eigenfunction {found[0][0]} suits best" in room.function_hints.sentence(found)
    bpy.ops.eigenparts.analyze(field="DIFFUSION")
    assert room.state.read(star_object.data).function_hints == []


def test_exporters_take_nothing_of_an_analysis_for_a_uv_map(analyzed, tmp_path):
    bpy.ops.wm.ply_export(filepath=str(tmp_path / "star.ply"))
    bpy.ops.wm.obj_export(filepath=str(tmp_path / "star.obj"))
    header = (tmp_path / "star.ply").read_bytes().split(b"end_header")[0].decode("latin-1")
    assert f"element vertex {len(analyzed.data.vertices)}\n" in header
    assert "property float s" not in header
    assert not [line for line in (tmp_path / "star.obj").read_text().splitlines() if line.startswith("vt ")]
