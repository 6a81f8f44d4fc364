"""What is minimized: the sum of what segments, uncovered area and change-overs cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

from annotated_types import Ge, Le

from cellcolor.data.prices import MOST_PRICE
from cellcolor.data.value import Value
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

Cost = Annotated[int, Ge(1), Le(MOST_PRICE)]
"""What a segment costs. It is a whole number, so that a bound can meet it exactly, and at least 1,
so that a lower bound of the number of segments is one of their cost as well."""
_BINARY = 1e-6
"""How far 1000 times a price with three decimals may be from a whole number, in floating point."""


@dataclass(frozen=True, slots=True)
class Objective(Value):
    """What is minimised, a sum; by default the number of segments.

    Attributes:
        segments: what a segment costs, by the name of its color; 1 for a color that is not named.
        uncovered_price: what it costs to leave everything uncovered that can be covered, in
            segments, from 0 to 1,000,000; a share of it costs that share. None if everything
            has to be covered.
        change_over: what a change from one set-up to the next costs, in lift-offs, from 1, since it
            takes a lift-off, to 1,000,000, in thousandths. None for the fewest set-ups first,
            whatever that costs.

    Raises:
        InputError: a price is out of its range, or finer.
    """

    segments: dict[str, Cost] = field(default_factory=dict, hash=False)
    uncovered_price: Annotated[float, Ge(0), Le(MOST_PRICE)] | None = None
    change_over: Annotated[float, Ge(1), Le(MOST_PRICE)] | None = None

    def __post_init__(self) -> None:
        settle(self)
        thousandths = 1000 * (self.change_over or 0)
        if abs(thousandths - round(thousandths)) > _BINARY:
            message = f"must have no more than three decimals, is {self.change_over}"
            raise InputError(None, "change_over", message)

    @property
    def is_default(self) -> bool:
        """Whether it is the number of segments."""
        return not self.asked

    @property
    def asked(self) -> tuple[str, ...]:
        """The names of the attributes that are not the default."""
        costs = any(cost != 1 for cost in self.segments.values())
        prices = ("uncovered_price", "change_over")
        others = tuple(name for name in prices if getattr(self, name) is not None)
        return (("segments",) if costs else ()) + others

    def allow(self, *names: str) -> None:
        """Refuse an objective that sets other attributes than these.

        Raises:
            InputError: another attribute is set.
        """
        for name in self.asked:
            if name not in names:
                message = f"cannot be minimized here, only {' or '.join(names)}"
                raise InputError(None, f"objective.{name}", message)

    def by_color(self, colors: Sequence[str]) -> tuple[int, ...]:
        """What a segment of each color costs, in the order of an instance's colors.

        Raises:
            InputError: a color is named that is none of these.
        """
        for name in self.segments:
            if name not in colors:
                known = ", ".join(map(repr, colors))
                message = f"names the color {name!r}, the instance has {known}"
                raise InputError(None, "objective.segments", message)
        return tuple(self.segments.get(name, 1) for name in colors)

    def total(self, segments: float, uncovered: float = 0.0, set_ups: int = 0) -> float:
        """The sum.

        Args:
            segments: what they cost; or, to compare sums only, a number that differs from it by a
                constant, such as the number of lift-offs.
            uncovered: the share that is left uncovered, 0 to 1.
            set_ups: how many there are. A change-over counts as what it costs beyond the lift-off
                that it takes, and one is counted before the first set-up.
        """
        area = 0.0 if self.uncovered_price is None else self.uncovered_price * uncovered
        extra = 0.0 if self.change_over is None else self.change_over - 1
        return segments + area + extra * set_ups

    def __str__(self) -> str:
        said = []
        if "segments" in self.asked:
            costs = ", ".join(f"{name}: {cost}" for name, cost in self.segments.items())
            said.append(f"what segments cost by color, others 1: {costs}")
        if self.uncovered_price is not None:
            said.append(f"what is uncovered costs {self.uncovered_price:g} segments if it is all")
        if self.change_over is not None:
            said.append(f"a change-over costs {self.change_over:g} lift-offs")
        return "; ".join(said) or "each segment costs 1"


FEWEST_SEGMENTS = Objective()
"""The default."""
