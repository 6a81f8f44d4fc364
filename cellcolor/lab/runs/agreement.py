"""Contradictions between runs: no solver may beat what another one has proved."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

from cellcolor.lab.runs.row import Row


def disagreements(rows: Iterable[Row]) -> list[str]:
    """A line for each instance on which two runs contradict each other, and for each result that
    the checker refused."""
    found = []
    for own in _by_instance(rows):
        refused = (row for row in own if row.status == "refused")
        found += [f"{row.subject}: {row.contestant}: {row.error}" for row in refused]
        divided = [row for row in own if row.segments is not None]
        proved = [row for row in own if row.lower_bound is not None]
        if not divided or not proved:
            continue
        best = min(divided, key=lambda row: row.segments or 0)
        most = max(proved, key=lambda row: row.lower_bound or 0)
        if (best.segments or 0) < (most.lower_bound or 0):
            found.append(
                f"{best.subject} ({best.search_space}, {best.sha256[:12]}): {best.contestant} has "
                f"{best.segments} segments, {most.contestant} a lower bound of {most.lower_bound}"
            )
    return found


def compared(rows: Iterable[Row]) -> int:
    """On how many instances two solvers or more have proved a minimum.

    One solver with other workers is no other solver.
    """
    return sum(
        len({row.solver for row in own if row.status == "optimal"}) > 1
        for own in _by_instance(rows)
    )


def _by_instance(rows: Iterable[Row]) -> list[list[Row]]:
    """The runs on the same instance in the same search space."""

    def same(row: Row) -> tuple[str, str]:
        return row.sha256, row.search_space

    return [list(own) for _, own in groupby(sorted(rows, key=same), same)]
