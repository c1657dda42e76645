"""Where parts end: level sets across the triangles, or lines of existing edges. Imports hierarchy and faces."""
