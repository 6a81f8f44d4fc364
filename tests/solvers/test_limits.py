"""The solver's limits: what is bounded, estimated and divided up, so that time and memory hold."""

from __future__ import annotations

import time
from itertools import combinations

import pytest
from conflicts import conflicts
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES

from cellcolor.checker.division import check_solution
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import TooLarge
from cellcolor.lab.families import blobs, hub, planar_graph
from cellcolor.lab.families.graphs import hub_with_loops
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CompleteModel, complete_model
from cellcolor.solvers.cpsat import part as part_module
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)
OVER = Deadline.after(-1.0)


# --- conflicts ------------------------------------------------------------------------------------


def test_conflicts_between_forty_loops() -> None:
    """A way past each loop has two sides to choose: 2^40 ways, had they to be tried one by one."""
    instance = hub_with_loops(1, 40, 2, 2)
    for first, second in combinations(color_regions(instance), 2):
        # With so many loops there is always a way around, so nothing is in conflict.
        assert conflicts(instance, first, second) == []


@pytest.mark.parametrize("islands", [0, 25])
def test_loops_beside_do_not_hide_a_conflict(islands: int) -> None:
    """Petals in turn on one loop cross, whatever single petals lie on loops within."""
    around = [Cell(n, (n % 2,), ((-n,),)) for n in range(1, 5)]
    inside = [Cell(n, (n % 2,), ((-n,),)) for n in range(5, 5 + islands)]
    loops = ((1, 2, 3, 4), *((n,) for n in range(5, 5 + islands)))
    cells = (Cell(0, (0, 1), loops), *around, *inside)
    edges = tuple(Edge(n, 0, n) for n in range(1, 5 + islands))
    instance = Instance("islands", ("red", "blue"), cells, edges)
    found = conflicts(instance, *color_regions(instance))
    outer = [c for c in found if all(max(area) < 5 for area in (*c.one, *c.other))]
    assert [({*map(min, c.one)}, {*map(min, c.other)}) for c in outer] == [({2, 4}, {1, 3})]


# --- bounds ---------------------------------------------------------------------------------------


@examples(15)
@given(seed=SEEDS, cells=st.integers(1, 12), colors=st.integers(1, 5))
def test_a_cover_without_time_is_a_cover_all_the_same(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    hasty, exact = set_cover(color_regions(instance), OVER), set_cover(color_regions(instance))
    assert set().union(*(touched for _, touched in hasty.regions)) == set(range(cells))
    assert 1 <= hasty.bound <= exact.bound == len(exact.regions) <= len(hasty.regions)


# --- deadlines ------------------------------------------------------------------------------------


def test_a_model_is_built_within_the_deadline() -> None:
    with pytest.raises(OutOfTime):
        CompleteModel(hub(5, 12, 2), deadline=OVER)


@pytest.mark.parametrize("solver", ["cp-sat", "cp-sat-model"])
def test_an_interrupt_at_any_moment_leaves_a_division(
    solver: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Out of time after n looks at the clock, for every n that there is."""
    instance = decompose(blobs(5, size=12, colors=4))
    looks = 0

    def over(deadline: Deadline) -> bool:
        nonlocal looks
        if deadline == NEVER:  # the checker looks at this one, and is not to be stopped
            return False
        looks -= 1
        return looks < 0

    monkeypatch.setattr(Deadline, "over", property(over))
    best = []
    for allowed in (0, 1, 2, 3, 5, 8, 13, 30, 10**9):
        looks = allowed
        found = solve(instance, Options(deadline=Deadline.after(1000.0), workers=1), solver)
        assert check_solution(instance, found).valid
        if found.segments is None:  # the model was not built in time
            assert solver == "cp-sat-model" and (found.lower_bound, found.status) == (0, "unknown")
            continue
        assert found.lower_bound <= found.segments
        best.append(found.segments)
    assert best[-1] == found.lower_bound
    assert solver == "cp-sat-model" or best[-1] < best[0]


# --- memory ---------------------------------------------------------------------------------------


def test_what_is_too_large_is_not_built_and_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (part_module, complete_model):
        monkeypatch.setattr(module, "MOST_LITERALS", 10)
    instance = planar_graph(3, 8, 12, 4)
    with pytest.raises(TooLarge, match="was not built"):
        solve(instance, Options(), "cp-sat-model")
    # Everything else is done, and an unproved minimum says why.
    found = solve(instance, Options(deadline=Deadline.after(1.0), workers=1))
    assert found.segments is not None
    assert found.status == "optimal" or any("was not built" in note for note in found.notes)


@pytest.mark.second
@pytest.mark.parametrize(("loops", "petals"), [(6, 4), (20, 3)])
def test_many_loops(loops: int, petals: int) -> None:
    """Up to 570 strands of seams in one cell."""
    instance = hub_with_loops(1, loops, petals, 4)
    start = time.monotonic()
    found = solve(instance, Options(deadline=Deadline.after(4.0), workers=1))
    assert time.monotonic() - start < 6.0
    assert found.segments is not None
    assert check_solution(instance, found).valid


@pytest.mark.parametrize("name", ["machined-part", "machined-part-raw"])
def test_a_real_part_is_proved(name: str) -> None:
    """Up to 90 darts and 6 loops a cell; cover 3 and 4, and the checker sees the division."""
    instance = Instance.read(INSTANCES / "parts" / f"{name}.json")
    found = solve(instance, Options(deadline=Deadline.after(100.0), workers=1))
    assert found.proved_for_surface and check_solution(instance, found).valid
    assert found.lower_bound == found.segments == 4


# --- parts ----------------------------------------------------------------------------------------
