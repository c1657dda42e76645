"""Everything a user can do: one module for each action, and what the actions share."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__,
    [
        "properties",
        "preferences",
        "analyze",
        "add_analysis_preset",
        "segment",
        "select_part",
        "cancel",
        "copy_report",
        "clear",
        "plot_diagram",
        "trace_complex",
        "write_outputs",
        "write_eigenfunctions",
        "cut",
        "separate",
        "register_selected",
        "flip_function",
        "next_alternative",
    ],
)
