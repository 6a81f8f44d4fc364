"""Gates: the vertices at which sub-cells of divided cells cross their edges on a refined mesh."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from cellcolor.checker.dart_lists import WholeSubCell, whole_subcells
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.solution import CellDivision
from cellcolor.decomposition.borders import Curve, Step
from cellcolor.painting.refined import Refined


def subcells_on_surface(cell: CellDivision, seams: set[int]) -> list[WholeSubCell]:
    """The sub-cells of a cell that cross an edge of it; if none does, one of them.

    The cell's loops are merged into one cyclic list by seams, which are given by their ids.
    """
    whole = whole_subcells(cell, seams)
    return [subcell for subcell in whole if subcell.strands] or whole[:1]


def steps_by_edge(
    refined: Refined, old_curves: Mapping[int, Curve], curves: Iterable[Curve]
) -> dict[int, list[Step]]:
    """The steps of each topological edge on the refined mesh, its left cell on their left.

    Args:
        old_curves: the edges on the surface that was refined, by their ids.
        curves: the edges on the refined surface, in any order and direction.
    """
    dart_of: dict[Step, int] = {}
    for edge, curve in old_curves.items():
        for a, b in curve.steps:
            dart_of[a, b] = edge
            dart_of.setdefault((b, a), -edge)
    count, old_count = len(refined.mesh.points), len(refined.old.vertices)
    origin = refined.stands_for.tolist()
    found: dict[int, list[Step]] = {}
    for curve in curves:
        # Vertices beyond the last close the holes of the mesh, in the same order on both.
        a, b = (origin[v] if v < count else v - count + old_count for v in curve.steps[0])
        dart = dart_of[a, b]
        steps = list(curve.steps)
        found[abs(dart)] = steps if dart > 0 else [(b, a) for a, b in reversed(steps)]
    return found


def choose_gates(
    subcells: Sequence[Sequence[WholeSubCell]], divided: set[int], steps: dict[int, list[Step]]
) -> tuple[dict[Strand, int], list[int]]:
    """The gate of each dart in state 1 of a divided cell.

    The strands in use share an edge evenly, and the two darts of a strand get the two ends of one
    mesh edge.

    Args:
        subcells: those of each cell.
        divided: the cells with several.
        steps: of each topological edge, in order.

    Returns:
        The gates, and the edges that cross fewer mesh edges than they have strands in use, which
        get none.
    """
    used: dict[int, set[int]] = {}
    for cell in sorted(divided):
        for subcell in subcells[cell]:
            for dart, strand in subcell.strands:
                used.setdefault(abs(dart), set()).add(strand)
    gates: dict[Strand, int] = {}
    short = []
    for edge, numbers in used.items():
        along = steps[edge]
        if len(numbers) > len(along):
            short.append(edge)
            continue
        places = (2 * np.arange(len(numbers)) + 1) * len(along) // (2 * len(numbers))
        for strand, place in zip(sorted(numbers), places.tolist(), strict=True):
            gates[edge, strand], gates[-edge, strand] = along[place]
    return gates, short
