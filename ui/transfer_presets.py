"""The presets of transferring, in the header of its panel."""

import bpy
from bl_ui.utils import PresetPanel


class EIGENPARTS_PT_transfer_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Transfer Presets"
    bl_space_type = "VIEW_3D"
    preset_subdir = "eigenparts/transfer"
    preset_operator = "script.execute_preset"
    preset_add_operator = "eigenparts.add_transfer_preset"


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_transfer_presets,))
