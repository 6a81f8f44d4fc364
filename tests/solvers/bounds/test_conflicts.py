"""Conflicts: pairs of segments that would have to cross, against paths on the mesh itself."""

from __future__ import annotations

from itertools import combinations

from conflicts import conflicts
from library import PAPER
from rooms import graph, hub, petal_cells

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.conflicts import MergedCell
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

RED, BLUE, GREEN = 0, 1, 2


def areas(pair: tuple[MergedCell, MergedCell]) -> tuple[list[int], list[int]]:
    one, other = pair
    return sorted(one), sorted(other)


def test_petals_in_turn_are_in_conflict() -> None:
    red, blue = color_regions(hub(RED, BLUE, RED, BLUE))
    (found,) = conflicts(hub(RED, BLUE, RED, BLUE), red, blue)
    assert areas(found.one) == ([1], [3])
    assert areas(found.other) == ([2], [4])


def test_petals_side_by_side_are_not() -> None:
    red, blue = color_regions(hub(RED, RED, BLUE, BLUE))
    assert conflicts(hub(RED, RED, BLUE, BLUE), red, blue) == []


def test_a_way_around_is_no_conflict() -> None:
    """The red petals of the hub also meet behind one of the blue ones."""
    instance = graph(
        ((RED, BLUE), (1, 2, 3, 4)),
        ((RED,), (-1, 5)),
        ((BLUE,), (-2,)),
        ((RED,), (-3, -5)),
        ((BLUE,), (-4,)),
    )
    red, blue = color_regions(instance)
    assert conflicts(instance, red, blue) == []


def test_corridors_side_by_side_are_no_conflict() -> None:
    """They cross one edge together, which paper forbids and the surface does not."""
    instance = Instance.read(PAPER / "parallel-corridors.json")
    for first, second in combinations(color_regions(instance), 2):
        assert conflicts(instance, first, second) == []


def test_a_handle_leads_past() -> None:
    """Petals in turn, but the hub's edge 1 leads from between two of them to a second border."""
    instance = graph(((RED, BLUE), (5, 1, 2, 3, 4), (-5,)), *petal_cells(RED, BLUE, RED, BLUE))
    red, blue = color_regions(instance)
    assert conflicts(instance, red, blue) == []
    found = solve(instance, Options())
    assert (found.segments, found.lower_bound) == (2, 2)


def test_a_conflict_is_proved_for_any_division() -> None:
    """Red from top to bottom and blue from left to right, over two cells of both colors.

    Nothing limits how often the edge between these two is crossed, and one strand is tried.
    """
    instance = graph(
        ((RED,), (1, 2)),
        ((RED,), (3, 4)),
        ((RED, BLUE), (-1, 5, -3, 6)),
        ((RED, BLUE), (-2, -6, -4, 7)),
        ((BLUE,), (-5,)),
        ((BLUE,), (-7,)),
    )
    assert set_cover(color_regions(instance)).bound == 2
    found = solve(instance, Options())
    assert (found.segments, found.surface_lower_bound) == (3, 3)
    assert found.proved_for_surface


def test_a_handle_of_one_color_leads_nobody_past() -> None:
    """Petals in turn; one of the red ones is a torus with a hole, which blue never enters."""
    with_handle = ((RED,), (-1, 5, 6, -5, -6))
    instance = graph(
        ((RED, BLUE), (1, 2, 3, 4)), with_handle, *petal_cells(RED, BLUE, RED, BLUE)[1:]
    )
    red, blue = color_regions(instance)
    (found,) = conflicts(instance, red, blue)
    assert (areas(found.one), areas(found.other)) == (([1], [3]), ([2], [4]))
    assert solve(instance, Options()).surface_lower_bound == 3
