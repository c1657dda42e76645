"""The bug report: what a developer needs, and nothing that says whose it is."""

import bpy
import pytest


@pytest.fixture
def report(extension):
    from eigenparts.operators.settings.copy_report import report

    return lambda: report(bpy.context)


def test_the_report_has_versions_and_the_size_of_the_mesh(report, analyzed):
    told = report()
    assert f"Blender {bpy.app.version_string}" in told
    assert f"{len(analyzed.data.vertices)} vertices" in told
    assert "level 4 of 4, 6 parts" in told


def test_the_report_names_neither_files_nor_objects(report, analyzed, tmp_path):
    analyzed.name = analyzed.data.name = "Secret Project"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "client.blend"))
    told = report()
    assert not any(word in told for word in ("Secret", "client", str(tmp_path), "/"))


def test_an_error_is_told_by_its_place_in_the_extension_only(report, star_object):
    from eigenparts import compute as engine
    from eigenparts.operators.mesh_data import mesh_arrays
    from eigenparts.operators.messages import unexpected_errors

    try:
        engine.TriangleMesh(mesh_arrays.read_mesh(star_object.data).vertices, "/home/somebody/secret.txt")
    except Exception as error:
        unexpected_errors.remember(error)
    told = report()
    assert "compute/surface/mesh.py:" in told
    assert "somebody" not in told
    unexpected_errors.forget()
    assert "compute/surface/mesh.py:" not in report()


def test_no_mesh_is_a_report_too(report):
    assert "No mesh is active" in report()
