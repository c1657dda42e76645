"""Start file of the worker process, the only code that changes `sys.path` and `sys.modules`: those of that process.

usage: python worker_start.py HANDLE_OF_THE_CONNECTION

Modules of the extension that compute are in one package with those that write to Blender, so what they import of
Blender is stood in for: classes can be derived from it, and nothing of it does anything.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator, Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from multiprocessing import connection
from types import ModuleType
from typing import Any

BLENDER = {"bl_operators", "bmesh", "bpy", "bpy_extras", "gpu", "mathutils"}


class _StandInType(type):
    """Type of the classes that stand for names of Blender's modules: any name, call or pair of values is one more."""

    def __getattr__(cls, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return _stand_in(name)

    def __call__(cls, *arguments: Any, **options: Any) -> Any:
        return _stand_in(cls.__name__) if "is_stand_in" in vars(cls) else super().__call__(*arguments, **options)

    def __iter__(cls) -> Iterator[type]:
        return iter((_stand_in(cls.__name__), _stand_in(cls.__name__)))


def _stand_in(name: str) -> type:
    return _StandInType(name, (), {"is_stand_in": True})


class _BlenderModule(ModuleType):
    """A module of Blender's, in which every name stands for something."""

    __path__: list[str] = []

    def __getattr__(self, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return _stand_in(name)


class _BlenderFinder(MetaPathFinder, Loader):
    """Finds Blender's modules where there is no Blender."""

    def find_spec(self, name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> ModuleSpec | None:
        return ModuleSpec(name, self, is_package=True) if name.split(".")[0] in BLENDER else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _BlenderModule(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Leave the module as it is."""


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
    package, root, path, folder = channel.recv()
    sys.path[:] = path
    sys.meta_path.insert(0, _BlenderFinder())
    _add_package(package, root)
    importlib.import_module(f"{package}.operators.jobs.worker_loop").serve(channel, folder)


if __name__ == "__main__":
    main(int(sys.argv[1]))
