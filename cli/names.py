"""What parts are called outside Blender."""


def name_of_part(label: int) -> str:
    """Return "body" or "part_3", which every file format keeps as it is."""
    return f"part_{label}" if label else "body"
