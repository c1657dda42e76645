"""Borders of parts: level sets across the triangles, or lines of existing edges. Imports hierarchy and faces."""
