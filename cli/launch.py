"""Start the command line in a Python that has Blender as a module, wherever this file lies.

usage: python -P launch.py FOLDER_OF_SCIPY COMMAND...
"""

import importlib.util
import sys
from pathlib import Path

PACKAGE = "eigenparts"


def main(arguments: list[str]) -> None:
    """Run a command with the package that this file is part of, and end with its exit code."""
    folder_of_scipy, *argv = arguments
    # An extension has its libraries in a folder that only Blender's preferences know.
    sys.path.append(folder_of_scipy)
    init = Path(__file__).resolve().parents[1] / "__init__.py"
    spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(init.parent)])
    assert spec is not None
    assert spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    package.cli.processes.ending.end_process(package.cli.main(argv))


if __name__ == "__main__":
    main(sys.argv[1:])
