"""Every command ends by itself, with the right exit code, whatever it read and wrote, in processes of its own."""

import subprocess
import sys

import bpy
import pytest

from tests.cli.files import add_object, turned, write_blend, write_off
from tests.shapes import star
from tools.extension import ROOT

# Seconds that are enough on a machine that is busy.
LIMIT = 300
LAUNCH = [sys.executable, "-P", str(ROOT / "cli" / "launch.py"), ""]
# A program that uses the command line and ends as programs do, with all that keeps Python from ending.
SCRIPT = """
import pathlib, sys, typing
import scipy.optimize
import bpy
sys.path.insert(0, sys.argv[1])
from tools.extension import load_extension
extension = load_extension()
class Mine:
    def scene(self):
        return bpy.context.scene
remembered = typing.Optional[Mine]
if sys.argv[2] == "registered":
    extension.register()
sys.exit(extension.cli.main(sys.argv[3:]))
"""


def ended(*command):
    """Run a command; it has to end by itself, and returns its exit code."""
    return subprocess.run(list(map(str, command)), capture_output=True, timeout=LIMIT).returncode


@pytest.fixture
def starry(tmp_path):
    """A folder with a star in formats of every kind."""
    write_off(star(3, 2), tmp_path / "star.off")
    obj = add_object(star(3, 2))
    group = obj.vertex_groups.new(name="all")
    group.add(range(len(obj.data.vertices)), 1.0, "REPLACE")
    write_blend(tmp_path / "star.blend")
    bpy.ops.export_scene.gltf(filepath=str(tmp_path / "star.glb"))
    bpy.ops.export_scene.fbx(filepath=str(tmp_path / "star.fbx"))
    bpy.ops.wm.obj_export(filepath=str(tmp_path / "star.obj"))
    bpy.ops.wm.ply_export(filepath=str(tmp_path / "star.ply"))
    bpy.ops.wm.stl_export(filepath=str(tmp_path / "star.stl"))
    return tmp_path


def test_every_format_in_and_out(starry):
    for name in ("star.off", "star.blend", "star.glb", "star.fbx", "star.obj", "star.ply", "star.stl"):
        assert ended(*LAUNCH, "segment", starry / name) == 0, name
    (starry / "star.glb").write_bytes(b"glTF")
    assert ended(*LAUNCH, "segment", starry / "star.glb") == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ("register", "star.glb", "star.off"),
        ("register", "star.glb", "--source", "star.blend", "--timeout", "100"),
        ("transfer", "star.glb", "--source", "star.blend"),
        ("segment", "star.glb", "star.fbx", "--jobs", "2"),
        ("batch", ".", "--glob", "*.glb", "--in-process"),
        ("batch", ".", "--glob", "*.glb"),
    ],
    ids=" ".join,
)
def test_every_command(starry, arguments):
    files = [str(starry / word) if (starry / word).exists() else word for word in arguments]
    assert ended(*LAUNCH, *files) == 0
    assert ended(*LAUNCH, arguments[0]) == 2


# docs/scripting.md tells of it.
CRASHES = pytest.mark.skipif(bpy.app.version < (4, 5), reason="this module crashes behind any script that registered")


@pytest.mark.parametrize("registered", [pytest.param("registered", marks=CRASHES), "bare"])
def test_a_program_that_calls_the_command_line(starry, registered):
    program = [sys.executable, "-c", SCRIPT, ROOT, registered]
    assert ended(*program, "segment", starry / "star.glb") == 0
    assert ended(*program, "segment", starry / "missing.glb") == 1


def test_nothing_of_the_engine_loads_what_keeps_python_from_ending(starry):
    names = "star.glb", "turned.off"
    write_off(turned(star(3, 2)), starry / "turned.off")
    program = "import sys; sys.path.insert(0, sys.argv[1]); from tools.extension import load_extension\n"
    program += "code = load_extension().cli.main(sys.argv[2:]); sys.exit(code or 'scipy.optimize' in sys.modules)"
    for command in ("register", "transfer"):
        files = [starry / name for name in names]
        arguments = [command, *files, "--source", starry / "star.blend", "--in-process"]
        assert ended(sys.executable, "-c", program, ROOT, *arguments) == 0


def test_no_folder_for_temporary_files_is_left(starry, monkeypatch, tmp_path):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    assert ended(*LAUNCH, "segment", starry / "star.glb", starry / "star.off") == 0
    assert list(temporary.iterdir()) == []
