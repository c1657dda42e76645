"""Arrays from and to Blender's meshes. Imports messages."""
