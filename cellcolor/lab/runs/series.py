"""The numbers of the plots that are drawn of runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import chain
from statistics import median

from cellcolor.data.plot import Curve, Plot
from cellcolor.lab.runs.row import Row
from cellcolor.lab.runs.statistics import (
    by,
    common,
    contestants_of,
    median_seconds,
    ratios,
    solve_seconds,
    strongest,
)

_LEAST = 0.001
"""Seconds; quicker ones are drawn there, since a logarithmic axis has no zero."""

_FAILED = 2.0
"""How far beyond the limit, as a factor, a run that proved nothing is drawn."""


def plots_of(rows: Sequence[Row]) -> dict[str, Plot]:
    """All plots by name; where there are several limits or search spaces, each has its own.

    Only runs on what every solver has been tried on are drawn.
    """
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
    for name, own in _in_order(rows):
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
    for solver, own in _in_order(rows):
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
    """Performance profile: the share of runs that take at most so many times the best time."""
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


def _in_order(rows: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    runs = by(rows, lambda row: row.contestant)
    return [(name, runs[name]) for name in contestants_of(rows)]
