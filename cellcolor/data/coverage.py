"""The part of a surface to which a solution's numbers apply."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Le
from pydantic import NonNegativeFloat

from cellcolor.data.value import Value
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

_ROUNDING = 1e-9
"""Shares are sums of floating-point areas, divided."""

Share = Annotated[float, Ge(0), Le(1)]


@dataclass(frozen=True, slots=True)
class Coverage(Value):
    """How much of a surface the cells cover; nobody paints the rest.

    Attributes:
        area_m2: the whole surface, square metres.
        unreachable: the share of its area that no color reaches, 0 to 1.
        given_up: the share that some color reaches and that was taken away on purpose, by the
            sliver policy or as a place to leave alone, 0 to 1; not part of ``unreachable``.
    """

    area_m2: NonNegativeFloat
    unreachable: Share
    given_up: Share

    def __post_init__(self) -> None:
        settle(self)
        if self.unreachable + self.given_up > 1 + _ROUNDING:
            raise InputError(None, "coverage", "unreachable and given_up are more than the whole")

    @property
    def covered(self) -> float:
        """The share of the cells, 0 to 1."""
        share = 1 - self.unreachable - self.given_up
        return share if share > _ROUNDING else 0.0

    def __str__(self) -> str:
        given_up = f", {100 * self.given_up:.1f} % given up" if self.given_up else ""
        return (
            f"{100 * self.covered:.1f} % of {self.area_m2:.4g} m² can be covered, "
            f"{100 * self.unreachable:.1f} % is unreachable{given_up}"
        )
