"""Solved counts, medians, PAR2, and the numbers behind the plots."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from statistics import fmean, median
from typing import TypeVar

from cellcolor.lab.runs.row import Row
from cellcolor.solvers.registry import DEFAULT

_NOISE = 0.01
"""Seconds. Shorter times are not distinguished: they would measure the clock, not the solver."""

Problem = tuple[str, str, float, int]
_K = TypeVar("_K")


def by(rows: Iterable[Row], key: Callable[[Row], _K]) -> dict[_K, list[Row]]:
    """The rows of each kind, kinds in the order in which they come."""
    found: dict[_K, list[Row]] = defaultdict(list)
    for row in rows:
        found[key(row)].append(row)
    return dict(found)


def contestants_of(rows: Iterable[Row]) -> list[str]:
    """Who takes part, the default solver first."""
    names = dict.fromkeys(row.contestant for row in rows)
    return sorted(names, key=lambda name: (_solver(name) != DEFAULT, _solver(name), len(name)))


def solve_seconds(row: Row) -> float:
    """Seconds until the minimum was proved, infinite if it was not."""
    return row.seconds if row.solved and row.seconds is not None else math.inf


def median_seconds(rows: Sequence[Row]) -> float:
    """Of :func:`solve_seconds`; infinite if half of the runs or more did not prove the minimum."""
    return median(map(solve_seconds, rows))


def par2(rows: Sequence[Row]) -> float:
    """The mean of the seconds, where a run that did not prove the minimum counts twice its limit.

    It is a score with a penalty, the usual one of solver competitions (penalised average runtime).
    """
    return fmean(row.seconds or 0.0 if row.solved else 2.0 * row.limit for row in rows)


def common(rows: Sequence[Row]) -> list[Row]:
    """The runs on what every contestant has been tried on: a part of a sweep is no comparison."""
    names = set(contestants_of(rows))
    problems = by(rows, _problem)
    return [row for own in problems.values() if {r.contestant for r in own} == names for row in own]


def ratios(rows: Sequence[Row]) -> dict[str, list[float]]:
    """For each contestant and problem its time over that of the quickest (Dolan and Moré, 2002).

    Infinite where it did not prove the minimum; problems that nobody solved are in it. In
    ascending order: they are the steps of a performance profile.
    """
    found: dict[str, list[float]] = {name: [] for name in contestants_of(rows)}
    for own in by(rows, _problem).values():
        times = {row.contestant: max(solve_seconds(row), _NOISE) for row in own}
        best = min(times.values())
        for name, seconds in times.items():
            found[name].append(seconds / best if math.isfinite(seconds) else math.inf)
    return {name: sorted(own) for name, own in found.items()}


def strongest(rows: Sequence[Row], *, rivals: bool) -> str | None:
    """Who proves the most minima, and of these who has the lower PAR2; None if there is nobody.

    Args:
        rows: of all.
        rivals: among the others than ``cp-sat``, its variants left out; else among ``cp-sat`` with
            any number of workers.
    """
    names = [
        name
        for name in contestants_of(rows)
        if (not _solver(name).startswith(DEFAULT) if rivals else _solver(name) == DEFAULT)
    ]
    own = by(rows, lambda row: row.contestant)

    def strength(name: str) -> tuple[int, float]:
        return sum(row.solved for row in own[name]), -par2(own[name])

    return max(names, key=strength, default=None)


def _solver(contestant: str) -> str:
    return contestant.partition("@")[0]


def _problem(row: Row) -> Problem:
    return row.sha256, row.search_space, row.limit, row.repetition
