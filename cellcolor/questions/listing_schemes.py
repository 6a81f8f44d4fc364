"""All optimal schemes of a graph: each is handed over as soon as it is found."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Solution
from cellcolor.deadline import OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options, Start


def with_schemes(
    instance: Instance,
    solution: Solution,
    solver: str,
    options: Options,
    most: int,
    take: Callable[[Division], None],
) -> Solution:
    """A solution with its optimal schemes counted.

    One more than the most that are wanted is looked for: only so is it known whether there are
    others. A solver may end the search at any moment by an ``OutOfTime``; schemes that were taken
    beyond ``schemes`` of the result do not count.

    Args:
        solution: of the instance, in the search space ``paper``. If its number is not proved, no
            scheme is looked for.
        most: how many are wanted.
        take: given each scheme.

    Raises:
        InputError: the solver lists no schemes, or none of this instance.
        RefusedResult: the checker refuses what the solver found.
    """
    if solution.status != "optimal" or solution.segments is None:
        return replace(solution, schemes=0, complete=False)
    started = time.monotonic()
    found, complete, notes = 0, True, solution.notes
    counted: list[int] = []
    known = None if solution.cells is None else Start(solution.cells, solution.seams)
    try:
        for division in checked.enumerate_schemes(
            instance, options, solver, solution.segments, known, counted.append
        ):
            if found == most:
                complete = False
                break
            take(division)
            found += 1
    except OutOfTime:
        complete = False
    except TooLarge as error:
        complete, notes = False, (*notes, str(error))
    if not complete and counted:
        notes = (*notes, f"There are {counted[0]:,} optimal schemes; {found:,} of them are listed.")
    seconds = solution.seconds + time.monotonic() - started
    return replace(solution, schemes=found, complete=complete, seconds=seconds, notes=notes)
