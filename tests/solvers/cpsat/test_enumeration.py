"""All optimal schemes by CP-SAT: the thread, its end, and lone cells."""

from __future__ import annotations

import time
from itertools import islice
from queue import SimpleQueue

import pytest
import rooms
from dart_graphs import graph_of

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import scheme_key
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import TooLarge
from cellcolor.lab.families import SMALL, hub
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.cpsat.schemes import enumeration, frontier, scheme_model
from cellcolor.solvers.interface import Options, Start

RED, BLUE = 0, 1
CELLS = tuple(Cell(i, (RED, BLUE), ()) for i in range(40))
MANY = Instance("many", ("red", "blue"), CELLS, ())
"""Forty cells of two free colors each have 2**40 optimal schemes."""


@pytest.fixture
def uncounted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Counting is given up at once: CP-SAT lists the schemes."""
    monkeypatch.setattr(frontier, "MOST_STEPS", -1)


@pytest.mark.parametrize(("edges", "catalan"), [(1, 1), (2, 2), (3, 5), (4, 14), (5, 42), (6, 132)])
def test_divisions_of_a_lone_cell(edges: int, catalan: int) -> None:
    """Colors ignored there are Catalan(n) + n: the paper's eight for three edges.

    Three colors are enough for all of them; the petals can be painted in any, so that a state is
    never forced. Every number of segments is asked for, not just the fewest.
    """
    every = (0, 1, 2)
    instance = rooms.hub(*[every] * edges)
    divisions = {
        frozenset(frozenset(sub.darts) for sub in division[0].subcells)
        for segments in range(1, edges + 2)
        for division in CpSatSolver().optimal_schemes(instance, Options(), segments)
    }
    assert len(divisions) == catalan + edges


@pytest.mark.usefixtures("uncounted")
def test_enumeration_gives_nothing_after_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """What waits to be taken when the time is over stays there: taking it needs time as well."""
    found = CpSatSolver().optimal_schemes(MANY, Options(deadline=Deadline.after(1e6)), 40)
    next(found)
    monkeypatch.setattr(Deadline, "over", property(lambda _: True))
    with pytest.raises(OutOfTime):
        next(found)


@pytest.mark.usefixtures("uncounted")
def test_enumeration_stops_when_its_time_is_over() -> None:
    found = CpSatSolver().optimal_schemes(MANY, Options(deadline=Deadline.after(0.5)), 40)
    with pytest.raises(OutOfTime):
        for _ in found:
            pass


@pytest.mark.usefixtures("uncounted")
def test_no_search_is_begun_whose_time_ends_before_the_model_is_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """CP-SAT looks at the clock once it has read the model: of 240,000 constraints after 1.2 s."""
    options = Options(deadline=Deadline.after(60))
    assert next(CpSatSolver().optimal_schemes(MANY, options, 40))
    monkeypatch.setattr(enumeration, "_READING", 60.0)
    with pytest.raises(OutOfTime, match="reads the model"):
        next(CpSatSolver().optimal_schemes(MANY, options, 40))


@pytest.mark.usefixtures("uncounted")
def test_enumeration_waits_for_who_takes_the_schemes(monkeypatch: pytest.MonkeyPatch) -> None:
    """No more than a few schemes wait in memory, however slowly they are taken."""
    monkeypatch.setattr(enumeration, "_AHEAD", 3)
    put: list[object] = []

    class Watched(SimpleQueue[object]):
        def put(self, item: object, block: bool = True, timeout: float | None = None) -> None:
            put.append(item)
            super().put(item, block, timeout)

    monkeypatch.setattr(enumeration, "SimpleQueue", Watched)
    found = CpSatSolver().optimal_schemes(MANY, Options(), 40)
    for taken in range(1, 6):
        next(found)
        time.sleep(0.05)  # the search could fill the memory meanwhile
        assert len(put) <= taken + 3


@pytest.mark.usefixtures("uncounted")
def test_a_model_of_schemes_that_is_too_large_is_not_built(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is counted beforehand is about what there would be."""
    instance = hub(0, 60, 3)
    graph = graph_of(instance)
    model = scheme_model.SchemeModel(graph, 20, NEVER).model
    literals = sum(
        len(constraint.bool_or.literals) + len(constraint.at_most_one.literals)
        for constraint in model.proto.constraints
    )
    monkeypatch.setattr(scheme_model, "MOST_SCHEME_LITERALS", 1.5 * literals)
    scheme_model.check_size(graph, NEVER)
    monkeypatch.setattr(scheme_model, "MOST_SCHEME_LITERALS", 0.7 * literals)
    with pytest.raises(TooLarge, match="one cell has 60 darts"):
        next(CpSatSolver().optimal_schemes(instance, Options(), 20))


@pytest.mark.usefixtures("uncounted")
def test_enumeration_can_be_left_early() -> None:
    found = CpSatSolver().optimal_schemes(MANY, Options(), 40)
    assert len({scheme_key(next(found)) for _ in range(5)}) == 5
    found.close()  # type: ignore[attr-defined]


@pytest.mark.usefixtures("uncounted")
def test_schemes_near_a_known_one_are_handed_out_while_the_search_finds_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """CP-SAT's search is held up; the known scheme and others come all the same, each once."""
    made = SMALL["smooth blobs"](3)
    assert not isinstance(made, Instance)
    instance = decompose(made)
    solution = solve(instance, Options())
    assert solution.segments is not None and solution.cells is not None
    options = Options(start=Start(solution.cells, solution.seams), deadline=Deadline.after(60))
    everything = {
        scheme_key(division)
        for division in enumerate_schemes(instance, Options(), "dfs", solution.segments)
    }
    monkeypatch.setattr(enumeration._Collector, "on_solution_callback", lambda _: time.sleep(0.1))
    # What is near is counted by dynamic programming, which is possible again.
    found = CpSatSolver().optimal_schemes(instance, options, solution.segments)
    near = [scheme_key(next(found))]
    monkeypatch.setattr(frontier, "MOST_STEPS", 1_000_000)
    near += [scheme_key(division) for division in islice(found, 3)]
    assert len(set(near)) == len(near) > 1
    assert everything.issuperset(near)


@pytest.mark.parametrize("family", sorted(SMALL))
def test_counted_schemes_are_those_of_the_depth_first_search(family: str) -> None:
    """Listed once each, and counted before they are listed."""
    for seed in range(3):
        made = SMALL[family](seed)
        instance = made if isinstance(made, Instance) else decompose(made)
        segments = solve(instance, Options()).segments
        assert segments is not None
        schemes = CpSatSolver().optimal_schemes(instance, Options(), segments)
        found = [scheme_key(division) for division in schemes]
        assert len(set(found)) == len(found) == schemes.count
        if instance.most_live_loops < 2:
            other = enumerate_schemes(instance, Options(), "dfs", segments)
            assert {scheme_key(division) for division in other} == set(found)


def test_two_to_the_fortieth_schemes_are_counted() -> None:
    schemes = CpSatSolver().optimal_schemes(MANY, Options(), 40)
    assert scheme_key(next(schemes)) != scheme_key(next(schemes))
    assert schemes.count == 2**40
