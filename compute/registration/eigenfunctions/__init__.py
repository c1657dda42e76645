"""Matching of eigenfunctions: order, sign, mixing and handedness. Imports nothing else of registration."""
