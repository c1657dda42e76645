"""Stereolithography files, as text and binary."""

from __future__ import annotations

from pathlib import Path

import bpy

from .damage import cut_short, damaged
from .open_file import OpenFile, open_file
from .repairs import mended

# Bytes of a binary file before its triangles, with their number at the end, and of a triangle.
HEAD, TRIANGLE = 84, 50
# What files begin with that are text, and some that are not.
TEXT = b"solid"


def read_stl(path: Path) -> OpenFile:
    """Open a file; a binary one has as many triangles as it says."""
    n_triangles = _n_triangles(path.read_bytes())
    # Blender would put points that are no numbers at the origin, and not tell.
    bpy.ops.wm.stl_import(filepath=str(path), use_mesh_validate=False)
    return open_file(mended(n_triangles))


def _n_triangles(data: bytes) -> int:
    """Return how many triangles a file lists; raises a Refusal if a binary one has not as many."""
    n_triangles = int.from_bytes(data[HEAD - 4 : HEAD], "little")
    n_there, end = (len(data) - HEAD) // TRIANGLE, HEAD + TRIANGLE * n_triangles
    if data[:HEAD].lstrip().startswith(TEXT) and len(data) != end:
        return data.count(b"endfacet")
    if len(data) < HEAD:
        raise cut_short(f"byte {len(data)}, within the head")
    if n_there < n_triangles:
        raise cut_short(f"byte {len(data)}, after {n_there} of {n_triangles} triangles")
    if len(data) > end:
        # Blender would take it for text.
        raise damaged(f"byte {end}: there is something behind the {n_triangles} triangles")
    return n_triangles
