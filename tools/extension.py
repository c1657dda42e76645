"""Load the checkout the way Blender loads an extension, whatever its folder is called."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = "eigenparts"


def load_extension() -> ModuleType:
    """Return the checkout as the package ``eigenparts``; it is not registered yet."""
    if PACKAGE not in sys.modules:
        init = ROOT / "__init__.py"
        spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(ROOT)])
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = module
        spec.loader.exec_module(module)
    return sys.modules[PACKAGE]
