"""The preferences of the user, as far as jobs ask for them."""

import os
from typing import Protocol, cast

import bpy

from ...compute.memory import available_memory
from ..blender.known_values import present

PACKAGE = __package__.rsplit(".", 2)[0]
# Of processes, unless the user prefers another number: how many at most, and the bytes that each may need.
MOST_PROCESSES, MEMORY_OF_PROCESS = 4, 4e9


class Preferences(Protocol):
    """The preferences, as far as they are read before they are registered."""

    n_threads: int
    n_processes: int


def user_preferences() -> Preferences | None:
    """Return what the user prefers; None where Eigenparts is not installed as an extension, such as in a script."""
    addon = present(bpy.context.preferences).addons.get(PACKAGE)
    return cast(Preferences, addon.preferences) if addon is not None else None


def preferred_threads() -> int:
    """Return how many cores the user wants the matrix libraries to use; 0 leaves that to them."""
    preferences = user_preferences()
    return preferences.n_threads if preferences is not None else 0


def preferred_processes() -> int:
    """Return in how many processes several meshes are analyzed and matched side by side."""
    preferences = user_preferences()
    return (preferences.n_processes if preferences is not None else 0) or fitting_processes()


def fitting_processes() -> int:
    """Return how many processes fit the machine: half of its cores, and no more than its free memory allows."""
    n_cores, n_fitting = os.cpu_count() or 1, available_memory() / MEMORY_OF_PROCESS
    return int(max(1, min(n_cores // 2, n_fitting, MOST_PROCESSES)))
