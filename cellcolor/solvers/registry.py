"""Every solver by name: those of this package, and those that other packages register.

A solver is a callable without arguments, usually its class, written as ``module:name``; it is
imported when somebody asks for the solver and not before. This package's own stand in ``_OWN``.
Other packages register theirs as entry points of the group ``cellcolor.solvers``
(docs/how-to/add-a-solver.md).
"""

from __future__ import annotations

from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING

from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.solvers.interface import Solver

__all__ = ["DEFAULT", "GROUP", "OWN_NAMES", "REFERENCE", "make_solver", "solver_names"]

GROUP = "cellcolor.solvers"
"""The group of entry points."""

DEFAULT = "cp-sat"
"""What solves unless another solver is named."""

REFERENCE = "dfs"
"""The paper's own search, which the others are judged by on small instances."""

_OWN = {
    "cp-sat": "cellcolor.solvers.cpsat:CpSatSolver",
    "cp-sat-model": "cellcolor.solvers.cpsat:model_alone",
    "dfs": "cellcolor.solvers.dfs:ReferenceSolver",
    "clingo": "cellcolor.solvers.clingo:ClingoSolver",
}
OWN_NAMES = tuple(_OWN)
"""The names of this package's own solvers."""


def solver_names() -> tuple[str, ...]:
    """The names of all solvers, this package's first; none of them is imported for that."""
    others = {point.name for point in entry_points(group=GROUP)} - _OWN.keys()
    return (*OWN_NAMES, *sorted(others))


def make_solver(name: str) -> Solver:
    """The solver of that name.

    Raises:
        InputError: there is none, two packages register different ones, or the one that is
            registered cannot be imported or is no solver.
        ModuleNotFoundError: a solver of this package needs an extra that is not installed.
    """
    if name in _OWN:
        solver: Solver = EntryPoint(name, _OWN[name], GROUP).load()()
        return solver
    points = {point.value: point for point in entry_points(group=GROUP, name=name)}
    if not points:
        known = ", ".join(solver_names())
        raise InputError(None, "solver", f"there is no {name!r}; there are {known}")
    if len(points) > 1:
        raise InputError(None, "solver", f"{name!r} is registered as {' and as '.join(points)}")
    return _load(*points.values())


def _load(point: EntryPoint) -> Solver:
    """A solver of another package, whose faults are told in a line."""
    from cellcolor.solvers.interface import Abilities

    where = f"{point.name!r}, registered as {point.value},"
    try:
        solver: Solver = point.load()()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise InputError(None, "solver", f"{where} cannot be loaded: {reason}") from error
    if not isinstance(getattr(solver, "abilities", None), Abilities):
        raise InputError(None, "solver", f"{where} is no solver: it declares no abilities")
    return solver
