"""The presets of the analysis, in the header of its options."""

import bpy
from bl_ui.utils import PresetPanel


class EIGENPARTS_PT_analysis_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Analysis Presets"
    bl_space_type = "VIEW_3D"
    preset_subdir = "eigenparts/analysis"
    preset_operator = "script.execute_preset"
    preset_add_operator = "eigenparts.add_analysis_preset"


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_analysis_presets,))
