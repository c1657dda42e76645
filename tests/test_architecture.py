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
    # What a worker process runs: with this rule, nothing that it imports imports anything of Blender.
    "tasks": {"compute"},
    "operators": {"compute", "tasks"},
    "cli": {"compute", "operators", "tasks"},
    "ui": {
        *("operators.blender", "operators.mesh_state", "operators.messages", "operators.outputs.output_registry"),
        *("operators.parts.border_lines", "operators.parts.part_outline", "operators.mesh_data.selected_meshes"),
    },
}
OUTSIDE = {
    "compute": {"numpy", "scipy"},
    "tasks": {"numpy"},
    "operators": {"bl_operators", "bmesh", "bpy", "bpy_extras", "mathutils", "numpy"},
    "cli": {"bpy", "distributed", "numpy"},
    "ui": {"bl_ui", "blf", "bpy", "bpy_extras", "gpu", "gpu_extras", "mathutils", "numpy"},
}

# With it loaded, a Python that has Blender as a module may wait for ever at its end (`cli/processes/ending.py`).
NOWHERE = "scipy.optimize"

# What runs inside Blender, which supports no threads of Python's; the extension site refuses them.
IN_BLENDER = ("compute", "tasks", "operators", "ui")
THREADS = (
    *("threading", "_thread", "queue", "asyncio", "concurrent"),
    *("multiprocessing.pool", "multiprocessing.dummy", "multiprocessing.managers", "multiprocessing.queues"),
)
# Methods of `sys.path` and `sys.modules` that change nothing.
READING = ("get", "keys", "values", "items", "copy", "index", "count")

# The rooms of a folder, each of which may import only those that stand before it.
ORDER = {
    # The path of the data, read from left to right.
    "compute": [
        *("choices", "errors", "progress", "memory", "surface", "fem", "fields", "msc", "segmentation", "analysis"),
        *("registration", "skeletons"),
    ],
    "compute.segmentation": ["hierarchy", "faces", "borders", "edits", "parts"],
    "compute.registration": ["eigenfunctions", "dense", "parts", "paper"],
    "operators": [
        *("blender", "messages", "mesh_data", "mesh_state", "outputs", "jobs", "parts", "corrections", "registration"),
        *("transfer", "armature", "topology", "settings"),
    ],
    "cli": [
        *("reports", "jobs", "results", "processes", "formats", "objects", "segmenting", "registering", "transferring"),
        *("run_serial", "batch", "run", "arguments", "launch"),
    ],
}


def violations(root: Path) -> set[str]:
    """Return every import below ``root`` that breaks a rule, as "compute/surface/mesh.py: ..operators"."""
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
        allowed = module.split(".")[0] in OUTSIDE.get(home, set()) | set(sys.stdlib_module_names)
        return allowed and not module.startswith(NOWHERE)
    imported = module[1:].split(".")
    if imported[0] != home:
        return any(f"{module[1:]}.".startswith(f"{goal}.") for goal in MAY_IMPORT[home])
    return all(keeps_order(ORDER[folder], folder.split("."), importer, imported) for folder in ORDER)


def keeps_order(order: list[str], folder: list[str], importer: tuple[str, ...], imported: list[str]) -> bool:
    """Whether an import inside a folder goes to the same room or to one before it."""
    depth = len(folder)
    if list(importer[:depth]) != folder or imported[:depth] != folder or len(imported) == depth:
        return True
    # A folder's own __init__ and __main__ come last.
    return importer[depth].startswith("__") or order.index(importer[depth]) >= order.index(imported[depth])


def modules_with_threads(root: Path) -> set[str]:
    """Return every file of what runs inside Blender that imports threads: Blender supports none of Python's."""
    files = [root / "__init__.py", *(path for room in IN_BLENDER for path in sorted((root / room).rglob("*.py")))]
    return {
        str(path.relative_to(root))
        for path in files
        for module in imported_modules(path.relative_to(root).with_suffix("").parts, ast.parse(path.read_text()))
        if module.startswith(THREADS)
    }


def modules_that_change_imports(root: Path) -> set[str]:
    """Return every file of what runs inside Blender that has something to do with `sys.modules` or sets `sys.path`."""
    return {
        str(path.relative_to(root))
        for path in [root / "__init__.py", *(path for room in IN_BLENDER for path in (root / room).rglob("*.py"))]
        if any(changes_imports(node) for node in ast.walk(ast.parse(path.read_text())))
    }


def changes_imports(node: ast.AST) -> bool:
    """Whether a statement or call changes `sys.path`, `sys.meta_path` or `sys.modules`."""
    if isinstance(node, ast.Assign | ast.AugAssign | ast.Delete):
        targets = [node.target] if isinstance(node, ast.AugAssign) else node.targets
        return any(is_of_imports(target.value if isinstance(target, ast.Subscript) else target) for target in targets)
    is_method = isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
    return is_method and node.func.attr not in READING and is_of_imports(node.func.value)


def is_of_imports(node: ast.AST) -> bool:
    """Whether an expression is one of the variables that decide what is imported."""
    return ast.unparse(node) in ("sys.path", "sys.meta_path", "sys.modules")


def test_nothing_in_blender_imports_threads():
    assert modules_with_threads(ROOT) == set()


def test_nothing_in_blender_changes_what_is_imported():
    assert modules_that_change_imports(ROOT) == {"tasks/worker_start.py"}


@pytest.mark.parametrize("line", ["import threading", "from concurrent.futures import wait", "from queue import Queue"])
def test_a_thread_is_noticed(tmp_path, line):
    (tmp_path / "__init__.py").write_text(line)
    assert modules_with_threads(tmp_path) == {"__init__.py"}


@pytest.mark.parametrize(
    "line", ["sys.path.append('')", "sys.path[:] = []", "sys.modules['bpy'] = 1", "del sys.modules['bpy']"]
)
def test_a_changed_path_is_noticed(tmp_path, line):
    (tmp_path / "__init__.py").write_text(line)
    assert modules_that_change_imports(tmp_path) == {"__init__.py"}


def test_every_import_keeps_its_direction():
    assert violations(ROOT) == set()


@pytest.mark.parametrize("folder", ORDER)
def test_every_room_has_a_place_in_the_order(folder):
    rooms = {
        path.stem for path in (ROOT / folder.replace(".", "/")).glob("[!_]*") if path.suffix == ".py" or path.is_dir()
    }
    assert rooms == set(ORDER[folder])


def test_every_room_says_what_lives_there():
    rooms = [path for folder in OUTSIDE for path in (ROOT / folder).rglob("*/") if any(path.glob("*.py"))]
    assert len(rooms) > 20
    for room in rooms:
        assert (ast.get_docstring(ast.parse((room / "__init__.py").read_text())) or "").endswith("."), room


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("compute/surface/mesh.py", "import bpy"),
        ("compute/surface/mesh.py", "from ..fem.space import numbering"),
        ("compute/fem/space.py", "from scipy.optimize import linear_sum_assignment"),
        ("compute/fem/space.py", "from ..analysis import analyze"),
        ("compute/fem/space.py", "from ...operators import mesh_data"),
        ("tasks/layers.py", "import bpy"),
        ("tasks/layers.py", "from ..operators.mesh_data import mesh_arrays"),
        ("compute/fem/space.py", "from ...tasks import threads"),
        ("operators/parts/analyze.py", "from ...ui import panel"),
        ("operators/parts/analyze.py", "from ... import cli"),
        ("operators/parts/analyze.py", "import scipy.sparse"),
        ("operators/parts/analyze.py", "from ..corrections import cut"),
        ("operators/mesh_state/state.py", "from ..outputs.part_writer import segment_mesh"),
        ("compute/segmentation/faces/branches.py", "from ..parts.part_labels import Parts"),
        ("compute/registration/eigenfunctions/matching.py", "from ..dense.correspondence import correspond"),
        ("cli/__init__.py", "from ..ui.panel import draw"),
        ("cli/processes/pool.py", "from ..formats import load"),
        ("ui/panel.py", "from ..compute.surface.mesh import TriangleMesh"),
        ("ui/panel.py", "from ..operators.mesh_data import mesh_arrays"),
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
        ("compute/fem/space.py", "from ..surface.mesh import TriangleMesh"),
        ("compute/fem/space.py", "from .lagrange import basis"),
        ("compute/fem/space.py", "import numpy.linalg"),
        ("compute/__init__.py", "from .skeletons.embedding import skeleton"),
        ("compute/registration/parts/population.py", "from ..dense.point_map import point_map"),
        ("operators/parts/analyze.py", "from ..mesh_state.state import load"),
        ("tasks/layers.py", "from .. import compute"),
        ("operators/parts/analyze.py", "from ... import compute"),
        ("operators/parts/analyze.py", "from ...tasks import mesh_analysis"),
        ("cli/__main__.py", "from . import main"),
        ("cli/formats/obj.py", "from ..results.stages import write_surely"),
        ("ui/panel.py", "from ..operators.mesh_state import state"),
        ("ui/panel.py", "from ..operators.mesh_state.state import read"),
        ("__init__.py", "from . import cli, operators, ui"),
    ],
)
def test_a_kept_rule_is_no_violation(tmp_path, file, line):
    (tmp_path / "__init__.py").touch()
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text(line)
    assert violations(tmp_path) == set()
