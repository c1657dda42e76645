"""The engine: arrays in, arrays out, no Blender; its names are loaded when they are first asked for.

Loading scipy takes its time, and it may be missing: so nothing is loaded before it is used, and ``import compute``
alone needs Python only. Names and modules are declared once, in ``__init__.pyi``, which type checkers read too.

References
----------
.. [1] Scientific Python, SPEC 1, lazy loading of submodules and functions.
"""

import ast
from importlib import import_module
from pathlib import Path
from typing import Any


def _declared(stub: str) -> tuple[dict[str, str], list[str]]:
    """Return the module of each name in a stub, and the names of the scripting API."""
    modules, public = {}, []
    for statement in ast.parse(stub).body:
        if isinstance(statement, ast.ImportFrom):
            modules |= {alias.name: f".{statement.module}" for alias in statement.names}
        elif isinstance(statement, ast.Assign):
            public = ast.literal_eval(statement.value)
    return modules, public


_MODULES, __all__ = _declared(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_MODULES[name], __name__), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULES})
