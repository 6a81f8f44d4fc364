"""Solved counts, medians and PAR2 of runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from statistics import fmean, median

from cellcolor.lab.runs.row import Row, by
from cellcolor.solvers.registry import DEFAULT


def contestants_of(rows: Iterable[Row]) -> list[str]:
    """Who takes part, the default solver first."""
    names = dict.fromkeys(row.contestant for row in rows)
    return sorted(names, key=lambda name: (_solver(name) != DEFAULT, _solver(name), len(name)))


def solve_seconds(row: Row) -> float:
    """Seconds until the minimum was proved, infinite if it was not."""
    return row.seconds if row.solved and row.seconds is not None else math.inf


def median_seconds(rows: Sequence[Row]) -> float:
    """Median of :func:`solve_seconds`; infinite if half or more did not prove the minimum."""
    return median(map(solve_seconds, rows))


def par2(rows: Sequence[Row]) -> float:
    """The mean of the seconds, where a run that did not prove the minimum counts twice its limit.

    The usual score of solver competitions (penalised average runtime).
    """
    return fmean(row.seconds or 0.0 if row.solved else 2.0 * row.limit for row in rows)


def common(rows: Sequence[Row]) -> list[Row]:
    """The runs on what every contestant has been tried on: a part of a sweep is no comparison."""
    names = set(contestants_of(rows))
    problems = by(rows, _problem)
    return [row for own in problems.values() if {r.contestant for r in own} == names for row in own]


def strongest(rows: Sequence[Row], *, rivals: bool) -> str | None:
    """The contestant that proves most minima, then with the lower PAR2; None if there is none.

    Args:
        rivals: among the others than ``cp-sat``, its variants left out; else among ``cp-sat`` with
            any number of workers.
    """
    strength = {
        name: (sum(row.solved for row in own), -par2(own))
        for name, own in of_contestants(rows)
        if (not _solver(name).startswith(DEFAULT) if rivals else _solver(name) == DEFAULT)
    }
    return max(strength, key=strength.__getitem__, default=None)


def _solver(contestant: str) -> str:
    return contestant.partition("@")[0]


def _problem(row: Row) -> tuple[str, str, float, int]:
    return row.sha256, row.search_space, row.limit, row.repetition


def of_contestants(rows: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    """The runs of each contestant, the default solver's first."""
    runs = by(rows, lambda row: row.contestant)
    return [(name, runs[name]) for name in contestants_of(rows)]
