"""Operator: keep the options of the analysis under a name."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase

from ..parts.analysis_options import AnalysisOptions

# Blender looks for presets that come along in the folder "presets" of this one, below that in its own folder.
HOME = str(Path(__file__).parents[2])
FOLDER = "eigenparts/analysis"


# The stubs give the methods of Blender\'s own class no types.
class EIGENPARTS_OT_add_analysis_preset(AddPresetBase, bpy.types.Operator):  # type: ignore[misc]
    """Keep these options under a name, or remove the preset"""

    bl_idname = "eigenparts.add_analysis_preset"
    bl_label = "Add Analysis Preset"
    bl_options = {"INTERNAL"}
    preset_menu = "EIGENPARTS_PT_analysis_presets"
    preset_subdir = FOLDER
    preset_defines = ("settings = bpy.context.scene.eigenparts",)
    preset_values = tuple(f"settings.{name}" for name in AnalysisOptions.__annotations__)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_OT_add_analysis_preset,))


def register() -> None:
    """Add the operator and the presets that come along; the first releases of Blender 4.2 show only the user's own."""
    _register_classes()
    if hasattr(bpy.utils, "register_preset_path"):
        bpy.utils.register_preset_path(HOME)


def unregister() -> None:
    """Take them away."""
    if hasattr(bpy.utils, "unregister_preset_path"):
        bpy.utils.unregister_preset_path(HOME)
    _unregister_classes()
