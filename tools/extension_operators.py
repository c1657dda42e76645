"""Calls of the operators of the extension, without what Blender writes meanwhile."""

import bpy

from eigenparts.cli.processes.suppress_output import blender_is_quiet
from tools.extension import PACKAGE


def run_operator(name: str, **options: object) -> None:
    """Run an operator of the extension by its name without "eigenparts.", as ``run_operator("segment", level=3)``."""
    with blender_is_quiet():
        getattr(getattr(bpy.ops, PACKAGE), name)(**options)
