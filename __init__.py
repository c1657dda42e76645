"""Eigenparts, a Blender extension: meaningful parts of meshes from Laplace-Beltrami eigenfunctions."""

import atexit

from . import cli, operators, ui


def register() -> None:
    operators.register()
    ui.register()
    cli.register()
    if cli.is_module():
        # Otherwise Python waits for ever at its end, or ends with a crash.
        atexit.register(unregister)


def unregister() -> None:
    atexit.unregister(unregister)
    cli.unregister()
    ui.unregister()
    operators.unregister()
