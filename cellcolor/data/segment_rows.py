"""The segments of a solution as rows, the same for every table."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.data.shares import Range, Shares, percent
from cellcolor.data.solution import Solution

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
