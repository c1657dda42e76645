"""The preferences of the user, as far as jobs ask for them."""

from typing import Protocol, cast

import bpy

from ..blender.known_values import present

PACKAGE = __package__.rsplit(".", 2)[0]


class Preferences(Protocol):
    """The preferences, as far as they are read before they are registered."""

    n_threads: int


def user_preferences() -> Preferences | None:
    """Return what the user prefers; None where Eigenparts is not installed as an extension, such as in a script."""
    addon = present(bpy.context.preferences).addons.get(PACKAGE)
    return cast(Preferences, addon.preferences) if addon is not None else None


def preferred_threads() -> int:
    """Return how many cores the user wants the matrix libraries to use; 0 leaves that to them."""
    preferences = user_preferences()
    return preferences.n_threads if preferences is not None else 0
