"""Finite elements on surfaces: from a triangle mesh to the eigenfunctions of its Laplace-Beltrami operator."""
