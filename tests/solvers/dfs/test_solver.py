"""The depth-first searches on small and odd instances; what they refuse, and their limits."""

from __future__ import annotations

import random

import pytest
from library import PAPER
from reference import COVERED, SOLVER, SURFACE, segments
from relabelled import renamed, turned

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.solution import scheme_key
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.lab.families import hub, planar_graph
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Answer, Options

BOTH = pytest.mark.parametrize("solver", [SOLVER, COVERED], ids=["dfs", "dfs-cover"])


def schemes(solver: ReferenceSolver, instance: Instance, count: int) -> int:
    found = [scheme_key(d) for d in solver.optimal_schemes(instance, Options(), count)]
    assert len(found) == len(set(found))
    return len(found)


def test_no_cells_have_no_segments() -> None:
    nothing = Instance("nothing", ("red",), (), ())
    search = Bound("search", 0, "strands")
    assert SOLVER.minimize(nothing, Options()) == Answer((), (), (search,))
    cover = Bound("cover", 0, "surface")
    assert COVERED.minimize(nothing, Options()) == Answer((), (), (cover, search))
    assert list(SOLVER.optimal_schemes(nothing, Options(), 0)) == [()]


@BOTH
def test_one_cell_without_border(solver: ReferenceSolver) -> None:
    """A closed surface of one cell: one segment, in any of its colors."""
    sphere = Instance("sphere", ("red", "blue"), (Cell(0, (0, 1), ()),), ())
    answer = solver.minimize(sphere, Options())
    assert segments(sphere, answer) == answer.lower_bound == 1
    assert schemes(solver, sphere, 1) == 2


@BOTH
def test_a_self_edge_joins_a_cell_to_itself(solver: ReferenceSolver) -> None:
    """A cylinder cut open: its two sides joined, or the same color shown twice, which is a lie."""
    cylinder = Instance("cylinder", ("red",), (Cell(0, (0,), ((1, 2, -1, 3),)),), _edges(3))
    assert segments(cylinder, solver.minimize(cylinder, Options())) == 1
    (division,) = solver.optimal_schemes(cylinder, Options(), 1)
    assert set(division[0].subcells[0].darts) == {1, -1}


def _edges(count: int) -> tuple[Edge, ...]:
    return (Edge(1, 0, 0), *(Edge(i, 0, -1) for i in range(2, count + 1)))


@BOTH
@pytest.mark.parametrize("seed", range(12))
def test_names_do_not_matter(solver: ReferenceSolver, seed: int) -> None:
    """Cells, colors and edges renamed, loops begun elsewhere: same minimum, as many schemes."""
    instance = planar_graph(seed, 5, 8, 3, self_edges=seed % 2 == 0)
    rng = random.Random(seed)
    other = turned(renamed(instance, rng), rng)
    best = segments(instance, solver.minimize(instance, Options()))
    assert segments(other, solver.minimize(other, Options())) == best
    assert schemes(solver, other, best) == schemes(solver, instance, best)


@BOTH
def test_schemes_of_a_wrong_minimum_are_refused(solver: ReferenceSolver) -> None:
    ring = Instance.read(PAPER / "ring.json")
    for wrong in (1, 3):
        with pytest.raises(ValueError, match="the minimum is 2"):
            list(solver.optimal_schemes(ring, Options(), wrong))


def two_rows(count: int) -> Instance:
    """Two rows, cells with red or blue in turn, and between them cells with both.

    Each of these is painted like its left or its right neighbor, so that a row with n of them has
    2^n optimal schemes, of n + 1 segments.
    """
    cells: list[Cell] = []
    edges: list[Edge] = []
    for _ in range(2):
        first = len(cells)
        for place in range(2 * count + 1):
            cell = first + place
            left = (-len(edges),) if place else ()
            right = (len(edges) + 1,) if place < 2 * count else ()
            colors = (0, 1) if place % 2 else ((place // 2) % 2,)
            cells.append(Cell(cell, colors, ((*left, *right),)))
            if right:
                edges.append(Edge(len(edges) + 1, cell, cell + 1))
    return Instance("two rows", ("red", "blue"), tuple(cells), tuple(edges))


@BOTH
def test_schemes_of_parts_are_combined_in_all_ways(solver: ReferenceSolver) -> None:
    """8 schemes of each row."""
    assert schemes(solver, two_rows(3), 8) == 64


def test_the_first_scheme_of_all_waits_for_one_of_each_part() -> None:
    """Not until all 2^60 of a row are listed."""
    division = next(COVERED.optimal_schemes(two_rows(60), Options(), 122))
    assert len(division) == 2 * 121


def test_combining_parts_ends_with_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    found = SOLVER.optimal_schemes(two_rows(3), Options(deadline=Deadline.after(1e6)), 8)
    next(found)
    monkeypatch.setattr(Deadline, "over", property(lambda _: True))
    with pytest.raises(OutOfTime):
        next(found)


@BOTH
def test_depth_has_no_end(solver: ReferenceSolver) -> None:
    """A row of 1,500 cells, more than Python's stack has levels, is one segment."""

    def row(count: int) -> Instance:
        loops = [(1,), *((-i, i + 1) for i in range(1, count - 1)), (1 - count,)]
        cells = tuple(Cell(i, (0,), (loop,)) for i, loop in enumerate(loops))
        edges = tuple(Edge(i, i - 1, i) for i in range(1, count))
        return Instance("row", ("red",), cells, edges)

    long = row(1500)
    assert segments(long, solver.minimize(long, Options(deadline=Deadline.after(60.0)))) == 1


def test_time_limit_gives_the_best_so_far() -> None:
    """40 petals are out of reach, and 6 colors give no useful bound: only the limit ends this."""
    instance = hub(0, 40, 6)
    assert instance.known is not None and instance.known.paper is not None
    answer = COVERED.minimize(instance, Options(deadline=Deadline.after(0.5)))
    assert answer.lower_bound == 6  # one segment for each color
    if answer.division is not None:
        assert segments(instance, answer) >= instance.known.paper.segments
    with pytest.raises(OutOfTime):
        list(COVERED.optimal_schemes(instance, Options(deadline=Deadline.after(0.2)), 20))


def test_no_time_at_all_gives_no_division() -> None:
    options = Options(deadline=Deadline.after(-1.0))
    search = Bound("search", 1, "strands")
    assert SOLVER.minimize(hub(4, 8, 3), options) == Answer(None, (), (search,))
    # One connected part, of which not even a cover was looked for.
    cover = Bound("cover", 1, "surface")
    assert COVERED.minimize(hub(4, 8, 3), options) == Answer(None, (), (cover, search))


@pytest.mark.parametrize(("solver", "bound"), [(SOLVER, 1), (COVERED, 4)])
def test_progress_closes_the_gap(solver: ReferenceSolver, bound: int) -> None:
    """The paper's search knows nothing before it has found a division; the cover is 4 colors."""
    instance = hub(0, 10, 4)
    calls: list[tuple[int | None, int]] = []
    answer = solver.minimize(instance, Options(), lambda best, bound: calls.append((best, bound)))
    best = segments(instance, answer)
    assert calls[0] == (None, bound) and calls[-1] == (best, best)
    found = [value for value, _ in calls if value is not None]
    assert found == sorted(found, reverse=True) and len(found) > 2


def test_bound_in_surface_is_not_the_minimum_of_two_strands() -> None:
    """The minimum with k strands is proved for k strands only: the bound stays what covers say."""
    instance = Instance.read(PAPER / "figeasycell4.json")
    answer = COVERED.minimize(instance, SURFACE)
    assert segments(instance, answer, strands=2) == 3
    assert answer.lower_bound == 2


@pytest.mark.parametrize(
    ("name", "minimum"),
    [("annulus", 3), pytest.param("three-loops", 4, marks=pytest.mark.slow)],
)
def test_order_of_loops_does_not_matter(name: str, minimum: int) -> None:
    instance = Instance.read(PAPER / f"{name}.json")
    for seed in range(4):
        other = turned(instance, random.Random(seed))
        assert segments(other, COVERED.minimize(other, Options())) == minimum


def test_seams_carry_what_must_pass() -> None:
    """Strands are added one by one, so seams that have some could not do without."""
    instance = Instance.read(PAPER / "three-loops.json")
    answer = COVERED.minimize(instance, Options())
    assert segments(instance, answer) == 4
    assert len(answer.seams) == 2 and all(seam.strands > 0 for seam in answer.seams)
    assert {seam.id for seam in answer.seams} == {9, 10}  # above its 8 edges
