"""Solvers as they are entered for runs: a registered name, and perhaps a number of workers."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.errors import InputError
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import solver_version


@dataclass(frozen=True, slots=True)
class Contestant:
    """A solver that takes part.

    Attributes:
        solver: its registered name.
        workers: the number to use, None if it chooses itself.
        version: what answers.
    """

    solver: str
    workers: int | None
    version: str


def contestant(text: str) -> Contestant:
    """A solver from its name, or from ``NAME@WORKERS``.

    Raises:
        InputError: there is no such solver, or no such number of workers.
        SolverMissing: what it needs is not installed.
    """
    name, at, number = text.partition("@")
    workers = None
    if at:
        try:
            workers = Options(workers=int(number)).workers
        except (ValueError, InputError) as error:
            raise InputError(None, "solver", f"{text}: no number of workers after @") from error
    return Contestant(name, workers, solver_version(name))
