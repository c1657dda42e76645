"""Limits of the memory of a process."""

import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ... import compute
from ...compute.memory import available_memory

GIGABYTE = 1 << 30
# Only Linux counts the memory of a process so that the count can be limited.
CAN_LIMIT_MEMORY = sys.platform == "linux"
# Rows of a matrix whose products need a buffer of every thread.
BLOCKED = 300
STATUS = Path("/proc/self/status")


def memory_share(n_processes: int) -> float | None:
    """Return the gigabytes that each of some processes may take; None where that cannot be known or limited."""
    share = available_memory() / n_processes / GIGABYTE
    return round(share, 3) if CAN_LIMIT_MEMORY and share < float("inf") else None


@contextmanager
def memory_limited(gigabytes: float | None) -> Iterator[None]:
    """Let this process have so much memory meanwhile, beyond what it has already."""
    if gigabytes is None or not CAN_LIMIT_MEMORY:
        yield
        return
    import resource

    _take_buffers()
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    most = _data_size() + int(gigabytes * GIGABYTE)
    resource.setrlimit(resource.RLIMIT_DATA, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


def _take_buffers() -> None:
    """Let the libraries of linear algebra take their buffers, which they would ask for again and again at a limit."""
    octahedron = np.concatenate([np.eye(3), -np.eye(3)])
    corners = itertools.product((0, 3), (1, 4), (2, 5))
    compute.analyze(compute.TriangleMesh(octahedron, np.array([sorted(face) for face in corners])))
    np.linalg.eigvalsh(np.eye(BLOCKED) @ np.eye(BLOCKED))


def _data_size() -> int:
    """Return the bytes that the system counts as data of this process: most of them are stacks and never used."""
    for line in STATUS.read_text().splitlines():
        name, _, amount = line.partition(":")
        if name == "VmData":
            return 1024 * int(amount.split()[0])
    return 0
