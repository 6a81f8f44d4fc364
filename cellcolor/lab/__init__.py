"""The laboratory: random instances, solvers held to each other and compared."""
