"""Find the tests that a change touches, by reading imports.

A file names the modules that it imports, those behind the public names of the engine (``compute/__init__.pyi``), and
those of the operators that it calls (``bpy.ops.eigenparts.cut``).
"""

import ast
import re
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path

PACKAGE = "eigenparts"
# Run whatever was changed: a second, and the rules of the whole.
CORE = "tests/test_architecture.py"
# Public names of the engine and operators where they are used.
_DOTTED = re.compile(rf"\bcompute\.\w+|\bbpy\.ops\.{PACKAGE}\.\w+")
# What stands for a folder that tests do not name module by module.
TESTS_OF_FOLDER = {
    "ui": ("tests/blender/test_drawn.py", "tests/blender/test_translations.py"),
    "presets": ("tests/blender/test_preferences.py",),
    "docs": ("tests/docs",),
    "cli": ("tests/cli",),
    "examples": ("tests/examples",),
    "tools": ("tests/tools",),
}


def changed_files(root: Path, *, main: str = "main") -> list[str]:
    """Return the files that differ from where the branch left ``main``, those included that are not committed yet.

    Returns
    -------
    list of str
        Paths from ``root``, sorted; files that were deleted are left out.
    """
    base = _git(root, "merge-base", main, "HEAD") or ["HEAD"]
    changed = _git(root, "diff", "--name-only", "--diff-filter=d", base[0])
    return sorted({*changed, *_git(root, "ls-files", "--others", "--exclude-standard")})


def touched_tests(root: Path, changed: Iterable[str]) -> list[str]:
    """Return the tests that changed files touch, the nearest first.

    Parameters
    ----------
    root : Path
        Of the checkout.
    changed : iterable of str
        Paths of files from ``root``.

    Returns
    -------
    list of str
        Paths from ``root``: tests that were changed or are called after a module that was; tests that name such a
        module; the tests of its room; those that name it by what they import; at last the core.
    """
    changed = {path for path in changed if (root / path).exists()}
    called = {f"test_{Path(path).stem}" for path in changed if path.endswith(".py")}
    importers = {path for path in _modules(root) if _named_in(root, path) & changed}
    tests = [path for path in _modules(root) if _is_test(path)]
    rooms = [room for path in sorted(changed) for room in _room_of(root, path)]
    by_distance = [
        [path for path in tests if path in changed or Path(path).stem in called],
        [path for path in tests if _named_in(root, path) & changed],
        rooms,
        [path for path in tests if _named_in(root, path) & importers],
        [CORE],
    ]
    return _without_repeats([path for paths in by_distance for path in paths])


def _without_repeats(paths: list[str]) -> list[str]:
    """Leave out what was named before, by itself or with its folder."""
    kept: list[str] = []
    for path in paths:
        if not any(path == other or path.startswith(f"{other}/") for other in kept):
            kept.append(path)
    return kept


def _room_of(root: Path, path: str) -> list[str]:
    """Return the tests of the room that a module is in: ``tests/compute/fem`` for ``compute/fem/space.py``."""
    folder = path.split("/")[0]
    if folder in TESTS_OF_FOLDER:
        return [test for test in TESTS_OF_FOLDER[folder] if (root / test).exists()]
    room = Path("tests", path).parent
    # Folders of tests as a whole are no rooms: they take longer than the change is worth.
    is_room = len(room.parts) > 2 and path.endswith(".py") and folder != "tests" and (root / room).is_dir()
    return [room.as_posix()] if is_room else []


@cache
def _named_in(root: Path, path: str) -> frozenset[str]:
    """Return the files of the project that a file names: by imports, names of the engine, and operators."""
    text = (root / path).read_text()
    names = _imported(path, ast.parse(text)) | set(_DOTTED.findall(text))
    known = _public_names(root) | _operators(root)
    modules = {file for name in names for file in _files_of(name)} & set(_modules(root))
    return frozenset(modules | {known[name] for name in names & known.keys()} - {path})


def _imported(path: str, tree: ast.Module) -> set[str]:
    """Return what a file imports, also within functions, as "compute.surface.mesh" and what it takes from there."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= _imported_from(path, node)
    return names


def _imported_from(path: str, node: ast.ImportFrom) -> set[str]:
    folders = path.split("/")[:-1]
    base = folders[: len(folders) - node.level + 1] if node.level else []
    whole = ".".join([*base, *filter(None, [node.module])]).removeprefix(f"{PACKAGE}.")
    return {whole, *(f"{whole}.{alias.name}".lstrip(".") for alias in node.names)}


def _files_of(module: str) -> tuple[str, ...]:
    path = module.removeprefix(f"{PACKAGE}.").replace(".", "/")
    return f"{path}.py", f"{path}/__init__.py"


@cache
def _public_names(root: Path) -> dict[str, str]:
    """Return the file behind each public name of the engine, as ``compute.analyze``."""
    declared = root / "compute" / "__init__.pyi"
    if not declared.is_file():
        return {}
    imports = [node for node in ast.parse(declared.read_text()).body if isinstance(node, ast.ImportFrom)]
    return {
        f"compute.{alias.name}": f"compute/{(node.module or '').replace('.', '/')}.py"
        for node in imports
        for alias in node.names
    }


@cache
def _operators(root: Path) -> dict[str, str]:
    """Return the file of each operator, as ``bpy.ops.eigenparts.cut``."""
    named = re.compile(rf'bl_idname = "({PACKAGE}\.\w+)"')
    return {
        f"bpy.ops.{name}": path
        for path in _files(root, "operators")
        for name in named.findall((root / path).read_text())
    }


@cache
def _modules(root: Path) -> tuple[str, ...]:
    folders = ("compute", "tasks", "operators", "ui", "cli", "examples", "tools", "tests")
    return tuple(path for folder in folders for path in _files(root, folder))


@cache
def _files(root: Path, folder: str) -> tuple[str, ...]:
    return tuple(path.relative_to(root).as_posix() for path in sorted((root / folder).rglob("*.py")))


def _is_test(path: str) -> bool:
    return Path(path).name.startswith("test_") and not path.startswith("tests/window/")


def _git(root: Path, *arguments: str) -> list[str]:
    """Return the lines that git answers, none if it refuses."""
    answer = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True)
    return answer.stdout.split("\n")[:-1] if answer.returncode == 0 else []
