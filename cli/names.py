"""What parts are called outside Blender."""


def name_of_part(label: int) -> str:
    """Return "body" or "part 3"."""
    return f"part {label}" if label else "body"
