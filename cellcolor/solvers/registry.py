"""Every solver by name: those of this package, and those that other packages register.

A solver is a callable without arguments, usually its class, written as ``module:name``; it is
imported when somebody asks for the solver and not before. Other packages register theirs as entry
points (docs/how-to/add-a-solver.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cellcolor.errors import InputError, SolverMissing
from cellcolor.registered import find, known_names, load
from cellcolor.version import __version__

if TYPE_CHECKING:
    from cellcolor.solvers.interface import Solver

GROUP = "cellcolor.solvers"
"""The group of entry points."""

DEFAULT = "cp-sat"
"""What solves unless another solver is named."""

PAPERS = "dfs"
"""The paper's own search, to the letter."""

REFERENCE = "dfs-cover"
"""The same search with a bound of its own, which the others are judged by on small instances."""

_OWN = {
    "cp-sat": "cellcolor.solvers.cpsat:CpSatSolver",
    "cp-sat-model": "cellcolor.solvers.cpsat:CompleteModelSolver",
    "dfs": "cellcolor.solvers.dfs:ReferenceSolver",
    "dfs-cover": "cellcolor.solvers.dfs:CoverReferenceSolver",
    "clingo": "cellcolor.solvers.clingo:ClingoSolver",
    "choco": "cellcolor.solvers.choco.solver:ChocoSolver",
    "highs": "cellcolor.solvers.linear.rivals:HighsSolver",
    "scip": "cellcolor.solvers.linear.rivals:ScipSolver",
    "maxsat": "cellcolor.solvers.linear.rivals:MaxSatSolver",
    "gecode": "cellcolor.solvers.minizinc:GecodeSolver",
    "chuffed": "cellcolor.solvers.minizinc:ChuffedSolver",
}
OWN_NAMES = tuple(_OWN)
"""The names of this package's own solvers."""


def solver_names() -> tuple[str, ...]:
    """The names of all solvers, this package's first; none of them is imported for that."""
    return known_names(_OWN, GROUP)


def make_solver(name: str) -> Solver:
    """The solver of that name.

    Raises:
        InputError: there is none, two packages register different ones, or it cannot be imported
            or is no solver.
        SolverMissing: what it needs is not installed.
    """
    from cellcolor.solvers.interface import Abilities

    point = find(name, _OWN, GROUP, "solver")
    solver: Solver
    if name in _OWN:
        solver = point.load()()
        return solver
    # The faults of another package's solver are told in a line.
    where = f"{point.name!r}, registered as {point.value},"
    make = load(point, "solver")
    try:
        solver = make()
    except SolverMissing:
        raise
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise InputError(None, "solver", f"{where} cannot be made: {reason}") from error
    if not isinstance(getattr(solver, "abilities", None), Abilities):
        raise InputError(None, "solver", f"{where} is not a solver: it declares no abilities")
    return solver


def solver_version(name: str) -> str:
    """Which version answers: what the solver says of itself, else the version of its package.

    It raises what :func:`make_solver` raises.
    """
    own = getattr(make_solver(name), "version", None)
    if own is not None:
        return str(own)
    distribution = find(name, _OWN, GROUP, "solver").dist
    return __version__ if distribution is None else distribution.version
