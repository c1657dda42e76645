"""The same parts and joints on every processor: other kernels of OpenBLAS and numpy round as other processors do."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from compute import TriangleMesh
from examples import humanoid, octopus, quadruped
from tests.shapes import icosphere, star

ROOT = Path(__file__).parents[2]
CONFIG = np.show_config(mode="dicts")
COLUMNS = ("vertices", "triangles")
FEATURES = CONFIG["SIMD Extensions"]
OTHERS = {
    "of 2008": {"OPENBLAS_CORETYPE": "Nehalem", "NPY_DISABLE_CPU_FEATURES": " ".join(FEATURES.get("found", []))},
    "of 2013": {"OPENBLAS_CORETYPE": "Haswell"},
}

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64") or "openblas" not in CONFIG["Build Dependencies"]["blas"]["name"],
    reason="Only OpenBLAS on x86 can be told to compute as another processor does.",
)


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """Shapes with ties of all kinds: equal arms, twins, rings, and points that are equally near to many others."""
    ball = icosphere(3)
    shapes = {
        "star": star(5, growth=0),
        "rod": TriangleMesh(ball.vertices * [1, 1, 6], ball.triangles),
        "human": humanoid(4000),
        "kraken": octopus(4000),
        "dog": quadruped(4000),
    }
    path = tmp_path_factory.mktemp("processors") / "meshes.npz"
    columns = [(f"{name} {column}", getattr(shape, column)) for name, shape in shapes.items() for column in COLUMNS]
    np.savez(path, **dict(columns))
    return path


def computed(meshes, processor):
    """Return what a process finds whose libraries take the processor for another one."""
    out = meshes.with_name(f"as {processor.get('OPENBLAS_CORETYPE', 'it is')}.npz")
    command = [sys.executable, "-m", "tests.compute.processor_run", str(meshes), str(out)]
    subprocess.run(command, cwd=ROOT, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"} | processor, check=True)
    return dict(np.load(out))


@pytest.fixture(scope="module")
def own(meshes):
    return computed(meshes, {})


@pytest.mark.parametrize("processor", OTHERS)
def test_another_processor_finds_the_same_parts_and_joints(meshes, own, processor):
    if processor == "of 2013" and "AVX2" not in [*FEATURES.get("found", []), *FEATURES.get("baseline", [])]:
        pytest.skip("This processor is older than the one it would have to be taken for.")
    for name, array in computed(meshes, OTHERS[processor]).items():
        if name.endswith("joints"):
            np.testing.assert_allclose(array, own[name], rtol=0, atol=1e-6, err_msg=name)
        else:
            np.testing.assert_array_equal(array, own[name], err_msg=name)
