"""The command ``transfer``: what one mesh has, on the meshes of other files."""

import bpy
import numpy as np
import pytest

from compute.surface.mesh import TriangleMesh
from tests.cli.files import add_object, turned, write_blend, write_off
from tests.compute.registration.dense.test_by_place import BODY, tube
from tests.compute.registration.shapes import lumpy_ball
from tests.shapes import icosphere, joined


@pytest.fixture
def weighted(tmp_path):
    """A file with a lumpy ball whose weight is its height."""
    ball = lumpy_ball(2)
    obj = add_object(ball, "weighted")
    group = obj.vertex_groups.new(name="High")
    for vertex, height in enumerate(ball.vertices[:, 2].tolist()):
        group.add([vertex], max(0.0, min(1.0, 0.5 + 0.4 * height)), "REPLACE")
    return write_blend(tmp_path / "weighted.blend")


def test_weights_go_to_a_turned_and_shuffled_copy(run, weighted, tmp_path):
    copy = turned(lumpy_ball(2))
    code, report, errors = run("transfer", write_off(copy, tmp_path / "copy.off"), "--source", weighted, "--json")
    (row,) = report["files"][0]["objects"]
    assert (code, errors, row["layers"], row["source"]) == (0, [], ["High"], "weighted")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "copy_off_transferred.blend"))
    obj = bpy.data.objects["copy"]
    # The copy is turned about the axis along which the weights grow.
    wanted = np.clip(0.5 + 0.4 * copy.vertices[:, 2], 0, 1)
    found = [sum(group.weight for group in vertex.groups) for vertex in obj.data.vertices]
    assert np.abs(wanted - found).max() < 0.01


def test_what_the_source_does_not_have_is_an_error(run, weighted, tmp_path):
    copy = write_off(turned(lumpy_ball(2)), tmp_path / "copy.off")
    code, _, errors = run("transfer", copy, "--source", weighted, "--layers", "uvs")
    assert (code, len(errors)) == (1, 1)
    assert "none of the layers" in errors[0]
    assert run("transfer", copy, "--source", weighted, "--layers", "dreams")[0] == 2


def add_keys(obj, names):
    for name in names:
        obj.shape_key_add(name=name)
    return obj.data.shape_keys


def test_a_driver_reads_the_keys_of_the_mesh_that_it_goes_to(run, tmp_path):
    """What it reads besides is in the other file, which is told."""
    keys = add_keys(add_object(lumpy_ball(2), "source"), ("Basis", "Open", "Smile"))
    driver = keys.key_blocks["Smile"].driver_add("value").driver
    controller = bpy.data.objects.new("controller", None)
    bpy.context.collection.objects.link(controller)
    for name, read, path in (("a", keys, 'key_blocks["Open"].value'), ("b", controller, "location.x")):
        variable = driver.variables.new()
        variable.name, variable.targets[0].id_type = name, read.id_type
        variable.targets[0].id, variable.targets[0].data_path = read, path
    first = write_blend(tmp_path / "source.blend")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_keys(add_object(lumpy_ball(2), "target"), ("Basis",))
    second = write_blend(tmp_path / "target.blend")
    code, report, _ = run("transfer", second, "--source", first, "--layers", "shape_keys", "--json")
    assert code == 0
    assert any('takes the place of "controller"' in told for told in report["files"][0]["objects"][0]["warnings"])
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "target_transferred.blend"))
    keys = bpy.data.objects["target"].data.shape_keys
    read = {variable.name: variable.targets[0] for variable in keys.animation_data.drivers[0].driver.variables}
    assert (read["a"].id, read["a"].data_path) == (keys, 'key_blocks["Open"].value')
    assert (read["b"].id, read["b"].data_path) == (None, "location.x")


def test_the_part_whose_vertices_are_unsure_is_named(run, weighted, tmp_path):
    """Loose beads beside the highest lump are not analyzed, so what they get is unsure."""
    assert run("segment", weighted)[0] == 0
    beads = TriangleMesh(0.05 * icosphere(2).vertices + [0, 0, 2.3], icosphere(2).triangles)
    copy = write_off(joined(turned(lumpy_ball(2)), beads), tmp_path / "copy.off")
    source = tmp_path / "weighted_parts.blend"
    code, report, _ = run("transfer", copy, "--source", source, "--layers", "groups", "--json")
    (row,) = report["files"][0]["objects"]
    ((part, share),) = row["unsure_parts"].items()
    assert (code, row["unsure_vertices"]) == (0, len(beads.vertices))
    assert 0.3 < share < 0.7
    assert f"copy: {part}: {share:.0%} unsure." in row["warnings"]


def test_clothes_get_the_weights_of_the_body_in_another_file(run, tmp_path):
    obj = add_object(BODY)
    group = obj.vertex_groups.new(name="Height")
    for vertex, height in enumerate((BODY.vertices[:, 2] / 10).tolist()):
        group.add([vertex], height, "REPLACE")
    body = write_blend(tmp_path / "body.blend")
    shirt = write_off(tube(1.03, 4.0, 8.0), tmp_path / "shirt.off")
    code, report, _ = run("transfer", shirt, "--source", body, "--method", "place", "--json")
    (row,) = report["files"][0]["objects"]
    assert (code, row["found_by"], row["confidence"], row["unsure_vertices"]) == (0, "place", 1.0, 0)
    assert report["files"][0]["settings"]["method"] == "place"
