"""Run the command line with the bpy module: ``python path/to/eigenparts/cli segment FILE...``."""

import importlib.util
import sys
from pathlib import Path

PACKAGE = "eigenparts"


def load_extension() -> None:
    """Import the folder above as the package it is, whatever the folder is called."""
    init = Path(__file__).resolve().parents[1] / "__init__.py"
    spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(init.parent)])
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)


if __name__ == "__main__":
    load_extension()
    sys.exit(sys.modules[f"{PACKAGE}.cli"].main(sys.argv[1:]))
