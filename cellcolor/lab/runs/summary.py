"""A table of results, summed up as Markdown."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from statistics import fmean, median

from cellcolor.data.wording import count
from cellcolor.lab.runs.table import FINISHED, Row, by, compared, disagreements
from cellcolor.solvers.registry import DEFAULT

_OPEN_SHOWN = 40


def summary_of_runs(rows: Sequence[Row]) -> Iterator[str]:
    """Lines of Markdown: who agrees, who solved what how fast, what failed, and what is open."""
    yield from _about(rows)
    yield ""
    yield from _agreement(rows)
    for (space, limit), own in by(rows, lambda row: (row.search_space, row.limit)).items():
        yield from ("", f"## Search space {space}, {limit:g} s", "")
        same = common(own)
        if same and len(same) < len(own):
            left_out = count(len(own) - len(same), "run")
            yield from (f"{left_out} left out: not every solver has been tried there.", "")
        own = same or own
        yield from _by_family(own, "Minima proved, of runs", _solved)
        yield from ("", *_by_family(own, "Seconds, median", _median))
        yield from ("", *_by_family(own, "PAR2, seconds", lambda runs: _number(par2(runs))))
        yield from ("", *_ends(own), "", *_open(own))


def contestants_of(rows: Iterable[Row]) -> list[str]:
    """Who takes part, the default solver first."""
    names = {row.contestant: row.solver for row in rows}
    return sorted(names, key=lambda name: (names[name] != DEFAULT, names[name], len(name)))


def median_seconds(rows: Sequence[Row]) -> float:
    """Median of the seconds until the minimum was proved; infinite if half or more did not."""
    return median(row.seconds or 0.0 if row.solved else math.inf for row in rows)


def par2(rows: Sequence[Row]) -> float:
    """The mean of the seconds, where a run that did not prove the minimum counts twice its limit.

    The usual score of solver competitions (penalised average runtime).
    """
    return fmean(row.seconds or 0.0 if row.solved else 2.0 * row.limit for row in rows)


def common(rows: Sequence[Row]) -> list[Row]:
    """The runs on what every contestant has been tried on: a part of a sweep is no comparison."""
    names = {row.contestant for row in rows}
    problems = by(rows, lambda r: (r.sha256, r.search_space, r.limit, r.repetition)).values()
    return [row for own in problems if {r.contestant for r in own} == names for row in own]


def markdown_table(head: Sequence[str], body: Iterable[Sequence[str]]) -> Iterator[str]:
    """A table; all columns but the first are numbers."""
    yield f"| {' | '.join(head)} |"
    yield "|---|" + "--:|" * (len(head) - 1)
    for line in body:
        yield f"| {' | '.join(cell.replace('|', '&#124;') for cell in line)} |"


def _about(rows: Sequence[Row]) -> Iterator[str]:
    """Machine, versions, date and commands."""
    runs = f"{count(len(rows), 'run')} on {count(len({row.sha256 for row in rows}), 'instance')}"
    dates = sorted(row.date for row in rows)
    loads = sorted(row.load for row in rows)
    yield f"{runs}, {dates[0]} to {dates[-1]}, load {loads[0]:.1f} to {loads[-1]:.1f}."
    yield ""
    machines = dict.fromkeys(
        f"{row.cpu}, {count(row.cores, 'core')}, {row.memory_mb / 1024:.0f} GiB, Python "
        f"{row.python}, cellcolor {row.cellcolor}"
        for row in rows
    )
    yield from (f"- {machine}" for machine in machines)
    versions = dict.fromkeys(f"{row.solver}: {row.solver_version}" for row in rows)
    yield f"- {'; '.join(versions)}"
    yield from (f"- `{command}`" for command in dict.fromkeys(row.command for row in rows))


def _agreement(rows: Sequence[Row]) -> Iterator[str]:
    wrong = disagreements(rows)
    if not wrong:
        proved = f"{count(compared(rows), 'instance')} two solvers or more proved the minimum"
        yield f"No two runs contradict each other. On {proved}."
        return
    yield f"**{count(len(wrong), 'contradiction')}:**"
    yield ""
    yield from (f"- {line}" for line in wrong)


def _by_family(
    rows: Sequence[Row], title: str, cell: Callable[[Sequence[Row]], str]
) -> Iterator[str]:
    """A line for each family and one for all, a column for each contestant."""
    names = contestants_of(rows)
    lines = by(rows, lambda row: row.family)
    if len(lines) > 1:
        lines["all"] = list(rows)
    body = []
    for family, own in lines.items():
        runs = by(own, lambda row: row.contestant)
        body.append([family, *(cell(runs[name]) if name in runs else "" for name in names)])
    yield from markdown_table([title, *names], body)


def _solved(runs: Sequence[Row]) -> str:
    return f"{sum(row.solved for row in runs)}/{len(runs)}"


def _median(runs: Sequence[Row]) -> str:
    middle = median_seconds(runs)
    return _number(middle) if math.isfinite(middle) else f"> {max(r.limit for r in runs):g}"


def _number(seconds: float) -> str:
    return f"{seconds:.3f}" if seconds < 1 else f"{seconds:.1f}"


def _ends(rows: Sequence[Row]) -> Iterator[str]:
    """What did not end with an answer, and what the runs took."""
    bad = ("timeout", "memory", "crashed", "refused", "unsupported")
    body = []
    runs = by(rows, lambda row: row.contestant)
    for name in contestants_of(rows):
        own = runs[name]
        answered = [row for row in own if row.status in FINISHED]
        over = max((row.seconds - row.limit for row in answered if row.seconds), default=-math.inf)
        body.append(
            [
                name,
                str(len(answered)),
                *(str(sum(row.status == end for row in own)) for end in bad),
                f"{max(over, 0.0):.1f}",
                f"{max(row.peak_mb for row in own):.0f}",
                f"{median(row.process_seconds - (row.seconds or 0) for row in own):.1f}",
            ]
        )
    measures = ("most s beyond the limit", "most MB", "s of start-up, median")
    yield from markdown_table(["solver", "answers", *bad, *measures], body)


def _open(rows: Sequence[Row]) -> Iterator[str]:
    """Instances whose minimum nobody proved, with the best of all divisions and bounds."""
    body = []
    for own in by(rows, lambda row: row.sha256).values():
        if any(row.status == "optimal" for row in own):
            continue
        best = min((r for r in own if r.segments), key=lambda r: r.segments or 0, default=None)
        proved = (r for r in own if r.lower_bound)
        most = max(proved, key=lambda r: r.lower_bound or 0, default=None)
        fewest = "" if best is None else f"{best.segments} ({best.contestant})"
        bound = "" if most is None else f"{most.lower_bound} ({most.contestant})"
        body.append([own[0].subject, str(own[0].cells), fewest, bound])
    if not body:
        yield "Some solver proved every minimum."
        return
    yield f"Open: {count(len(body), 'instance')}" + (
        f", the first {_OPEN_SHOWN}:" if len(body) > _OPEN_SHOWN else ":"
    )
    yield ""
    yield from markdown_table(["instance", "cells", "segments", "at least"], body[:_OPEN_SHOWN])
