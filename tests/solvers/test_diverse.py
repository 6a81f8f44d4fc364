"""A few schemes that differ as much as possible, against all choices of so many."""

from itertools import combinations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Division, SubCell, scheme_key
from cellcolor.decomposition import decompose
from cellcolor.lab.families import SMALL
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.diverse import most_different, pool_of
from cellcolor.solvers.interface import Options


def lone(areas: list[float | None], colors: int) -> Instance:
    """Cells without borders, each with all colors."""
    every = tuple(range(colors))
    cells = tuple(Cell(i, every, (), area) for i, area in enumerate(areas))
    return Instance("lone", tuple(map(str, every)), cells, ())


def painted(colors: tuple[int, ...]) -> Division:
    return tuple(CellDivision(i, (SubCell(c, (), i),)) for i, c in enumerate(colors))


AREAS = st.lists(st.integers(1, 9).map(float), min_size=2, max_size=4)


@given(areas=AREAS, colors=st.integers(2, 3), number=st.integers(2, 3), data=st.data())
def test_no_other_choice_is_more_than_twice_as_diverse(
    areas: list[float], colors: int, number: int, data: st.DataObject
) -> None:
    every = list(product(range(colors), repeat=len(areas)))
    some = data.draw(st.lists(st.sampled_from(every), unique=True, min_size=number, max_size=9))

    def apart(one: tuple[int, ...], other: tuple[int, ...]) -> float:
        return sum(area for area, a, b in zip(areas, one, other, strict=True) if a != b)

    def least(chosen: tuple[tuple[int, ...], ...]) -> float:
        return min(apart(one, other) for one, other in combinations(chosen, 2))

    instance = lone(list(areas), colors)
    found = most_different(instance, list(map(painted, some)), number)
    chosen = tuple(tuple(own.subcells[0].color for own in division) for division in found)
    assert chosen[0] == some[0] and len(chosen) == number
    assert 2 * least(chosen) >= max(map(least, combinations(some, number)))
    # Each is a farthest one from those before it.
    for count in range(1, number):
        before = chosen[:count]
        nearest = {own: min(apart(own, other) for other in before) for own in some}
        assert nearest[chosen[count]] == max(nearest.values())


@pytest.mark.parametrize("family", sorted(SMALL))
def test_of_divided_cells_too_all_are_chosen_before_any_twice(family: str) -> None:
    made = SMALL[family](1)
    instance = made if isinstance(made, Instance) else decompose(made)
    segments = solve(instance, Options()).segments
    assert segments is not None
    every = list(enumerate_schemes(instance, Options(), "cp-sat", segments, pool=True))
    chosen = most_different(instance, every[:30], 1000)
    keys = [scheme_key(division) for division in chosen]
    assert len(keys) == len(set(keys)) == len(every[:30])


def test_a_pool_of_many_is_drawn_from_all_over() -> None:
    """The first of 2**40 schemes found one after the other would leave most cells as they are."""
    instance = lone([None] * 40, 2)
    pool = list(enumerate_schemes(instance, Options(), "cp-sat", 40, pool=True))
    assert len({scheme_key(division) for division in pool}) == len(pool) == 1000
    one, other = most_different(instance, pool, 2)
    differ = sum(a.subcells != b.subcells for a, b in zip(one, other, strict=True))
    # Of 999 drawn at random the farthest differs in 30 of 40 cells: mean 20, deviation 3.2.
    assert differ >= 27


def test_a_pool_of_few_is_all_of_them() -> None:
    found = iter([painted((0, 1)), painted((1, 0)), painted((1, 1))])
    assert list(pool_of(found)) == [painted((0, 1)), painted((1, 0)), painted((1, 1))]
    assert len(list(pool_of(iter([painted((0, 1)), painted((1, 0))]), 1))) == 1
