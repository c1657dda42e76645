"""The faces of the input, and the arc and the branch that each belongs to. Imports hierarchy."""
