"""Joints and bones from the Reeb graph, and the weights that bind a mesh to them."""
