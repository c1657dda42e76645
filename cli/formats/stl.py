"""Stereolithography files, as text and binary."""

from pathlib import Path

import bpy
import numpy as np

from .repairs import Repairs, mended

# Bytes of a binary file before its triangles, and of a triangle.
HEAD, TRIANGLE = 84, 50


def read_stl(path: Path) -> Repairs:
    """Add the mesh of a file to the scene, and return what was mended."""
    # Blender would put points that are no numbers at the origin, and not tell.
    bpy.ops.wm.stl_import(filepath=str(path), use_mesh_validate=False)
    return mended(_n_triangles(path.read_bytes()))


def _n_triangles(data: bytes) -> int:
    n_triangles = int(np.frombuffer(data[HEAD - 4 : HEAD], "<u4")[0]) if len(data) >= HEAD else 0
    return n_triangles if len(data) == HEAD + TRIANGLE * n_triangles else data.count(b"endfacet")
