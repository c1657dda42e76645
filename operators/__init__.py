"""Everything a user can do: one module for each action, and what the actions share."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__,
    [
        "properties",
        "preferences",
        "recolouring",
        "analyze",
        "add_analysis_preset",
        "segment",
        "select_part",
        "set_branch_level",
        "merge_parts",
        "split_part",
        "move_border",
        "paint_part",
        "remove_correction",
        "clear_corrections",
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
        "transfer",
        "skeleton_options",
        "create_armature",
        "create_skeleton_curves",
    ],
)
