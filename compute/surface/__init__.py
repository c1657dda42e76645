"""Triangle meshes and the clean surface that is analyzed: cleaned, bridged, wound one way.

Imports errors, progress and memory only.
"""
