"""Memory at hand, so that work which will not fit is refused before it starts."""

import ctypes
import os
import sys
from pathlib import Path

MEMINFO = Path("/proc/meminfo")


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
    """Return the bytes that can be had without swapping; all there are where the system reports only those.

    Infinite where it reports nothing.
    """
    if sys.platform == "win32":
        status = _MemoryStatus(length=ctypes.sizeof(_MemoryStatus))
        known = ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status))
        return float(status.available) if known else float("inf")
    if MEMINFO.is_file():
        for line in MEMINFO.read_text().splitlines():
            name, _, amount = line.partition(":")
            if name == "MemAvailable":
                return 1024.0 * int(amount.split()[0])
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (ValueError, OSError):
        return float("inf")
