"""Solved counts, medians, PAR2, and the plots of runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from statistics import fmean, median

from cellcolor.data.plot import Curve, Plot
from cellcolor.lab.runs.row import Row, by
from cellcolor.solvers.registry import DEFAULT

_NOISE = 0.01
"""Seconds. Shorter times are not distinguished: they would measure the clock, not the solver."""


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


_LEAST = 0.001
"""Seconds; quicker ones are drawn there, since a logarithmic axis has no zero."""

_FAILED = 2.0
"""How far beyond the limit, as a factor, a run that proved nothing is drawn."""


def plots_of(rows: Sequence[Row]) -> dict[str, Plot]:
    """All plots by name, for each limit and search space, of what every solver has tried."""
    found: dict[str, Plot] = {}
    groups = by(rows, lambda row: (row.search_space, row.limit))
    for (space, limit), own in groups.items():
        end = f"-{space}-{limit:g}s" if len(groups) > 1 else ""
        same = common(own)
        if not same:
            continue
        found[f"cactus{end}"] = cactus(same)
        found[f"growth-cells{end}"] = growth(same, lambda row: row.cells, "cells")
        found[f"growth-darts{end}"] = growth(
            same, lambda row: row.live_darts, "most live darts of a cell"
        )
        found[f"profile{end}"] = profile(same)
        ours, rival = strongest(same, rivals=False), strongest(same, rivals=True)
        if ours is not None and rival is not None:
            found[f"scatter{end}"] = scatter(same, rival, ours)
    return found


def cactus(rows: Sequence[Row]) -> Plot:
    """For each solver how many minima it proves in how many seconds each."""
    curves = []
    for name, own in of_contestants(rows):
        times = sorted(filter(math.isfinite, map(solve_seconds, own)))
        points = [(float(rank), max(time, _LEAST)) for rank, time in enumerate(times, 1)]
        curves.append(Curve(f"{name} ({len(times)})", tuple(points)))
    runs = len(rows) // max(1, len(curves))
    note = f"Runs in the order of their time; {runs} for each solver."
    title = "Minima proved"
    return Plot(title, "runs", "seconds", tuple(curves), log_y=True, joined="lines", note=note)


def growth(rows: Sequence[Row], size: Callable[[Row], int], name: str) -> Plot:
    """The median time on instances of about a size, for sizes from one power of two to the next.

    A curve ends where half of the runs or more prove nothing.
    """
    curves = []
    for solver, own in of_contestants(rows):
        points = []
        bins = by(own, lambda row: max(0, math.ceil(math.log2(max(1, size(row))))))
        for _, group in sorted(bins.items()):
            seconds = median_seconds(group)
            if not math.isfinite(seconds):
                break
            points.append((float(max(1, median(map(size, group)))), max(seconds, _LEAST)))
        curves.append(Curve(solver, tuple(points)))
    note = "Median of the runs between two powers of two; a curve ends where half prove nothing."
    return Plot("Growth", name, "seconds", tuple(curves), log_x=True, log_y=True, note=note)


def profile(rows: Sequence[Row]) -> Plot:
    """Performance profile: the share of runs that take at most a multiple of the best time."""
    all_ratios = ratios(rows)
    end = max(filter(math.isfinite, chain(*all_ratios.values())), default=1.0)
    curves = []
    for name, own in all_ratios.items():
        total = len(own)
        points = [
            (ratio, rank / total) for rank, ratio in enumerate(own, 1) if math.isfinite(ratio)
        ]
        share = points[-1][1] if points else 0.0
        curves.append(Curve(name, ((1.0, 0.0), *points, (end, share))))
    note = "Times below 10 ms are not distinguished."
    x, y = "times the time of the fastest", "share of the runs"
    return Plot("Performance profile", x, y, tuple(curves), log_x=True, joined="steps", note=note)


def scatter(rows: Sequence[Row], rival: str, ours: str) -> Plot:
    """A point for each run, the seconds of one solver against those of the other, by family."""
    points: dict[str, list[tuple[float, float]]] = {}
    problems = by(rows, lambda row: (row.sha256, row.repetition, row.family))
    for (_, _, family), own in problems.items():
        found = by(own, lambda row: row.contestant)
        if rival in found and ours in found:
            point = _drawn(found[rival][0]), _drawn(found[ours][0])
            points.setdefault(family, []).append(point)
    curves = tuple(Curve(family, tuple(own)) for family, own in points.items())
    return Plot(
        f"{ours} against {rival}",
        f"{rival}, seconds",
        f"{ours}, seconds",
        curves,
        log_x=True,
        log_y=True,
        joined="points",
        diagonal=True,
        note="Runs not proved in time are drawn at twice the limit.",
    )


def _drawn(row: Row) -> float:
    seconds = solve_seconds(row)
    return max(seconds, _LEAST) if math.isfinite(seconds) else _FAILED * row.limit


def of_contestants(rows: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    """The runs of each contestant, the default solver's first."""
    runs = by(rows, lambda row: row.contestant)
    return [(name, runs[name]) for name in contestants_of(rows)]
