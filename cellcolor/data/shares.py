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


def shares_of(instance: Instance, solution: Solution) -> Shares:
    """The shares of a solution that was found."""
    areas = [cell.area for cell in instance.cells]
    known = [area for area in areas if area is not None]
    coverage = instance.coverage
    measured = len(known) == len(areas) and sum(known) > 0
    weights = known if measured else [1.0] * len(areas)
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


@dataclass(frozen=True, slots=True)
class SegmentRow:
    """One segment.

    Attributes:
        segment: its number.
        color: the name of its color.
        whole: the cells that it covers fully.
        parts: the cells that it covers partly.
        share: the least and the greatest share that it can have, 0 to 1.
    """

    segment: int
    color: str
    whole: tuple[int, ...]
    parts: tuple[int, ...]
    share: Range

    @property
    def cells(self) -> str:
        """Its cells as text, not more than a dozen of them."""
        divided = set(self.parts)
        numbers = sorted(self.whole + self.parts)
        names = [f"part of {c}" if c in divided else str(c) for c in numbers]
        if len(names) > _CELLS_SHOWN:
            return f"{', '.join(names[:_CELLS_SHOWN])}, … ({len(names)} cells)"
        return ", ".join(names)

    @property
    def percent(self) -> str:
        """Its share as text."""
        return percent(*self.share)


def segment_rows(instance: Instance, solution: Solution, shares: Shares) -> list[SegmentRow]:
    """A row for each segment of a solution that was found, by number."""
    whole: list[list[int]] = [[] for _ in shares.segments]
    parts: list[list[int]] = [[] for _ in shares.segments]
    color = [0] * len(shares.segments)
    for cell in solution.cells or ():
        own = {sub.segment for sub in cell.subcells}
        for segment in own:
            (whole if len(own) == 1 else parts)[segment].append(cell.id)
        for sub in cell.subcells:
            color[sub.segment] = sub.color
    return [
        SegmentRow(
            number,
            instance.colors[color[number]],
            tuple(whole[number]),
            tuple(parts[number]),
            share,
        )
        for number, share in enumerate(shares.segments)
    ]
