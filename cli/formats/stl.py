"""Stereolithography files, as text and binary."""

from __future__ import annotations

import re
from pathlib import Path

import bpy

from ...tasks.refusals import Refusal
from .damage import cut_short, damaged
from .open_file import OpenFile, open_file
from .repairs import mended

# Bytes of a binary file before its triangles, with their number at the end, and of a triangle.
HEAD, TRIANGLE = 84, 50
# What every text begins with, and some binary files. These have a zero in their number or their first triangle.
TEXT, ZERO = re.compile(rb"(?:\xef\xbb\xbf)?\s*solid", re.IGNORECASE), b"\0"
# The lines of a facet that count, and their order.
LINE = re.compile(
    rb"^[ \t]*(?:(?P<facet>facet)|(?P<vertex>vertex)|(?P<endfacet>end[ \t]*facet))\b", re.MULTILINE | re.IGNORECASE
)
FACET = ("facet", "vertex", "vertex", "vertex", "endfacet")
END = re.compile(rb"^[ \t]*end[ \t]*solid", re.MULTILINE | re.IGNORECASE)
# A vertex that Blender passes over without a word.
CAPITALS = re.compile(rb"^[ \t]*(?!vertex)(?i:vertex)\b", re.MULTILINE)
INSTEAD = "export it again as a binary .stl, or as an .obj."


def read_stl(path: Path) -> OpenFile:
    """Open a file; it is there as a whole."""
    n_triangles = _n_triangles(path.read_bytes())
    # Blender would put points that are no numbers at the origin, and not tell.
    bpy.ops.wm.stl_import(filepath=str(path), use_mesh_validate=False)
    return open_file(mended(n_triangles))


def _n_triangles(data: bytes) -> int:
    """Return how many triangles a file lists; raises a Refusal if they are not all there."""
    n_triangles = int.from_bytes(data[HEAD - 4 : HEAD], "little")
    n_there, end = (len(data) - HEAD) // TRIANGLE, HEAD + TRIANGLE * n_triangles
    if len(data) != end and TEXT.match(data) and ZERO not in data[: HEAD + TRIANGLE]:
        return _n_facets(data)
    if len(data) < HEAD:
        raise cut_short(f"byte {len(data)}, within the head")
    if n_there < n_triangles:
        raise cut_short(f"byte {len(data)}, after {n_there} of {n_triangles} triangles")
    if len(data) > end:
        # Blender would take it for text.
        raise damaged(f"byte {end}: there is something behind the {n_triangles} triangles")
    return n_triangles


def _n_facets(data: bytes) -> int:
    """Return how many facets a text lists; raises a Refusal if Blender would pass over some of it."""
    capitals = CAPITALS.search(data)
    if capitals is not None:
        raise Refusal(f"line {_line(data, capitals.end())}: Blender cannot read VERTEX in capitals; {INSTEAD}")
    n_lines, end = 0, 0
    for n_lines, line in enumerate(LINE.finditer(data), 1):
        end = line.end()
        if line.lastgroup != FACET[(n_lines - 1) % len(FACET)]:
            raise damaged(f"line {_line(data, end)}: a facet has its first line, three vertices and its end")
    if not n_lines and b"vertex" in data.lower():
        raise Refusal(f"line 1: Blender can only read a text whose vertices have a line each; {INSTEAD}")
    if n_lines % len(FACET) or END.search(data, end) is None:
        raise cut_short(f"line {_line(data.rstrip(), None)}")
    return n_lines // len(FACET)


def _line(data: bytes, end: int | None) -> int:
    """Return the number of the line that a place is on."""
    return data.count(b"\n", 0, end) + 1
