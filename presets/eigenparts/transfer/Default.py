import bpy

settings = bpy.context.scene.eigenparts_transfer
settings.layers = {"GROUPS"}
settings.method = "AUTO"
settings.groups = "ALL"
settings.group_names = ""
settings.factor = 1.0
settings.mask = ""
settings.unsure = "FILL"
settings.selects_unsure = False
settings.mirrored = False
settings.use_modifiers = False
