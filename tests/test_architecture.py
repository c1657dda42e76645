"""The import rules of the project, so that a broken rule fails like any other bug."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

# What each folder may import of the others.
MAY_IMPORT = {
    "__init__": {"operators", "ui", "cli"},
    "compute": set(),
    "operators": {"compute"},
    "cli": {"compute", "operators"},
    "ui": {
        *("operators.state", "operators.palette", "operators.registered", "operators.faults"),
        *("operators.border_lines", "operators.part_outline", "operators.function_hints", "operators.sentences"),
    },
}
OUTSIDE = {
    "compute": {"numpy", "scipy"},
    "operators": {"bl_operators", "bmesh", "bpy", "bpy_extras", "mathutils", "numpy"},
    "cli": {"bpy", "distributed", "numpy"},
    "ui": {"bl_ui", "bpy", "gpu", "gpu_extras", "mathutils"},
}

# A part of the engine may import only parts that stand before it: the path of the data, read from left to right.
PIPELINE = [
    *("errors", "progress", "memory", "mesh", "shells", "surface", "orientation", "geodesics", "fem", "fields"),
    *("field_choice", "shell_fields", "matching_basis", "msc", "segmentation", "analysis", "registration", "skeleton"),
]


def violations(root: Path) -> set[str]:
    """Return every import below ``root`` that breaks a rule, as "compute/mesh.py: ..operators"."""
    files = [root / "__init__.py", *(path for folder in OUTSIDE for path in sorted((root / folder).rglob("*.py")))]
    return {
        f"{path.relative_to(root)}: {module}"
        for path in files
        for module in imported_modules(path.relative_to(root).with_suffix("").parts, ast.parse(path.read_text()))
        if not is_allowed(path.relative_to(root).with_suffix("").parts, module)
    }


def imported_modules(importer: tuple[str, ...], tree: ast.Module) -> set[str]:
    """Return what a file imports: "numpy.linalg", and "/compute.mesh" for a module of the project."""
    modules = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            modules.add(node.module)
        elif isinstance(node, ast.ImportFrom):
            base = [*importer[: len(importer) - node.level], *(node.module or "").split(".")]
            modules |= {"/" + ".".join(filter(None, [*base, alias.name])) for alias in node.names}
    return modules


def is_allowed(importer: tuple[str, ...], module: str) -> bool:
    """Whether one import keeps the rules; Python's own modules are always allowed."""
    home = importer[0]
    if not module.startswith("/"):
        return module.split(".")[0] in OUTSIDE.get(home, set()) | set(sys.stdlib_module_names)
    folder, *inner = module[1:].split(".")
    if folder != home:
        return any(f"{module[1:]}.".startswith(f"{goal}.") for goal in MAY_IMPORT[home])
    return home != "compute" or not inner or position(importer[1]) >= position(inner[0])


def position(part: str) -> int:
    """Return the place of an engine part in the pipeline; the package's own __init__ comes last."""
    return len(PIPELINE) if part == "__init__" else PIPELINE.index(part)


def test_every_import_keeps_its_direction():
    assert violations(ROOT) == set()


def test_every_engine_module_has_a_place_in_the_pipeline():
    parts = {path.stem for path in (ROOT / "compute").glob("[!_]*") if path.suffix in ("", ".py")}
    assert parts <= set(PIPELINE)


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("compute/mesh.py", "import bpy"),
        ("compute/mesh.py", "from .fem.space import numbering"),
        ("compute/fem/space.py", "from ..analysis import analyze"),
        ("compute/fem/space.py", "from ...operators import exchange"),
        ("operators/analyze.py", "from ..ui import panel"),
        ("operators/analyze.py", "from .. import cli"),
        ("operators/analyze.py", "import scipy.sparse"),
        ("cli/__init__.py", "from ..ui.panel import draw"),
        ("ui/panel.py", "from ..compute.mesh import TriangleMesh"),
        ("ui/panel.py", "from ..operators import exchange"),
        ("__init__.py", "from . import compute"),
    ],
)
def test_a_broken_rule_is_noticed(tmp_path, file, line):
    (tmp_path / "__init__.py").touch()
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text(line)
    assert len(violations(tmp_path)) == 1


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("compute/analysis.py", "from .fem.space import numbering"),
        ("compute/fem/space.py", "from ..mesh import TriangleMesh"),
        ("compute/fem/space.py", "from .lagrange import basis"),
        ("compute/fem/space.py", "import numpy.linalg"),
        ("compute/__init__.py", "from .skeleton import skeleton"),
        ("operators/analyze.py", "from .. import compute"),
        ("ui/panel.py", "from ..operators import state"),
        ("ui/panel.py", "from ..operators.state import read"),
        ("__init__.py", "from . import cli, operators, ui"),
    ],
)
def test_a_kept_rule_is_no_violation(tmp_path, file, line):
    (tmp_path / "__init__.py").touch()
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text(line)
    assert violations(tmp_path) == set()
