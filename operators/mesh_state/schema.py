"""Names, version and limits of what is stored on a mesh, and what is said where it cannot be used."""

from __future__ import annotations

from ..mesh_data.mesh_arrays import OwnAttribute

# 2: with corrections by hand, which a state of version 1 has none of.
SCHEMA = 2

# Of the analysis. Trees, branches and closing heights stand once for each merge tree, with its number behind the name.
VERSION, FINGERPRINT, DESCRIPTION, SHELLS = "schema", "fingerprint", "description", "shells"
HIERARCHY, TREE, PIECES_OF_TREE, CLOSING_HEIGHTS = "hierarchy", "tree_{}", "branches_{}", "closing_heights_{}"
INSIDE_EDGES = "n_inside_edge"
# The nine numbers that the mesh was stretched with to its shape in the world; not there if it was not.
STRETCH = "stretch"
# Of the division that is shown, and of the outputs it is written to: one name a line.
LEVEL, MODE, PARTS, OUTPUTS, SOFTNESS = "level", "mode", "parts", "outputs", "softness"
# Of the parts, each a group keyed by their numbers.
PART_NUMBERS, PART_NAMES, PART_COLOURS = "part_numbers", "part_names", "part_colours"
# The names by the pieces of surface that they belong to, whatever their number at a level.
PIECE_NAMES = "piece_names"
# The colours that parts have by themselves, as places in the palette: numbers of parts and places in turn.
PART_SWATCHES = "part_swatches"
PART_TABLES = (PART_NUMBERS, PART_NAMES, PIECE_NAMES, PART_COLOURS, PART_SWATCHES)
# Of the corrections by hand; branches that were redrawn for them are there only while they are needed.
CORRECTIONS, REDRAWN = "corrections", "pieces"
# There only while the mesh shows the parts of another.
REGISTRATION = "registration"
# For each judged function, the best first, its number and how many protrusions its parts hold.
FUNCTION_HINTS = "function_hints"
# For each part that has a side, the part both sides are called after, and +1 for left, -1 for right.
PART_SIDES = "part_sides"
# The bones of the last skeleton of a mesh, told by its parts, as JSON.
BONE_LAYOUT = "bone_layout"

# What outlives a new analysis: choices of the user, and what is known of the parts as long as they are the same.
CHOICES = (MODE, OUTPUTS, SOFTNESS)
OF_PARTS = (*PART_TABLES, REGISTRATION)

# One attribute for each merge tree; the second is there only where minima are features too.
BRANCHES = (
    OwnAttribute("eigenparts_branch", "INT", "FACE"),
    OwnAttribute("eigenparts_branch_minima", "INT", "FACE"),
)
# What borders are cut from: the arc of each vertex in each tree, and the field on vertices and inside edges. The names
# begin with a dot, so that Blender leaves them out of its lists.
ARCS = (
    OwnAttribute(".eigenparts_arc", "INT", "POINT"),
    OwnAttribute(".eigenparts_arc_minima", "INT", "POINT"),
)
HEIGHT = OwnAttribute(".eigenparts_height", "FLOAT", "POINT")
# Two are used: exporters of Blender 5.2 take any attribute of two numbers for a UV map, and split the mesh along it.
EDGE_HEIGHTS = OwnAttribute(".eigenparts_heights_of_edge", "FLOAT_VECTOR", "EDGE", "vector")
# Of 0.1.0; read where it is, and gone with the next analysis.
PAIRED_EDGE_HEIGHTS = OwnAttribute(".eigenparts_edge_heights", "FLOAT2", "EDGE", "vector")
# The vertex that stands for each where several lie at one place along a seam; not there if none do.
PLACES = OwnAttribute(".eigenparts_place", "INT", "POINT")
# The part each face was painted with and one more, so that 0 is none.
PAINTED = OwnAttribute("eigenparts_painted", "INT", "FACE")
# The branches divided as corrections need them; the attribute is there only while some do.
PIECE = OwnAttribute(".eigenparts_piece", "INT", "FACE")
ATTRIBUTES = (*BRANCHES, *ARCS, HEIGHT, EDGE_HEIGHTS, PAIRED_EDGE_HEIGHTS, PLACES, PAINTED, PIECE)

# More than any mesh has, so that a damaged number makes no table that fills the memory.
MOST_LABELS = 1 << 22
LONGEST_DESCRIPTION = 200

NEWER = "This mesh was analyzed by a newer version of Eigenparts; update the extension or analyze the mesh again."
CUT = "The borders of this mesh were cut already; analyze it again to cut it at another level."
CHANGED = "The mesh was changed after it was analyzed; analyze it again."
SCALED = (
    "The object was scaled after it was analyzed, or its parent was, so its shape is another one; analyze it again, or"
    " take the scale back."
)
OTHERWISE_SCALED = (
    "The mesh is used by {}, too, which is scaled otherwise and shows the same parts; make it single-user to analyze"
    " each by itself."
)
DAMAGED = "The analysis stored on this mesh is damaged; analyze it again."
ABSENT = "Analyze the mesh first."
LOST = "The parts that some corrections by hand belong to are not found any more; these corrections were removed."
