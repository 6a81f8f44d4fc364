"""A first division: whole cells, painted in the colors of one smallest cover.

On robot scenes the set-cover bound is nearly always the minimum, and undivided cells are nearly
always enough for it; then this small model finds what the full one would take long to find.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence

from ortools.sat.python import cp_model

from cellcolor.solvers.bounds import Region
from cellcolor.solvers.cpsat.graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block, Painting

__all__ = ["paint_whole_cells"]


def paint_whole_cells(
    graph: DartGraph,
    regions: Sequence[Region],
    solver: cp_model.CpSolver,
    solve: Callable[[cp_model.CpSolver, cp_model.CpModel], cp_model.CpSolverStatus],
) -> Painting | None:
    """Paint undivided cells with few segments.

    Args:
        graph: the dart graph.
        regions: the color regions to paint with; they touch every cell.
        solver: with its limits, workers and seed set.
        solve: runs it.

    Returns:
        A painting, or None when none was found in time.
    """
    model = cp_model.CpModel()
    count = len(graph.lists)
    painted = {
        (cell, color): model.new_bool_var("") for color, cells in regions for cell in sorted(cells)
    }
    root = [model.new_bool_var("") for _ in range(count)]
    rank = [model.new_int_var(0, count, "") for _ in range(count)]
    ways: list[list[cp_model.IntVar]] = [[literal] for literal in root]
    across: dict[tuple[int, int], set[int]] = defaultdict(set)
    for dart in graph.darts:
        other = graph.darts[dart.twin].cell
        if dart.cell != other:
            across[dart.cell, other] |= dart.colors
    for (cell, parent), colors in across.items():
        for color in sorted(colors):
            if (cell, color) in painted and (parent, color) in painted:
                way = model.new_bool_var("")
                ways[cell].append(way)
                model.add_implication(way, painted[cell, color])
                model.add_implication(way, painted[parent, color])
                model.add(rank[cell] > rank[parent]).only_enforce_if(way)
    for cell in range(count):
        model.add_exactly_one(ways[cell])
        model.add_exactly_one(
            painted[cell, color] for color in sorted(graph.colors[cell]) if (cell, color) in painted
        )
    # The regions are a smallest cover.
    model.add(sum(root) >= len(regions))
    model.minimize(sum(root))
    if solve(solver, model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    color_of = {
        cell: color for (cell, color), literal in painted.items() if solver.boolean_value(literal)
    }
    return [[Block(color_of[cell], set())] for cell in range(count)]
