"""Every bound attacked by brute force: ``python benchmarks/attacked_bounds.py [COUNT [SEED]]``.

Takes the small instances of a campaign (docs/campaign.md), in place of every tenth one a hub whose
petals have one color or two, where more depends on what segments avoid. Finds each bound by
itself, as far as it goes: no division is looked for that would end the search. A bound must not
exceed

- the minimum of the reference solver, a depth-first search that shares nothing with the bounds;
- the fewest segments over all colorings of a mesh's vertices, if the mesh is small enough.

Prints what is wrong, then for each bound how often it was found, how often it is the minimum, and
how often it is more than a smallest cover.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from rooms import hub, planner_of

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.lab.campaign.agreement import fewest_by_vertices
from cellcolor.lab.campaign.pool import Case, draw_case
from cellcolor.solvers.bounds.cover import greedy_strangers, set_cover
from cellcolor.solvers.bounds.hubs import hub_bound
from cellcolor.solvers.bounds.reductions import drop_dominated, left_out
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.exact_shapes import exact_minimum
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.cpsat.routes.segment_plans import SegmentPlan, Undecided
from cellcolor.solvers.interface import Options

SECONDS = 10.0
"""For all plans of one instance; most take a hundredth."""

OTHER_PLANS = 2
"""Further plans of an instance, one with a segment more, in which reasons are looked for
that would rule out too much."""

MOST_STATES = 100
"""Partial colorings of a mesh's vertices at a time; with more the mesh is left out."""

REASONS = Counter[str]()
"""Why plans were ruled out, over all instances."""


def bounds_of(instance: Instance) -> dict[str, int]:
    """Each bound for any division of the surface, and the exact minimum where there is a shape."""
    parts = [
        part.instance for part in split(instance, drop_dominated(instance, left_out(instance)))
    ]
    found = {
        "strangers": len(greedy_strangers(instance)),
        "cover": set_cover(instance).bound,
        "cover, dominated colors left out": sum(set_cover(part).bound for part in parts),
        "hubs": hub_bound(instance).value,
    }
    for part in parts:
        for name, bound in planned(part).items():
            found[name] = found.get(name, 0) + bound
    return found


def planned(instance: Instance) -> dict[str, int]:
    """The fewest segments of a plan, with more and more reasons why one cannot be drawn."""
    deadline = Deadline.after(SECONDS)
    fewest = set_cover(instance).bound
    planner = planner_of(instance, deadline)

    def partings(plan: SegmentPlan) -> bool:
        return planner.find_partings(plan, deadline)

    def tangles(plan: SegmentPlan) -> bool:
        return planner.find_conflicts(plan, deadline, avoiding=False)

    def avoided(plan: SegmentPlan) -> bool:
        return planner.find_conflicts(plan, deadline, avoiding=True)

    found = {}
    for look in (partings, tangles, avoided):
        try:
            while (plan := planner.plan(fewest, 0, thoroughly=True)) is None or look(plan):
                fewest += plan is None
        except (Undecided, OutOfTime):
            pass  # what was proved until then is a bound as well
        found[f"plans, {look.__name__}"] = fewest
    try:
        for seed in range(1, OTHER_PLANS + 1):
            plan = planner.plan(fewest + seed % 2, seed, thoroughly=True)
            if plan is not None:
                avoided(plan)
        fewest += planner.plan(fewest, 0, thoroughly=True) is None
    except (Undecided, OutOfTime):
        pass
    found["plans, what other plans break as well"] = fewest
    REASONS["partings"] += sum(1 for _ in planner.partings)
    for tangle in planner.tangles:
        REASONS["tangles" if not any(own for _, _, own in tangle) else "with cells avoided"] += 1
    return found


def exact(instance: Instance) -> int | None:
    """The sum of the parts' exact minima; None unless each has such a shape."""
    parts = split(instance, drop_dominated(instance, left_out(instance)))
    minima = [exact_minimum(part, NEVER) for part in parts]
    return None if None in minima else sum(its.segments for its in minima if its is not None)


def drawn(seed: int, number: int) -> Case:
    """An instance of the campaign with that seed, or a hub."""
    if number % 10:
        return draw_case(seed, number)
    rng = random.Random(f"hub {seed} {number}")
    petals = [rng.sample(range(3), rng.randint(1, 2)) for _ in range(rng.randint(5, 7))]
    made = hub(*(tuple(sorted(colors)) for colors in petals))
    return Case(seed, number, "hub, two colors", made, None)


def brute_force(case: Case) -> tuple[int, int, bool]:
    """The minimum in the search space ``paper``, the fewest segments known for the surface, and
    whether the mesh's vertices were colored."""
    solution = solve(case.instance, Options(), "dfs-cover")
    fewest = solution.segments
    assert solution.status == "optimal"
    assert fewest is not None
    by_vertices = None if case.surface is None else fewest_by_vertices(case.surface, MOST_STATES)
    return fewest, min(fewest, by_vertices or fewest), by_vertices is not None


def main(arguments: list[str]) -> int:
    """Attack so many instances; 1 if a bound is wrong."""
    count, seed = [*map(int, arguments), *(20_000, 1)[len(arguments) :]]
    found, tight, more = Counter[str](), Counter[str](), Counter[str]()
    wrong = surfaces = 0
    for number in range(count):
        case = drawn(seed, number)
        fewest, on_surface, on_mesh = brute_force(case)
        surfaces += on_mesh
        bounds = bounds_of(case.instance)
        most = dict.fromkeys(bounds, on_surface)
        if (its := exact(case.instance)) is not None:
            bounds["exact shapes"], most["exact shapes"] = its, fewest
            if its < fewest:
                wrong += 1
                print(f"{number}, {case.kind}: exact shapes {its}, of {fewest}", flush=True)
        for name, bound in bounds.items():
            found[name] += 1
            tight[name] += bound == fewest
            more[name] += bound > bounds["cover"]
            if bound > most[name]:
                wrong += 1
                print(f"{number}, {case.kind}: {name} {bound}, of {most[name]}", flush=True)
    print(f"{count} instances, {surfaces} of them with all colorings of a mesh; {wrong} wrong")
    print(", ".join(f"{number} {name}" for name, number in REASONS.items()), end="\n\n")
    print("| bound | found | is the minimum | more than a cover |\n|---|--:|--:|--:|")
    for name in found:
        print(f"| {name} | {found[name]} | {tight[name]} | {more[name]} |")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
