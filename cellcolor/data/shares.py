"""The share of a surface that each segment of a solution has, the same numbers everywhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution

UNREACHABLE = "unreachable"
GIVEN_UP = "given up"

Range = tuple[float, float]
"""The least and the greatest share, 0 to 1."""


@dataclass(frozen=True, slots=True)
class Shares:
    """How a surface is divided among the segments, and what stays unpainted.

    Attributes:
        of: what the shares are of: the whole ``surface``; the ``cells`` where it is not known how
            much of the surface these are; the ``number`` of cells where their areas are not known
            either.
        segments: of each segment. A cell that is divided between segments gives a range: the cut
            may run anywhere, so each of them has from nothing to all of it.
        unreachable: of what no color reaches; 0 where ``of`` is not the surface.
        given_up: of what a sliver policy took away or is left alone on purpose; 0 where ``of`` is
            not the surface.
    """

    of: Literal["surface", "cells", "number"]
    segments: tuple[Range, ...]
    unreachable: float = 0.0
    given_up: float = 0.0

    @property
    def certain(self) -> bool:
        """No cell is divided between segments."""
        return all(least == most for least, most in self.segments)


def cell_weights(instance: Instance) -> tuple[list[float], bool]:
    """The area of each cell, or 1 for each where one is not known; and whether these are areas."""
    known = [cell.area for cell in instance.cells if cell.area is not None]
    measured = len(known) == len(instance.cells) and sum(known) > 0
    return known if measured else [1.0] * len(instance.cells), measured


def shares_of(instance: Instance, solution: Solution) -> Shares:
    """The shares of a solution that was found."""
    weights, measured = cell_weights(instance)
    coverage = instance.coverage
    least = [0.0] * (solution.segments or 0)
    most = list(least)
    for cell, weight in zip(solution.cells or (), weights, strict=True):
        own = {sub.segment for sub in cell.subcells}
        for segment in own:
            most[segment] += weight
            least[segment] += weight if len(own) == 1 else 0.0

    def parts_of(whole: float) -> tuple[Range, ...]:
        return tuple((low / whole, high / whole) for low, high in zip(least, most, strict=True))

    if measured and coverage is not None and coverage.covered > 0:
        # Cells, unreachable and given up are the whole surface.
        segments = parts_of(sum(weights) / coverage.covered)
        return Shares("surface", segments, coverage.unreachable, coverage.given_up)
    return Shares("cells" if measured else "number", parts_of(sum(weights)))


def percent(least: float, most: float) -> str:
    """A share as text; a range only if its ends differ visibly."""
    low, high = f"{100 * least:.1f}", f"{100 * most:.1f}"
    return f"{low} %" if low == high else f"{low}–{high} %"


_CELLS_SHOWN = 12

BASES = {"surface": "share of surface", "cells": "share of area", "number": "share of cells"}
"""What the shares of a solution are of, by :attr:`Shares.of <cellcolor.data.shares.Shares>`."""


def segment_rows(
    instance: Instance, solution: Solution, shares: Shares
) -> list[tuple[str, str, str, str]]:
    """Number, color, cells (a dozen at most) and share of each segment of a solution, as text."""
    cells: list[list[str]] = [[] for _ in shares.segments]
    color = [0] * len(shares.segments)
    for cell in solution.cells or ():
        own = {sub.segment: sub.color for sub in cell.subcells}
        for segment in own:
            color[segment] = own[segment]
            cells[segment].append(str(cell.id) if len(own) == 1 else f"part of {cell.id}")
    return [
        (str(number), instance.colors[color[number]], _few(cells[number]), percent(*share))
        for number, share in enumerate(shares.segments)
    ]


def _few(cells: list[str]) -> str:
    more = f", … ({len(cells)} cells)" if len(cells) > _CELLS_SHOWN else ""
    return ", ".join(cells[:_CELLS_SHOWN]) + more
