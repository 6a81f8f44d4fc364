"""The CP-SAT solver: known minima, search spaces, starts, odd instances, progress."""

from __future__ import annotations

from functools import partial

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from library import INSTANCES

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, hub, hub_minimum, hub_with_loops
from cellcolor.lab.families.registry import MEDIUM
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.cpsat.dart_graph import split
from cellcolor.solvers.cpsat.painting import division_of
from cellcolor.solvers.cpsat.part import Part
from cellcolor.solvers.interface import Options, Start
from cellcolor.solvers.interruptible import Runner
from examples import examples

RED, BLUE = 0, 1

SEEDS = st.integers(0, 10**6)


@examples(12)
@given(seed=SEEDS, petal_count=st.integers(2, 14), colors=st.integers(2, 5))
def test_hubs_have_their_known_minimum(seed: int, petal_count: int, colors: int) -> None:
    if colors == 2 and petal_count % 2:
        petal_count += 1  # two colors can alternate around an even ring only
    instance = hub(seed, petal_count, colors)
    ring = [cell.colors[0] for cell in instance.cells[1:]]
    assert solve(instance, Options()).segments == hub_minimum(ring)


def test_a_start_is_kept_when_there_is_no_time() -> None:
    instance = decompose(blobs(3))
    good = solve(instance, Options())
    assert good.cells is not None
    start = Start(good.cells, good.seams)
    found = solve(instance, Options(deadline=Deadline.after(0.0), start=start))
    assert found.segments == good.segments


def test_without_any_time_there_is_a_division_all_the_same() -> None:
    """Every cell painted whole; and a bound that takes no search."""
    instance = decompose(blobs(3))
    found = solve(instance, Options(deadline=Deadline.after(0.0)))
    assert found.status == "feasible" and [bound.kind for bound in found.bounds] == ["strangers"]
    assert found.segments is not None and found.segments <= len(instance.cells)
    assert (
        1 <= found.surface_lower_bound <= set_cover(color_regions(instance)).bound < found.segments
    )


@pytest.mark.parametrize("instance", [Instance("empty", (), (), ()), Instance("e", ("r",), (), ())])
def test_empty_instance(instance: Instance) -> None:
    found = solve(instance, Options())
    assert (found.status, found.segments, found.lift_offs, found.cells) == ("optimal", 0, 0, ())
    assert list(CpSatSolver().optimal_schemes(instance, Options(), 0)) == [()]


def test_progress_comes_closer_and_never_passes_the_minimum() -> None:
    seen: list[tuple[int | None, int]] = []
    instance = hub(3, 12, 3)
    minimum = hub_minimum([cell.colors[0] for cell in instance.cells[1:]])
    CpSatSolver().minimize(instance, Options(), lambda best, bound: seen.append((best, bound)))
    assert seen[-1] == (minimum, minimum)
    assert all(bound <= minimum for _, bound in seen)
    best = [found for found, _ in seen if found is not None]
    assert best == sorted(best, reverse=True) and best[-1] == minimum


def part_of(instance: Instance) -> Part:
    """The largest part, covered."""
    options = Options()
    part = Part(*split(instance)[-1], options, Runner(options), lambda: None)
    part.cover(NEVER)
    return part


@examples(15)
@given(seed=SEEDS, petals=st.integers(2, 3))
@example(seed=0, petals=3)
def test_plans_that_are_decided_one_by_one_prove_the_minimum(seed: int, petals: int) -> None:
    """On hubs with two loops, held against the depth-first search, without the whole model."""
    instance = hub_with_loops(seed, 2, petals, 3)
    part = part_of(instance)
    if not part.done:
        part.separate(4.0, NEVER, decide=True)
    assert part.done and part.segments == solve(instance, Options(), "dfs").segments
    if (seed, petals) == (0, 3):  # no pair of its segments has to cross, but four of them would
        assert (part.bound_kind, part.surface_bound, part.bound) == ("exact", 3, 4)


@pytest.mark.parametrize(
    ("instance", "most"),
    [
        (decompose(MEDIUM["rim"](26)), None),
        # By solving one window after another it had 17 in minutes.
        (Instance.read(INSTANCES / "hard" / "large_part_1.json"), 16),
    ],
    ids=["rim", "large part"],
)
def test_local_search_leaves_a_legal_division(instance: Instance, most: int | None) -> None:
    part = part_of(instance)
    before = part.segments
    part.improve(0, NEVER)
    graph, painting = part.best
    report = check_division(part.instance, division_of(graph, painting), seams=graph.seams)
    assert report.valid, report.problems
    assert part.bound <= part.segments < before
    assert report.segments == part.segments
    assert most is None or part.segments <= most


def test_a_step_ends_with_its_share_of_the_time() -> None:
    part = part_of(decompose(MEDIUM["rim"](26)))
    known = part.segments, part.bound
    for step in (partial(part.separate, 0.5), partial(part.improve, 0)):
        with pytest.raises(OutOfTime):
            step(deadline=Deadline.after(0))
    assert not part.done and (part.segments, part.bound) == known
