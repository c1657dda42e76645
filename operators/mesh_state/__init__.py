"""What a mesh remembers of its analysis, corrections, names and registration. Imports messages and mesh_data."""
