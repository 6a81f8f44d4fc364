"""Rows of thousands of cells, and many parts: nothing falls, and what is proved can be verified."""

from __future__ import annotations

from itertools import pairwise

import pytest

from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.division import check_solution
from cellcolor.checker.groups import regions_of_cells
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.slow

DEEP = 1500
"""Python's stack has room for a thousand calls."""


def row(colors: list[tuple[int, ...]]) -> Instance:
    """Cells in a row."""
    edges = tuple(Edge(n + 1, n, n + 1) for n in range(len(colors) - 1))
    cells = tuple(
        Cell(n, own, ((*([-n] if n > 0 else []), *([n + 1] if n + 1 < len(colors) else [])),))
        for n, own in enumerate(colors)
    )
    names = tuple(f"c{color}" for color in range(1 + max(map(max, colors))))
    return Instance("row", names, cells, edges)


def rings(number: int, size: int = 5) -> Instance:
    """Rings of cells that share a color with each neighbor only, apart from each other.

    Two neighbors can be one segment and no three cells: ⌈size / 2⌉ segments a ring. Of a ring of
    odd size only ⌊size / 2⌋ cells are strangers.
    """
    cells, edges = [], []
    for first in range(0, number * size, size):
        ids = [first + n for n in range(size)]
        for n, (one, other) in enumerate(pairwise([*ids, first])):
            edges.append(Edge(one + 1, one, other))
            before = first + (n - 1) % size + 1
            own = tuple(sorted({n, (n - 1) % size}))
            cells.append(Cell(one, own, ((one + 1, -before),)))
    return Instance("rings", tuple(f"c{n}" for n in range(size)), tuple(cells), tuple(edges))


@pytest.mark.parametrize("solver", ["cp-sat", "dfs"])
def test_a_row_of_cells_in_one_color(solver: str) -> None:
    instance = row([(0, 1) if n % 2 else (0,) for n in range(DEEP)])
    solution = solve(instance, Options(workers=1), solver)
    assert (solution.status, solution.segments) == ("optimal", 1)


def test_a_row_of_strangers_and_a_cover_that_is_forged() -> None:
    """Neighbors share no color, so that each cell is a segment of its own."""
    instance = row([(n % 3,) for n in range(2 * DEEP)])
    regions = regions_of_cells(instance)
    everything = {"cells": [cell.id for cell in instance.cells]}
    for value, outcome in ((2 * DEEP, "verified"), (2 * DEEP + 1, "refused")):
        bound = Bound("cover", value, "surface", everything)
        assert verify_bound(instance, bound, regions).outcome == outcome


@pytest.mark.parametrize("number", [1, 7, 50])
def test_rings_apart_have_a_certificate_and_the_reason_that_holds(number: int) -> None:
    instance = rings(number)
    solution = solve(instance, Options(workers=1))
    (bound,) = solution.bounds or ()
    assert (bound.kind, bound.value, solution.segments) == ("cover", 3 * number, 3 * number)
    assert bound.certificate is not None
    assert [str(verdict.outcome) for verdict in check_solution(instance, solution).bounds] == [
        "verified"
    ]
    more = Bound("cover", 3 * number + 1, "surface", bound.certificate)
    assert verify_bound(instance, more, regions_of_cells(instance)).outcome == "refused"
