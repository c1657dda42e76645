"""The field's persistence diagram, Morse-Smale complex and eigenfunctions. Imports parts and what it does."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["plot_diagram", "trace_complex", "write_eigenfunctions"]
)
