"""An oracle for the test suites of other coverage planners.

A planner that paints every vertex of a labelled surface in one of its colors cannot have fewer
segments than the surface allows. :func:`proven_range` says how few that is, and :func:`judge`
holds a plan against it. The front door has both::

    import cellcolor

    surface = cellcolor.read("part.surface.json")
    verdict = cellcolor.judge(surface, my_planner(surface))
    assert verdict.valid, verdict.problems
    assert verdict.beatable_by == 0  # proved: no division of the surface has fewer segments

Where a test cannot wait for a proof, ``assert not verdict.beatable_by`` is enough to catch plans
that are proved to have too many; it passes as well if nothing is known.

Everything here is in the search space ``surface`` (any division of the physical surface,
docs/semantics.md, section 4): a bound of the search space ``paper`` may be beaten by a plan.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import BeatenBound, InputError
from cellcolor.files.validation import settle
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import STRANDS, Options

__all__ = ["ProvenRange", "Verdict", "judge", "proven_range"]


@dataclass(frozen=True, slots=True)
class ProvenRange:
    """Between what the fewest segments of a surface lie, both ends included.

    Attributes:
        lower: no division of the surface has fewer segments.
        upper: a division with that many segments exists, and the checker has passed it.

    Raises:
        InputError: the two are no range of whole numbers from 0 on.
    """

    lower: int
    upper: int

    def __post_init__(self) -> None:
        settle(self)
        if not 0 <= self.lower <= self.upper:
            message = f"must be 0 or more and at most upper, {self.upper}; is {self.lower}"
            raise InputError(None, "lower", message)

    @property
    def exact(self) -> bool:
        """The minimum is known."""
        return self.lower == self.upper

    def __str__(self) -> str:
        if self.exact:
            return f"exactly {count(self.lower, 'segment')}"
        return f"between {self.lower} and {count(self.upper, 'segment')}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is to be said about a plan.

    Attributes:
        problems: why the plan is not valid, each naming its vertex; none when it is.
        segments: of the plan; None when it is not valid.
        bounds: the proven range; None when the plan is not valid and nothing was proved.
    """

    problems: tuple[str, ...]
    segments: int | None
    bounds: ProvenRange | None

    @property
    def valid(self) -> bool:
        """Every reachable vertex has one of its colors, and no other vertex has one."""
        return not self.problems

    @property
    def lift_offs(self) -> int | None:
        """``max(0, segments - 1)``; None when the plan is not valid."""
        return None if self.segments is None else max(0, self.segments - 1)

    @property
    def optimal(self) -> bool | None:
        """True: proved to be. False: proved not to be. None: neither, or the plan is not valid."""
        if self.segments is None or self.bounds is None:
            return None
        if self.segments == self.bounds.lower:
            return True
        return False if self.segments > self.bounds.upper else None

    @property
    def beatable_by(self) -> int | None:
        """How many segments fewer are proved to be enough.

        0 only if it is proved that no division of the surface has fewer, so that running out of
        time passes for nothing; None where neither is proved, or when the plan is not valid.

        The division that proves it cuts the surface itself. On a coarse mesh it may not be
        possible to paint it in vertices.
        """
        if self.segments is None or self.bounds is None:
            return None
        if self.segments > self.bounds.upper:
            return self.segments - self.bounds.upper
        return 0 if self.segments == self.bounds.lower else None

    def __str__(self) -> str:
        if self.segments is None or self.lift_offs is None:
            more = len(self.problems) - 1
            rest = f" (and {count(more, 'other problem')})" if more > 0 else ""
            return f"not valid: {self.problems[0]}{rest}"
        found = f"{count(self.segments, 'segment')}, {count(self.lift_offs, 'lift-off')}"
        if self.bounds is None:
            return found
        if self.optimal:
            return f"{found}, optimal: no division of the surface has fewer"
        if self.beatable_by:
            return f"{found}, {self.beatable_by} fewer are proved to be enough"
        return f"{found}, not known to be optimal; the fewest are {self.bounds}"


def proven_range(
    surface: LabelledSurface,
    *,
    strands: int | None = None,
    time_limit: float | None = 60.0,
    workers: int | None = None,
    seed: int = 0,
) -> ProvenRange:
    """The range that the fewest segments of a labelled surface are proved to lie in.

    Args:
        surface: the labelled surface.
        strands: corridors that may cross one topological edge, None for the usual number; more
            may lower ``upper``.
        time_limit: seconds, None for as long as it takes; both ends hold however early it ends.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: of everything random.

    Raises:
        InputError: a cell of the surface is not planar, or an option is out of its range.
    """
    started = time.monotonic()
    deadline = Deadline.after(time_limit, started)
    corridors = STRANDS["surface"] if strands is None else strands
    # The paper's search space is the smaller one: where its optimum meets a bound for any
    # division, there is nothing left to search.
    searches = (
        Options("paper", deadline=deadline, workers=workers, seed=seed),
        Options("surface", corridors, deadline, workers, seed),
    )
    try:
        instance = decompose(surface, deadline=deadline)
    except OutOfTime:
        # A segment for each vertex is a division too, and without any nothing is covered.
        reached = sum(map(bool, surface.vertex_colors))
        return ProvenRange(min(reached, 1), reached)
    # One sub-cell a cell is a division of its own, whatever the solver finds.
    upper = len(instance.cells)
    lower = min(upper, 1)
    # A further search takes about as long as that for its first division alone.
    enough = deadline.earlier(time.monotonic() - started)
    for number, options in enumerate(searches):
        if lower == upper or (enough if number else deadline).over:
            break
        solution = solve(instance, options)
        lower = max(lower, solution.surface_lower_bound)
        if solution.segments is not None:
            upper = min(upper, solution.segments)
    return ProvenRange(lower, upper)


def judge(
    surface: LabelledSurface,
    plan: Plan,
    *,
    bounds: ProvenRange | None = None,
    time_limit: float | None = 60.0,
) -> Verdict:
    """The verdict on a plan: is it valid, how many segments has it, can it be beaten?

    Args:
        surface: the labelled surface that was planned on.
        plan: one color per vertex, None exactly where the vertex has none.
        bounds: this surface's :func:`proven_range`, if known already.
        time_limit: seconds for all of this, most of which finding the range takes otherwise.

    Raises:
        BeatenBound: the plan is valid and beats the lower bound.
        InputError: a cell of the surface is not planar.
    """
    deadline = Deadline.after(time_limit)
    report = check_plan(surface, plan)
    if report.segments is None:
        return Verdict(report.problems, None, bounds)
    if bounds is None:
        bounds = proven_range(surface, time_limit=deadline.left)
    if report.segments < bounds.lower:
        raise BeatenBound(surface.name, report.segments, bounds.lower)
    return Verdict((), report.segments, bounds)
