"""The same parts on every shape. Imports eigenfunctions and dense."""
