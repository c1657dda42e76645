"""Scalar fields on a surface, made of eigenfunctions or of the user's values. Imports surface and fem."""
