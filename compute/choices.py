"""The words that an analysis and a division can be asked for by, the default first; importing them loads nothing."""

# What lies between features is a part too: all levels up to the chosen one are overlaid.
NESTED = "nested"
# Only the features that protrude are parts.
FEATURES = "features"
MODES = (NESTED, FEATURES)
# The nested parts, and limbs are cut at their joints.
JOINTED = "jointed"
# All ways in which levels are read.
READINGS = (JOINTED, *MODES)
# What is done with a mesh of several shells: those that prolong the largest are bridged to it, only the largest is
# analyzed, or each that is no detail by itself.
SHELLS = ("bridged", "largest", "separate")
# Where parts end on whole faces: at short lines of edges near the level sets, or where the greater half of a face says.
EDGES, EXACT = "edges", "exact"
BORDERS = (EDGES, EXACT)
# Degrees of the finite elements; by the size of the mesh if "auto".
ORDERS: tuple[str | int, ...] = ("auto", 1, 2, 3)
# How functions behave at open edges: they meet them at a right angle, or are zero there.
BOUNDARIES = ("neumann", "dirichlet")
# Functions that the engine itself can be asked for by name; otherwise the number of an eigenfunction, or own values.
FIELDS = ("diffusion",)
# How vertices of two meshes are found to correspond: by what fits if "auto", by their numbers, as nearest points of
# meshes that lie on one another, or by shape.
METHODS = ("auto", "number", "place", "shape")
