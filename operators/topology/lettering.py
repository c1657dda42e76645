"""Text as triangles, in Blender's own font."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender.known_values import present


class Lettering:
    """Letters in Blender's font; a text object is kept for as long as something is written with it."""

    def __enter__(self) -> "Lettering":
        self._known_fonts = set(bpy.data.fonts)
        curve = bpy.data.curves.new("Eigenparts lettering", "FONT")
        assert isinstance(curve, bpy.types.TextCurve)
        self._curve = curve
        self._curve.resolution_u = 3
        self._object = bpy.data.objects.new("Eigenparts lettering", self._curve)
        return self

    def __exit__(self, *error: object) -> None:
        bpy.data.objects.remove(self._object)
        bpy.data.curves.remove(self._curve)
        # Blender brings its font into the file with the first text; without texts it is not wanted there.
        bpy.data.batch_remove([font for font in bpy.data.fonts if font not in self._known_fonts and not font.users])

    def triangles(self, text: str) -> NDArray[np.float64]:
        """Return (n, 3, 2) triangles of a line of text of height 1 that starts at the origin."""
        self._curve.body = text
        mesh = present(self._object.to_mesh())
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        self._object.to_mesh_clear()
        return places.reshape(-1, 3)[corners.reshape(-1, 3), :2].astype(np.float64)
