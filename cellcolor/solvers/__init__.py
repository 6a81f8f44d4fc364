"""Solvers of the minimum-segment coloring, and lower bounds."""
