"""Which tests a change touches."""

import subprocess
from pathlib import Path

import pytest

from tools.touched import changed_files, touched_tests

FILES = {
    "compute/__init__.pyi": "from .surface.mesh import Mesh as Mesh\nfrom .fem.solver import solve as solve\n",
    "compute/surface/mesh.py": "class Mesh: ...",
    "compute/fem/space.py": "from ..surface.mesh import Mesh",
    "compute/fem/solver.py": "from .space import numbering",
    "compute/spectrum.py": "from .fem.solver import solve",
    "operators/cut.py": 'from .. import compute\nbl_idname = "eigenparts.cut"\ncompute.solve()',
    "operators/paint.py": 'from .cut import stroke\nbl_idname = "eigenparts.paint"',
    "ui/panel.py": "",
    "docs/method.md": "",
    "tests/shapes.py": "from compute import Mesh",
    "tests/test_architecture.py": "",
    "tests/docs/test_pages.py": "",
    "tests/compute/test_mesh.py": "",
    "tests/compute/fem/test_orders.py": "",
    "tests/compute/fem/test_numbering.py": "def test_it():\n    from compute.fem.space import numbering",
    "tests/compute/test_values.py": "import compute.fem.solver",
    "tests/blender/test_drawn.py": "",
    "tests/blender/test_cutting.py": "bpy.ops.eigenparts.cut(method='INSERT')",
    "tests/blender/test_stroke.py": "from eigenparts.operators.paint import stroke",
    "tests/blender/test_shapes_there.py": "from tests.shapes import star",
}
CORE = ["tests/test_architecture.py"]
FEM = ["tests/compute/fem/test_numbering.py", "tests/compute/fem"]


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    root = tmp_path_factory.mktemp("project")
    for path, text in FILES.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)
    return root


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        # By its import, then the room, then those that use what uses it.
        ("compute/fem/space.py", [*FEM, "tests/compute/test_values.py"]),
        # By its name; those that come to it through another module follow.
        ("compute/surface/mesh.py", ["tests/compute/test_mesh.py", "tests/blender/test_shapes_there.py", FEM[0]]),
        ("operators/cut.py", ["tests/blender/test_cutting.py", "tests/blender/test_stroke.py"]),
        # Public names of the engine lead to their module.
        ("compute/fem/solver.py", ["tests/compute/test_values.py", FEM[1], "tests/blender/test_cutting.py"]),
        ("ui/panel.py", ["tests/blender/test_drawn.py"]),
        ("docs/method.md", ["tests/docs"]),
        ("tests/compute/fem/test_orders.py", ["tests/compute/fem/test_orders.py"]),
        ("tests/shapes.py", ["tests/blender/test_shapes_there.py"]),
        ("README.md", []),
        ("deleted.py", []),
    ],
)
def test_the_nearest_tests_come_first_and_the_core_last(project, changed, expected):
    assert touched_tests(project, [changed]) == [*expected, *CORE]


def test_every_test_is_named_once(project):
    tests = touched_tests(project, FILES)
    assert len(set(tests)) == len(tests)
    assert all((project / path).exists() for path in tests)


def git(root, *arguments):
    identity = ["-c", "user.name=Somebody", "-c", "user.email=somebody@example.org"]
    subprocess.run(["git", *identity, *arguments], cwd=root, check=True, capture_output=True)


def test_a_change_is_all_since_main_also_what_is_not_committed(tmp_path):
    for name in ("kept.py", "edited.py", "deleted.py"):
        (tmp_path / name).write_text("first")
    git(tmp_path, "init", "--initial-branch=main")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--message=first")
    assert changed_files(tmp_path) == []
    git(tmp_path, "switch", "--create=branch")
    (tmp_path / "committed.py").touch()
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--message=second")
    (tmp_path / "edited.py").write_text("second")
    (tmp_path / "new.py").touch()
    (tmp_path / "deleted.py").unlink()
    assert changed_files(tmp_path) == ["committed.py", "edited.py", "new.py"]


def test_each_operator_of_the_project_leads_to_a_test_of_blender():
    root = Path(__file__).parents[2]
    for path in (root / "operators").rglob("*.py"):
        # Presets are added by what Blender has for it.
        if 'bl_idname = "eigenparts.' in path.read_text() and "preset" not in path.stem:
            tests = touched_tests(root, [path.relative_to(root).as_posix()])
            assert any(test.startswith("tests/blender/") for test in tests), path
