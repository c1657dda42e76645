import bpy

settings = bpy.context.scene.eigenparts
settings.field = "DIFFUSION"
settings.eigenfunction = 1
settings.order = "AUTO"
settings.boundary = "NEUMANN"
settings.shells = "BRIDGED"
settings.borders = "EDGES"
settings.use_modifiers = False
