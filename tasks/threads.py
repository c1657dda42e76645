"""Number of processor cores that the matrix libraries of numpy and scipy use."""

import ctypes
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

# Where their wheels keep the library, beside the package and inside it, and what the setting is called there.
FOLDERS = ("../{package}.libs", ".dylibs")
SETTINGS = (
    *("scipy_openblas_set_num_threads", "scipy_openblas_set_num_threads64_"),
    *("openblas_set_num_threads", "openblas_set_num_threads64_"),
)


def use_threads(n_threads: int) -> int:
    """Let the matrix libraries use so many cores, as many as they like if 0; return how many libraries heard it."""
    setters = list(_setters()) if n_threads else []
    for setter in setters:
        setter(n_threads)
    return len(setters)


def _setters() -> Iterator[Callable[[int], None]]:
    for library in _libraries():
        yield from (getattr(library, name) for name in SETTINGS if hasattr(library, name))


def _libraries() -> Iterator[ctypes.CDLL]:
    """Yield the OpenBLAS of each package; one that is loaded already is not loaded again."""
    for package in ("numpy", "scipy"):
        spec = find_spec(package)
        if spec is None or spec.origin is None:
            continue
        home = Path(spec.origin).parent
        for folder in FOLDERS:
            for path in sorted((home / folder.format(package=package)).glob("*openblas*")):
                yield ctypes.CDLL(str(path.resolve()))
