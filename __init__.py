"""Eigenparts, a Blender extension: meaningful parts of meshes from Laplace-Beltrami eigenfunctions."""

from . import cli, operators, ui


def register() -> None:
    operators.register()
    ui.register()
    cli.register()


def unregister() -> None:
    cli.unregister()
    ui.unregister()
    operators.unregister()
