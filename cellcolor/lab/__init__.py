"""The laboratory: random instances, solvers held to each other, races between them."""
