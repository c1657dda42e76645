"""Blender's own builder of extensions and repositories, which comes with the bpy module and runs without loading it."""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

# Where a Blender keeps the tool, and the tags that the extension site knows.
TOOL = "addons_core/bl_pkg/cli/blender_ext.py"
TAGS = "modules/_bpy_internal/extensions/tags.py"


def run_builder(*arguments: object) -> None:
    """Do what ``blender --command extension`` does with these arguments, or end with what it says."""
    run_or_exit(sys.executable, _of_blender(TOOL), *arguments)


def validate(path: Path) -> None:
    """End with what is wrong if the site would refuse the manifest of a folder or zip, or a tag in it."""
    run_builder("validate", path, "--valid-tags", _of_blender(TAGS))


def run_or_exit(*command: object) -> None:
    """Run a command, or end with all that it says."""
    finished = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if finished.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{finished.stdout}{finished.stderr}")


def _of_blender(script: str) -> Path:
    module = find_spec("bpy")
    homes = module.submodule_search_locations if module else None
    if not homes:
        sys.exit("Blender as a Python module is not installed.")
    return next(Path(homes[0]).glob(f"*/scripts/{script}"))
