"""Minimum-segment coloring as a CP-SAT model, sub-cell cutting paths included."""

from cellcolor.solvers.cpsat.solver import CpSatSolver, model_alone

__all__ = ["CpSatSolver", "model_alone"]
