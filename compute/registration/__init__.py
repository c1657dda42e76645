"""From two shapes to one: which eigenfunctions, parts and points of theirs correspond."""
