"""Topology of a piecewise linear function on a triangle net: critical points, merge trees, persistence."""
