"""Beside a minimum of a surface without its slivers, the minimum with them."""

from __future__ import annotations

from dataclasses import replace

from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.door.subject import Subject
from cellcolor.errors import InputError
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import DEFAULT

__all__ = ["with_raw_minimum"]

_SECONDS = 10.0  # there are many small cells, and the proof may take for ever


def with_raw_minimum(solution: Solution, subject: Subject, options: Options) -> Solution:
    """The solution with a note on the whole surface, where a scene's slivers were given up.

    Args:
        solution: of the scene without its slivers.
        subject: what was solved.
        options: how; the raw surface gets ten seconds of the time that is left.
    """
    raw = None if subject.built is None else subject.built.raw_surface
    coverage = subject.graph().coverage
    if raw is None or coverage is None:
        return solution
    deadline = Deadline(min(options.deadline.moment, Deadline.after(_SECONDS).moment))
    asked = replace(options, deadline=deadline, start=None, fewest_cuts=False)
    try:
        found = str(checked.solve(decompose(raw, deadline=deadline), asked, DEFAULT))
    except OutOfTime:
        found = "no division was found in time"
    except InputError as error:
        found = f"it cannot be solved, {error}"
    note = (
        f"{coverage.given_up:.1%} of the area was given up as slivers; with nothing given up: "
        f"{found}"
    )
    return replace(solution, notes=(*solution.notes, note))
