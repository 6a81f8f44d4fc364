"""Lower bounds that hold for any division of the physical surface: set cover, strangers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import networkx as nx

from cellcolor.data.instance import Instance

if TYPE_CHECKING:
    from ortools.sat.python import cp_model

__all__ = ["Region", "color_regions", "set_cover", "strangers"]

Region = tuple[int, frozenset[int]]
"""A color, and the cells of one connected component of the part of the surface it reaches."""


def color_regions(
    instance: Instance, colors: Sequence[frozenset[int]] | None = None
) -> list[Region]:
    """Every color's region, split into components over the edges that are joinable for it.

    No segment reaches beyond one of these (docs/semantics.md, section 4).

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, if not all of its own.
    """
    allowed = colors or [frozenset(cell.colors) for cell in instance.cells]
    regions: list[Region] = []
    for color in range(len(instance.colors)):
        graph: nx.Graph[int] = nx.Graph()
        graph.add_nodes_from(number for number, own in enumerate(allowed) if color in own)
        for edge in instance.edges:
            if color in instance.joinable(edge.id) and {edge.left, edge.right} <= graph.nodes:
                graph.add_edge(edge.left, edge.right)
        regions += [(color, frozenset(found)) for found in nx.connected_components(graph)]
    return regions


def set_cover(instance: Instance, colors: Sequence[frozenset[int]] | None = None) -> list[Region]:
    """A smallest set of color regions that touches every cell; its size is a lower bound.

    Every cell of a division holds some sub-cell, that belongs to some segment, that lies within
    one color region; so the regions of all segments together touch every cell, and there are at
    least as many segments as regions in a smallest cover. This holds in both search spaces.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, if not all of its own.
    """
    from ortools.sat.python import cp_model  # slow to import, so only where it is used

    regions = color_regions(instance, colors)
    model = cp_model.CpModel()
    chosen = [model.new_bool_var("") for _ in regions]
    for cell in instance.cells:
        model.add_bool_or(
            literal for literal, (_, cells) in zip(chosen, regions, strict=True) if cell.id in cells
        )
    model.minimize(sum(chosen))
    return [regions[number] for number in _solve(model, chosen)]


def strangers(instance: Instance) -> list[int]:
    """A largest set of cells of which no two lie in one color region.

    No two of them can be in one segment, so there are at least as many segments: a bound that can
    be checked by eye. It is at most that of the set cover, and often equal to it.
    """
    from ortools.sat.python import cp_model

    model = cp_model.CpModel()
    chosen = [model.new_bool_var("") for _ in instance.cells]
    for _, cells in color_regions(instance):
        model.add_at_most_one(chosen[cell] for cell in sorted(cells))
    model.maximize(sum(chosen))
    return _solve(model, chosen)


def _solve(model: cp_model.CpModel, chosen: list[cp_model.IntVar]) -> list[int]:
    """Solve a small model to the end; which of its variables are chosen."""
    from ortools.sat.python import cp_model

    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = 0
    # Left to itself, OR-Tools makes the next Ctrl-C kill the process.
    solver.parameters.catch_sigint_signal = False
    status = solver.solve(model)
    # Something can always be chosen, and nothing limits the search for the best.
    assert status == cp_model.OPTIMAL
    return [number for number, literal in enumerate(chosen) if solver.boolean_value(literal)]
