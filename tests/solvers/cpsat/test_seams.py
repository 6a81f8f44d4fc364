"""Seams of cells with three live loops are wide enough in whatever order the loops are joined."""

from __future__ import annotations

import pytest
from ortools.sat.python import cp_model

from cellcolor.checker.dart_lists import live_lists
from cellcolor.checker.division import check_division
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam, number_segments
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.interface import Start

S1, S2, T1, T2, U, V = range(6)
LONG = (S1, S2, U, S2, S1, T1, T2, V, T2, T1)


def nested_arcs(swapped: bool) -> Instance:
    """A cell with six colors around which each dart has a leaf cell in a color of its own.

    Loops of one dart, 11 in color U and 12 in V, lie in a nest of arcs each. Six segments suffice:
    two colors S around U, two colors T around V.
    """
    color_of = dict(enumerate((*LONG, U, V), start=1))
    loops = [(10, *range(1, 10)), (11,), (12,)]
    if swapped:
        loops[1:] = loops[:0:-1]
    leaves = [Cell(dart, (color,), ((-dart,),)) for dart, color in color_of.items()]
    hub = Cell(0, tuple(range(6)), tuple(loops))
    edges = tuple(Edge(dart, 0, dart) for dart in color_of)
    return Instance("nested arcs", ("S1", "S2", "T1", "T2", "U", "V"), (hub, *leaves), edges)


def matched(colors: list[int]) -> list[tuple[int, int]] | None:
    """Pairs of equal colors on a list that do not cross, found by removing neighbors."""
    left: list[int] = []
    pairs = []
    for place, color in enumerate(colors):
        if left and colors[left[-1]] == color:
            pairs.append((left.pop(), place))
        else:
            left.append(place)
    return None if left else pairs


@pytest.mark.parametrize(
    ("swapped", "crossed"),
    [
        (False, {11: (S1, S2), 12: (T1, T2)}),
        # The seams leave in the other order: one of them goes around the other loop.
        (True, {12: (T1, T2), 11: (T1, T2, V, T2, T1, S1, S2)}),
    ],
)
def test_either_order_has_room_for_the_best_division(
    swapped: bool, crossed: dict[int, tuple[int, ...]]
) -> None:
    """Held against the checker, which knows nothing of how wide the model's seams are."""
    instance = nested_arcs(swapped)
    first, *others = instance.cells[0].loops
    seams = tuple(
        Seam(13 + number, 0, first[0], dart, len(crossed[dart]))
        for number, (dart,) in enumerate(others)
    )
    color_of = {(dart, 1): color for dart, color in enumerate((*LONG, U, V), start=1)}
    for seam, (dart,) in zip(seams, others, strict=True):
        for strand, color in enumerate(crossed[dart], start=1):
            color_of[seam.id, strand] = color_of[-seam.id, strand] = color
    (darts, *_) = live_lists(instance, seams, 1)
    pairs = matched([color_of[dart] for dart in darts])
    assert pairs is not None
    hub = [(color_of[darts[a]], [darts[a], darts[b]]) for a, b in pairs]
    leaves = [[(color_of[dart, 1], [(-dart, 1)])] for dart in range(1, 13)]
    division = number_segments([hub, *leaves])
    report = check_division(instance, division, seams, 1)
    assert (report.valid, report.segments) == (True, 6)

    built = CompleteModel(instance)
    built.begin_with(Start(division, seams))
    solver = cp_model.CpSolver()
    solver.parameters.fix_variables_to_their_hinted_value = True
    solver.solve(built.model)
    assert solver.objective_value == 6
