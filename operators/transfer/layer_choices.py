"""The kinds of layers that can be asked for, with names and tooltips: declared here for window and command line."""

GROUPS, SHAPE_KEYS, UVS, COLORS, ATTRIBUTES, FACES, MATERIALS, PARTS = (
    "GROUPS", "SHAPE_KEYS", "UVS", "COLORS", "ATTRIBUTES", "FACES", "MATERIALS", "PARTS",
)  # fmt: skip

LAYERS = {
    GROUPS: ("Vertex Groups", "Weights, such as those of an armature"),
    SHAPE_KEYS: ("Shape Keys", "Turned as the surface is turned; the other mesh must have a Basis"),
    UVS: ("UV Maps", "With their seams on the edges that are next to them"),
    COLORS: ("Colors", "Color attributes of vertices and face corners"),
    ATTRIBUTES: ("Vertex Attributes", "All other attributes of vertices"),
    FACES: ("Face Attributes", "Face sets and other attributes of faces, by majority"),
    MATERIALS: ("Materials", "Slots and what is assigned to the faces"),
    PARTS: ("Parts", "Labels and colors of parts, for meshes that are not analyzed themselves"),
}
DEFAULT_LAYERS = (GROUPS,)
# Materials are no numbers that could go from file to file.
LAYERS_OF_FILES = tuple(kind for kind in LAYERS if kind != MATERIALS)
