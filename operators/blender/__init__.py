"""Blender's own objects with the types they have in this extension. Imports no other room."""
