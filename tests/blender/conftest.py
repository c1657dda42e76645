"""Load the checkout the way Blender loads an extension."""

import importlib.util
import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module")

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def extension():
    """The checkout under its extension name."""
    spec = importlib.util.spec_from_file_location("eigenparts", ROOT / "__init__.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["eigenparts"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(autouse=True)
def fresh_scene(extension):
    """An empty file with the extension enabled."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    extension.register()
    yield
    extension.unregister()
