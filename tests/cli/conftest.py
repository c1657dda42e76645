"""Files of every format, and the command line."""

import importlib
import json

import pytest

from tools.extension import load_extension

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module")


@pytest.fixture(autouse=True)
def fresh_scene():
    """An empty file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def run(capfd):
    """Run the command line; returns the exit code, the lines on stdout (or the report) and those on stderr."""

    def call(*arguments):
        extension = load_extension()
        importlib.import_module("eigenparts.cli.quiet").flush_streams()
        capfd.readouterr()
        code = extension.cli.main([str(argument) for argument in arguments])
        out, err = capfd.readouterr()
        return code, json.loads(out) if "--json" in arguments else out.splitlines(), err.splitlines()

    return call


@pytest.fixture(scope="session")
def star_off(tmp_path_factory):
    """A star with five arms as an .off file."""
    from tests.shapes import star

    mesh = star(n_arms=5, n_subdivisions=3)
    vertices = [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    faces = [" ".join(map(str, [3, *row])) for row in mesh.triangles.tolist()]
    path = tmp_path_factory.mktemp("files") / "star.off"
    path.write_text("\n".join(["OFF", f"{len(vertices)} {len(faces)} 0", *vertices, *faces]) + "\n")
    return path
