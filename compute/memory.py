"""Memory at hand: work that will not fit is refused before it starts, and a full memory is told in a sentence."""

import ctypes
import os
import sys
from collections.abc import Callable, Iterator
from functools import wraps
from pathlib import Path
from typing import ParamSpec, TypeVar

import numpy as np

from .errors import MeshError

PROC = Path("/proc")
# What a group of processes (a container, a job) may have: names of limit, use and of the cache that it can give back.
GROUP_FILES = {
    "cgroup2": (("memory.max", "memory.high"), "memory.current", "inactive_file"),
    "cgroup": (("memory.limit_in_bytes",), "memory.usage_in_bytes", "total_inactive_file"),
}
# Rows of a matrix that is too large to be worked on without a buffer.
SIZE_WITH_BUFFERS = 200
FULL = "The memory is full; take elements of a lower order, or decimate the mesh."

_Parameters = ParamSpec("_Parameters")
_Result = TypeVar("_Result")


class _MemoryStatus(ctypes.Structure):
    """The structure in which Windows reports its memory (MEMORYSTATUSEX)."""

    _fields_ = (
        ("length", ctypes.c_uint32),
        ("load", ctypes.c_uint32),
        *(
            (name, ctypes.c_uint64)
            for name in (
                "total",
                "available",
                "page_total",
                "page_available",
                "virtual",
                "virtual_available",
                "extended",
            )
        ),
    )


def available_memory() -> float:
    """Return the bytes that this process can have without swapping; all there are where the system reports only those.

    The least of what is free in the machine, in every group of processes this one is in (container, job), and within
    the limits of the process. Infinite where nothing is reported.
    """
    if sys.platform == "win32":
        return _available_on_windows()
    return min([_free_in_machine(), *_free_in_groups(), *_free_in_process()])


def require_memory(needed: float, refusal: str, *numbers: int) -> None:
    """Refuse work that needs more bytes than there are.

    Parameters
    ----------
    needed : float
    refusal : str
        The sentence, with places for the numbers, for what is needed and for what is free.
    numbers : int
        What the need follows from, such as vertices.

    Raises
    ------
    MeshError
        If the memory at hand is less.
    """
    at_hand = available_memory()
    if needed > at_hand:
        raise MeshError(refusal.format(*numbers, _amount(needed), _amount(at_hand)))


def claim_buffers() -> None:
    """Let the matrix libraries take their buffers now: once the memory is full, OpenBLAS tries to for ever."""
    # Loaded here, as most who ask for memory need no scipy.
    import scipy.linalg

    matrix = np.eye(SIZE_WITH_BUFFERS)
    np.linalg.inv(matrix)
    scipy.linalg.inv(matrix)


def _amount(n_bytes: float) -> str:
    return f"{n_bytes / 1e9:.1f} GB" if n_bytes >= 1e9 else f"{n_bytes / 1e6:.1f} MB"


def told_if_full(work: Callable[_Parameters, _Result]) -> Callable[_Parameters, _Result]:
    """Let a function tell in a sentence that the memory is full."""

    @wraps(work)
    def telling(*arguments: _Parameters.args, **options: _Parameters.kwargs) -> _Result:
        try:
            return work(*arguments, **options)
        except MemoryError as error:
            raise MeshError(FULL) from error

    return telling


def _available_on_windows() -> float:
    """Return the memory that is free and may be committed; the latter keeps to the limits of a job."""
    status = _MemoryStatus(length=ctypes.sizeof(_MemoryStatus))
    known = ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status))  # type: ignore[attr-defined,unused-ignore]
    return float(min(status.available, status.page_available)) if known else float("inf")


def _free_in_machine() -> float:
    for line in _lines(PROC / "meminfo"):
        name, _, amount = line.partition(":")
        if name == "MemAvailable":
            return 1024.0 * int(amount.split()[0])
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


def _free_in_groups() -> Iterator[float]:
    """Yield the free bytes of each group that this process is in, from the innermost outward."""
    paths = {}
    for line in _lines(PROC / "self" / "cgroup"):
        number, controllers, path = line.split(":", 2)
        if number == "0" or "memory" in controllers.split(","):
            paths["cgroup2" if number == "0" else "cgroup"] = path
    for line in _lines(PROC / "self" / "mountinfo"):
        mount, _, system = line.partition(" - ")
        kind, _, options = system.split(" ", 2)
        if kind in paths and (kind == "cgroup2" or "memory" in options.split(" ")[-1].split(",")):
            _, _, _, root, place, *_ = mount.split(" ")
            yield from _free_along(Path(place), _below(paths[kind], root), *GROUP_FILES[kind])


def _below(path: str, root: str) -> tuple[str, ...]:
    """Return the folders from a mounted root to a group; none where the group lies elsewhere, as in some containers."""
    parts, root_parts = Path(path).parts[1:], Path(root).parts[1:]
    inside = parts[: len(root_parts)] == root_parts and ".." not in parts
    return parts[len(root_parts) :] if inside else ()


def _free_along(
    place: Path, folders: tuple[str, ...], limits: tuple[str, ...], use: str, cache: str
) -> Iterator[float]:
    for depth in range(len(folders), -1, -1):
        group = place.joinpath(*folders[:depth])
        allowed = min((_number(line) for name in limits for line in _lines(group / name)), default=float("inf"))
        used = sum(_number(line) for line in _lines(group / use))
        given_back = sum(
            _number(value) for name, value in map(str.split, _lines(group / "memory.stat")) if name == cache
        )
        if allowed < float("inf"):
            yield max(allowed - used + given_back, 0.0)


def _free_in_process() -> Iterator[float]:
    """Yield what the limits of this process leave of its address space and of its data."""
    try:
        import resource
    except ImportError:
        return
    pages = next((line.split() for line in _lines(PROC / "self" / "statm")), None)
    if pages is None:
        return
    for limit, place in ((resource.RLIMIT_AS, 0), (resource.RLIMIT_DATA, 5)):
        allowed = resource.getrlimit(limit)[0]
        if allowed != resource.RLIM_INFINITY:
            yield max(float(allowed - int(pages[place]) * resource.getpagesize()), 0.0)


def _lines(path: Path) -> list[str]:
    """Return the lines of a file of the system, none if it cannot be read."""
    try:
        return path.read_text().splitlines()
    except OSError:
        return []


def _number(text: str) -> float:
    return float("inf") if text.strip() == "max" else float(text)
