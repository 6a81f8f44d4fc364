"""Solvers of the minimum-segment coloring, and the bounds beside them."""
