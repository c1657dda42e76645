"""The memory of a mesh: its analysis, corrections, names and registration. Imports messages and mesh_data."""
