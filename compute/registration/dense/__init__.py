"""Maps from vertices to points of another surface, and what is carried along them. Imports eigenfunctions."""
