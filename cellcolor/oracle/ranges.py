"""The range that the fewest segments of a surface are proved to lie in.

Everything here is in the search space ``surface`` (any division of the physical surface,
docs/semantics.md, section 4): a bound of the search space ``paper`` may be beaten by a plan.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import ProvenRange
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import Decomposition, decomposition_of
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import STRANDS, Options


@dataclass(frozen=True)
class Proof:
    """What is proved of the fewest segments of a surface, and what proves it.

    Attributes:
        bounds: the range that they lie in.
        decomposition: the topological graph on the surface; None if there was no time for it.
        solution: the one with the fewest segments that was found.
        found: all solutions that were found; their bounds are what the lower end rests on.
        kept_lower: a greater lower bound that was kept on disk and that nothing has verified.
    """

    bounds: ProvenRange
    decomposition: Decomposition | None = None
    solution: Solution | None = None
    found: tuple[Solution, ...] = ()
    kept_lower: int | None = None


def prove(
    surface: LabelledSurface,
    deadline: Deadline,
    *,
    strands: int | None = None,
    workers: int | None = None,
    seed: int = 0,
) -> Proof:
    """Find the range that the fewest segments of a labelled surface lie in, and the proof of it.

    Args:
        deadline: when to return what is proved; both ends hold however early that is.
        strands: corridors that may cross one topological edge, None for the usual number.
        workers: CP-SAT's search workers, None for its portfolio.

    Raises:
        InputError: a cell of the surface is not planar, or an option is out of its range.
    """
    started = time.monotonic()
    corridors = STRANDS["surface"] if strands is None else strands
    # The paper's search space is the smaller one: where its optimum meets a bound for any
    # division, there is nothing left to search.
    searches = (
        Options("paper", deadline=deadline, workers=workers, seed=seed),
        Options("surface", corridors, deadline, workers, seed),
    )
    try:
        decomposition = decomposition_of(surface, None, deadline)
    except OutOfTime:
        # A segment for each vertex is a division too, and without any nothing is covered.
        reached = sum(map(bool, surface.vertex_colors))
        return Proof(ProvenRange(min(reached, 1), reached))
    instance = decomposition.instance
    upper = len(instance.cells)  # one sub-cell a cell is a division as well
    lower = min(upper, 1)
    best: Solution | None = None
    found: list[Solution] = []
    # A further search is not begun unless it has about the time that decomposing took.
    enough = deadline.earlier(time.monotonic() - started)
    for number, options in enumerate(searches if instance.cells else ()):
        if (enough if number else deadline).over or (number and lower == upper):
            break
        solution = solve(instance, options)
        found.append(solution)
        lower = max(lower, solution.surface_lower_bound)
        if solution.segments is not None and (best is None or solution.segments < upper):
            best = solution
            upper = min(upper, solution.segments)
    return Proof(ProvenRange(lower, upper), decomposition, best, tuple(found))
