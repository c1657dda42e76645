"""Operator: keep the options of transferring under a name."""

import bpy
from bl_operators.presets import AddPresetBase

from .transfer_options import TransferOptions


# The stubs give the methods of Blender\'s own class no types.
class EIGENPARTS_OT_add_transfer_preset(AddPresetBase, bpy.types.Operator):  # type: ignore[misc]
    """Keep what is transferred, and how, under a name, or remove the preset"""

    bl_idname = "eigenparts.add_transfer_preset"
    bl_label = "Add Transfer Preset"
    bl_options = {"INTERNAL"}
    preset_menu = "EIGENPARTS_PT_transfer_presets"
    preset_subdir = "eigenparts/transfer"
    preset_defines = ("settings = bpy.context.scene.eigenparts_transfer",)
    preset_values = tuple(f"settings.{name}" for name in TransferOptions.__annotations__)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_add_transfer_preset,))
