"""What verifying a certificate works on: color regions, and the choices that may be tried."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cellcolor.checker.groups import ColorRegion
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline

_NAMED = 20


class Refused(Exception):
    """A certificate does not prove its bound; the text says why."""


class BudgetExceeded(Exception):
    """More choices than were allowed, or the deadline came first."""


class Proof:
    """The steps of one certificate.

    Attributes:
        regions: the color regions that each cell lies in.
        tried: choices so far.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[frozenset[ColorRegion]],
        budget: int,
        deadline: Deadline,
    ) -> None:
        self.instance, self.regions = instance, regions
        self.budget, self.deadline = budget, deadline
        self.tried = 0

    def count(self, choices: int = 1) -> None:
        """Count choices before they are tried; raises ``BudgetExceeded`` if these are too many."""
        self.tried += choices
        if self.tried > self.budget or self.deadline.over:
            raise BudgetExceeded

    def region(self, color: int, cell: int) -> ColorRegion:
        """The region of a color that a cell lies in.

        Raises:
            Refused: there is none.
        """
        for region in self.regions_of(cell):
            if region[0] == color:
                return region
        raise Refused(f"color {color} is not available in cell {cell}")

    def regions_of(self, cell: int) -> frozenset[ColorRegion]:
        """The color regions that a cell lies in.

        Raises:
            Refused: there is no such cell, or no color reaches it.
        """
        if not 0 <= cell < len(self.regions):
            raise Refused(f"there is no cell {cell}")
        if not self.regions[cell]:
            raise Refused(f"no color reaches cell {cell}, so that it need not be touched")
        return self.regions[cell]

    def cells_of(self, region: ColorRegion) -> list[int]:
        """The cells that lie in a color region."""
        return [cell for cell, own in enumerate(self.regions) if region in own]


def few(cells: Iterable[int]) -> str:
    """Cells as a list, which is cut off where nobody would read on."""
    named = sorted(set(cells))
    further = len(named) - _NAMED
    return str(named) if further <= 0 else f"{named[:_NAMED]} and {further} more"
