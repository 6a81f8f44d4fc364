"""The full model within a quota: so many segments in each color region, and no more.

A plan says how many segments each color region has. The full model in the colors of one plan is far
smaller than in all colors. It also knows what the planner knows of segments that cannot be drawn
together: the model of plans is part of it, and a cell that is joined in a color is touched by a
segment of the plan (docs/encodings/one-plan.md).
"""

from __future__ import annotations

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region, color_regions
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.full import Model, full_model
from cellcolor.solvers.cpsat.routes.segment_plans import Planner, Quota


def colors_within(quota: Quota, cells: int) -> tuple[frozenset[int], ...]:
    """The colors that each cell may have within a quota.

    Args:
        cells: how many there are.
    """
    colors: list[set[int]] = [set() for _ in range(cells)]
    for color, region in quota:
        for cell in region:
            colors[cell].add(color)
    return tuple(map(frozenset, colors))


def quota_model(
    graph: DartGraph,
    planner: Planner,
    quota: Quota,
    segments: int,
    deadline: Deadline,
) -> Model:
    """A model of the divisions with a number of segments that keep to a quota, with no objective.

    Cells that are alone count as segments, but not in the quota, since they have no color in the
    model. So a solution may be a division that does not keep to the quota; it meets the bound.

    Args:
        graph: in the colors of the quota.
        segments: no division has fewer.
    """
    planned = planner.model_within(quota, segments)
    regions = color_regions(planner.instance, graph.colors)
    built = full_model(graph, regions, deadline=deadline, model=planned.model)
    model, v = built.model, built.variables
    model.clear_objective()  # type: ignore[no-untyped-call]
    model.add(built.segments <= segments)
    region_of: dict[tuple[int, int], Region] = {
        (region[0], cell): region for region in quota for cell in region[1]
    }
    cell_of = {dart: cell for cell, darts in enumerate(graph.lists) for dart in darts}
    roots: dict[Region, list[cp_model.IntVar]] = {region: [] for region in quota}
    for (edge, color), joined in v.joined.items():
        for dart in (edge, graph.darts[edge].twin):
            region = region_of[color, cell_of[dart]]
            touching = planned.touching(region, cell_of[dart])
            if touching is not None:
                model.add_bool_or([~joined, *touching])
            root = model.new_bool_var("")
            model.add_bool_or([root, ~joined, ~v.root[dart]])
            roots[region].append(root)
    for region, most in quota.items():
        model.add(sum(roots[region]) <= most)
    return built
