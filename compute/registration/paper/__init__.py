"""The paper's own matching, by persistence diagrams and spectral embedding of parts. Imports the rooms beside it."""
