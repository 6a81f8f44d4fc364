"""Verdicts as lines, for people."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from cellcolor.cli.terminal import say
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.verdicts import SolutionVerdict
from cellcolor.data.wording import count, segments_and_lift_offs

if TYPE_CHECKING:
    from cellcolor.oracle import Verdict

_FAULTS = 3  # of each kind
_VERTICES = 10
_SOLVERS = {"cp-sat": "CP-SAT", "cp-sat-model": "CP-SAT"}  # what has proved their bounds


def say_plan(name: str, verdict: Verdict) -> None:
    """What is said of a plan with a name."""
    say(f"{name}: {'valid' if verdict.valid else 'not valid'}")
    places = {f"vertex_colors[{found.vertex}]": found.place for found in verdict.violations}
    for problem in verdict.problems[:_VERTICES]:
        place = places.get(problem.partition(": ")[0])
        where = "" if place is None else " at ({:.3f}, {:.3f}, {:.3f}) m".format(*place)
        say(f"  {problem}{where}")
    if len(verdict.problems) > _VERTICES:
        say(f"  {len(verdict.problems) - _VERTICES} more")
    if verdict.segments is not None:
        say(f"  {verdict}")


def say_solution(name: str, verdict: SolutionVerdict) -> None:
    """What is said of a solution with a name."""
    say(f"{name}: {'valid' if verdict.valid else 'not valid'}")
    for problem in verdict.problems:
        say(f"  {problem}")
    if verdict.segments is not None:
        say(f"  {segments_and_lift_offs(verdict.segments)}")
    say(f"  status {verdict.status}")
    if verdict.schemes is not None:
        say(f"  {count(verdict.schemes, 'scheme')}")
    _say_bounds(verdict)
    if verdict.claimed:
        claimed = (f"{name} {json.dumps(value)}" for name, value in verdict.claimed.items())
        say(f"  claimed, not verified: {', '.join(claimed)}")


def _say_bounds(verdict: SolutionVerdict) -> None:
    """What came of verifying each bound, and how many of them rest on the solver."""
    solver = _SOLVERS.get(verdict.solver, verdict.solver)
    for bound in verdict.bounds:
        tried = f"{bound.tried} of {bound.budget} choices tried"
        more = {"verified": tried, "refused": bound.reason}.get(bound.outcome, f"by {solver}")
        say(f"  at least {bound.value} by {bound.kind}: {bound.outcome}, {more}")
    if verdict.bounds_by_solver:
        bounds = count(len(verdict.bounds), "bound")
        say(f"  {verdict.bounds_by_solver} of {bounds} by {solver}")


def say_trajectory(name: str, verdict: TrajectoryVerdict) -> None:
    """What is said of a trajectory with a name."""
    said = count(sum(verdict.fault_counts.values()), "fault")
    say(f"{name}: {'valid' if verdict.valid else f'not valid, {said}'}")
    for kind, number in verdict.fault_counts.items():
        first = verdict.of_kind(kind)[:_FAULTS]
        for fault in first:
            say(f"  {fault}")
        if number > len(first):
            say(f"  {kind}: {number - len(first)} more")
    seconds = "" if verdict.seconds is None else f", {verdict.seconds:.1f} s"
    tested = f"{count(verdict.samples, 'sample')}, {count(verdict.tested, 'configuration')} tested"
    say(f"  {count(verdict.strokes, 'stroke')}, {count(verdict.lift_offs, 'lift-off')}{seconds}")
    say(f"  {tested}")
    if verdict.minimum_lift_offs is not None:
        extra = f"{verdict.claimed_extra} more announced, {verdict.unclaimed_extra} more not"
        say(f"  fewest lift-offs on this surface, proved: {verdict.minimum_lift_offs}; {extra}")
    if verdict.covered is not None:
        say(f"  {verdict.covered}")
    for line in (*verdict.feed_lines, *verdict.notes):
        say(f"  {line}")
