"""The outputs that parts are written to: one file each, and the writer of them all. Imports the rooms of meshes."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(__package__, ["recolouring"])
