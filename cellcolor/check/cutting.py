"""How many cutting paths a division has."""

from __future__ import annotations

from cellcolor.data.solution import Division

__all__ = ["cutting_paths"]


def cutting_paths(division: Division) -> int:
    """The sub-cells of each cell beyond the first: one cutting path parts one of them off."""
    return sum(len(cell.subcells) - 1 for cell in division)
