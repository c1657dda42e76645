"""Start file of the worker process, the only code that changes `sys.path` and `sys.modules`: those of that process.

usage: python worker_start.py HANDLE_OF_THE_CONNECTION
"""

from __future__ import annotations

import importlib
import sys
from multiprocessing import connection
from types import ModuleType


def _add_package(name: str, root: str) -> None:
    """Make the package importable under the name that it has in Blender, without loading what registers it."""
    parts = name.split(".")
    for depth in range(1, len(parts) + 1):
        module = ModuleType(".".join(parts[:depth]))
        module.__path__ = [root] if depth == len(parts) else []
        sys.modules[module.__name__] = module


def _channel(handle: int) -> connection.Connection:
    if sys.platform == "win32":
        return connection.PipeConnection(handle)
    return connection.Connection(handle)


def main(handle: int) -> None:
    """Serve Blender until it closes the connection."""
    channel = _channel(handle)
    package, root, path, folder, is_helper = channel.recv()
    sys.path[:] = path
    _add_package(package, root)
    importlib.import_module(f"{package}.tasks.worker_loop").serve(channel, folder, is_helper)


if __name__ == "__main__":
    main(int(sys.argv[1]))
