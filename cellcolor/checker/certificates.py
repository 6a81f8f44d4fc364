"""Lower bounds verified without a solver, from what their certificates say.

The certificate of a ``cover`` or of ``strangers`` names some cells, and the claim is that fewer
color regions than the bound says do not touch all of them. Whoever doubts it takes a cell that is
not touched yet and tries each of the few regions that it lies in; that is what is done here, to the
end or until the budget is used up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.data.bound import Bound

__all__ = ["BUDGET", "BoundVerdict", "verify_bound"]

BUDGET = 200_000
"""Choices of a region that are tried before a certificate is given up; some seconds."""

Outcome = Literal["verified", "refused", "budget exceeded", "no certificate"]


@dataclass(frozen=True, slots=True)
class BoundVerdict:
    """What came of verifying a bound.

    Attributes:
        bound: the bound.
        outcome: ``verified``: it is true. ``refused``: its certificate does not prove it.
            ``budget exceeded``: not known. ``no certificate``: it is taken on trust, or of a kind
            that nothing here can verify.
        reason: why it was refused, a sentence; empty otherwise.
        tried: how many choices of a region were tried.
    """

    bound: Bound
    outcome: Outcome
    reason: str = ""
    tried: int = 0

    def __str__(self) -> str:
        tried = f", {self.tried} tried" if self.tried else ""
        reason = f": {self.reason}" if self.reason else ""
        return f"{self.bound}: {self.outcome}{tried}{reason}"


def verify_bound(
    bound: Bound, regions: Sequence[frozenset[ColorRegion]], budget: int = BUDGET
) -> BoundVerdict:
    """Verify a lower bound of the number of segments by its certificate.

    Args:
        bound: one of a solution.
        regions: the color regions that each cell lies in, see
            :mod:`cellcolor.checker.color_regions`.
        budget: how many choices may be tried.
    """
    if bound.kind not in ("cover", "strangers") or bound.certificate is None:
        return BoundVerdict(bound, "no certificate")
    cells: Any = bound.certificate.get("cells")
    if fault := _fault(cells, regions):
        return BoundVerdict(bound, "refused", fault)
    demands = [regions[cell] for cell in cells]
    search = _Search(budget)
    try:
        enough = search.touches_all(demands, bound.value - 1)
    except _BudgetExceeded:
        return BoundVerdict(bound, "budget exceeded", tried=search.tried)
    if enough:
        text = f"fewer than {bound.value} color regions touch all of the cells {cells}"
        return BoundVerdict(bound, "refused", text, search.tried)
    return BoundVerdict(bound, "verified", tried=search.tried)


def _fault(cells: Any, regions: Sequence[frozenset[ColorRegion]]) -> str:
    """What is wrong with a certificate before anything is counted; empty if nothing is."""
    if not isinstance(cells, list) or not all(type(cell) is int for cell in cells):
        return "cells must be a list of cells"
    for cell in cells:
        if not 0 <= cell < len(regions):
            return f"there is no cell {cell}"
        if not regions[cell]:
            return f"no color reaches cell {cell}, so that it need not be touched"
    return ""


class _BudgetExceeded(Exception):
    """More choices than were allowed."""


class _Search:
    """Every way to touch some places with a number of color regions.

    Attributes:
        tried: choices of a region so far.
    """

    def __init__(self, budget: int) -> None:
        self._budget = budget
        self.tried = 0

    def touches_all(self, demands: Sequence[frozenset[ColorRegion]], regions: int) -> bool:
        """Whether so many regions are enough to meet each demand by one of its own.

        Raises:
            _BudgetExceeded: too many choices have been tried.
        """
        if not demands:
            return True
        apart = _pairwise_disjoint(demands)
        if len(apart) > regions:
            return False
        # Whatever meets all demands meets this one, in one of these ways.
        fewest = min(map(len, demands))
        for region in sorted(next(demand for demand in demands if len(demand) == fewest)):
            self.tried += 1
            if self.tried > self._budget:
                raise _BudgetExceeded
            left = [demand for demand in demands if region not in demand]
            if self.touches_all(left, regions - 1):
                return True
        return False


def _pairwise_disjoint(
    demands: Sequence[frozenset[ColorRegion]],
) -> list[frozenset[ColorRegion]]:
    """Demands that no region meets two of: each needs a region of its own."""
    found: list[frozenset[ColorRegion]] = []
    used: set[ColorRegion] = set()
    for demand in sorted(demands, key=len):
        if used.isdisjoint(demand):
            found.append(demand)
            used |= demand
    return found
