"""The command line reads objects as they stand in the world, whatever scale a file gives them."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh
from tests.cli.files import add_object, write_blend
from tests.shapes import star

EXPORTERS = {
    ".blend": write_blend,
    ".glb": lambda path: bpy.ops.export_scene.gltf(filepath=str(path)),
}


@pytest.mark.parametrize("suffix", EXPORTERS)
def test_scaled_objects_have_the_parts_and_areas_of_the_applied_one(run, tmp_path, suffix):
    mesh = star(5, 2)
    for number, scale in enumerate([(1, 1, 1), (1, 2, 0.25), (-1, 1, 1), (0.01, 0.01, 0.01)]):
        triangles = mesh.triangles if np.prod(scale) > 0 else mesh.triangles[:, ::-1]
        add_object(TriangleMesh(mesh.vertices / scale, triangles), f"star_{number}").scale = scale
    EXPORTERS[suffix](tmp_path / f"stars{suffix}")
    _, report, _ = run("segment", tmp_path / f"stars{suffix}", "--json")
    applied, *others = (row["parts"] for row in report["files"][0]["objects"])
    assert len(applied) > 3
    for other in others:
        assert [part["faces"] for part in other] == [part["faces"] for part in applied]
        np.testing.assert_allclose([part["area"] for part in other], [part["area"] for part in applied], rtol=1e-3)
