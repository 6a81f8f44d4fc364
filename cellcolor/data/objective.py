"""What is minimised: what segments cost together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

from annotated_types import Ge, Le

from cellcolor.data.value import Value
from cellcolor.errors import InputError

Cost = Annotated[int, Ge(1), Le(1_000_000)]
"""What a segment costs. It is a whole number, so that a bound can meet it exactly, and at least 1,
so that a lower bound of the number of segments is one of their cost as well."""


@dataclass(frozen=True, slots=True)
class Objective(Value):
    """The sum of what segments cost.

    Attributes:
        segments: what a segment costs, by the name of its color; 1 for a color that is not named.
            With all of them 1, the default, the number of segments is minimised.
    """

    segments: dict[str, Cost] = field(default_factory=dict, hash=False)

    @property
    def is_default(self) -> bool:
        """Whether every segment costs 1."""
        return all(cost == 1 for cost in self.segments.values())

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

    def __str__(self) -> str:
        if self.is_default:
            return "each segment costs 1"
        costs = ", ".join(f"{name}: {cost}" for name, cost in self.segments.items())
        return f"what segments cost by color, others 1: {costs}"


FEWEST_SEGMENTS = Objective()
"""The default."""
