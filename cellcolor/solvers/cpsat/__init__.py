"""Minimum-segment coloring as a CP-SAT model, sub-cell cutting paths included."""

from ortools.sat.python.cp_model import CpSolver

from cellcolor.solvers.cpsat.complete_model import CompleteModel, CompleteModelSolver
from cellcolor.solvers.cpsat.solver import CpSatSolver

__all__ = ["CompleteModel", "CompleteModelSolver", "CpSatSolver", "CpSolver"]
