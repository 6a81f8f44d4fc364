"""Proof that a cover cannot be painted: no division has one segment for each of its regions.

Where that holds for every smallest cover, one more segment is needed than the set cover says. With
a cover's colors only, most cells have become like their neighbors; merged, a small graph is left
that is crossed as often as the paper allows or more often, so that what cannot be painted there
cannot be painted at all (docs/solver.md, "Covers that cannot be painted").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds import Region, color_regions
from cellcolor.solvers.cpsat.graph import dart_graph, seams_of
from cellcolor.solvers.cpsat.model import build
from cellcolor.solvers.crossings import enough_crossings
from cellcolor.solvers.merging import simplified

__all__ = ["cover_colors", "is_refuted"]

Solve = Callable[[cp_model.CpSolver, cp_model.CpModel], cp_model.CpSolverStatus]


def cover_colors(instance: Instance, cover: Sequence[Region]) -> tuple[frozenset[int], ...]:
    """The colors that a cover leaves to each cell."""
    return tuple(
        frozenset(color for color, cells in cover if cell.id in cells) for cell in instance.cells
    )


def is_refuted(
    instance: Instance, cover: Sequence[Region], solver: cp_model.CpSolver, solve: Solve
) -> bool:
    """Whether it is proved that no division of ``paper`` has one segment for each region.

    Args:
        instance: the topological graph.
        cover: a smallest cover.
        solver: with its limits, workers and seed set.
        solve: runs it.
    """
    smaller, parallel = simplified(instance, cover_colors(instance, cover))
    colors = tuple(frozenset(cell.colors) for cell in smaller.cells)
    enough = enough_crossings(smaller, colors, parallel)
    strands = {edge: int(count) for edge, count in enough.items()}
    graph = dart_graph(smaller, colors, strands, seams_of(smaller, colors, strands, None))
    built = build(graph, color_regions(smaller))
    built.model.add(sum(built.variables.root) + sum(built.variables.alone) <= len(cover))
    return solve(solver, built.model) == cp_model.INFEASIBLE
