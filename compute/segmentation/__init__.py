"""From persistence pairs to parts: the arcs of the merge trees, the levels, and the faces of every part."""
