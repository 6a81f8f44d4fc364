"""Lift-offs against area: for each number of segments, the most that they cover."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count
from cellcolor.errors import InputError

_ROUNDING = 1e-9
"""Of a share: weights are sums of floating-point areas."""


@dataclass(frozen=True, eq=False)
class FrontPoint:
    """The most that so many segments cover.

    Attributes:
        segments: at most so many.
        covered_share: of what can be covered, 0 to 1: what the solution covers.
        at_most_share: no division with so many segments covers more.
        left_out: the cells that the solution does not cover, ascending.
        solution: a division of the other cells, which are numbered anew in their order
            (:meth:`~cellcolor.data.instance.Instance.without_cells`); the checker has passed it.
        holds_for_surface: whether ``at_most_share`` holds for any division of the surface, and not
            only for those in the search space ``paper``.
    """

    segments: int
    covered_share: float
    at_most_share: float
    left_out: tuple[int, ...]
    solution: Solution
    holds_for_surface: bool = True

    @property
    def lift_offs(self) -> int:
        """One between each two segments."""
        return max(0, self.segments - 1)

    @property
    def proved(self) -> bool:
        """Whether the solution covers the most, in the search space ``paper`` at least."""
        return self.covered_share >= self.at_most_share - _ROUNDING

    @property
    def proved_for_surface(self) -> bool:
        """Whether it covers the most of any division of the surface."""
        return self.proved and self.holds_for_surface

    @property
    def in_short(self) -> str:
        """Number and share, as text."""
        return f"{count(self.lift_offs, 'lift-off')}: {100 * self.covered_share:.1f} %"

    @property
    def proof(self) -> str:
        """What is proved of it, as text."""
        if self.proved_for_surface:
            return "proved for any division of the surface"
        if self.proved:
            return "proved in the search space paper"
        return f"at most {100 * self.at_most_share:.1f} %"

    def __str__(self) -> str:
        return f"{self.in_short}, {self.proof}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "lift_offs": self.lift_offs,
            "segments": self.segments,
            "covered_share": self.covered_share,
            "at_most_share": self.at_most_share,
            "proved_for_surface": self.proved_for_surface,
            "left_out": list(self.left_out),
        }


@dataclass(frozen=True, eq=False)
class Front:
    """For each number of lift-offs the largest share that can be covered.

    Attributes:
        instance: the topological graph that was asked about.
        points: by the number of segments, ascending, each with a larger share than the one before;
            the last one covers everything if that is known to be possible.
        weight: of everything that can be covered, in m² unless weights were given.
    """

    instance: Instance
    points: tuple[FrontPoint, ...]
    weight: float

    def __iter__(self) -> Iterator[FrontPoint]:
        return iter(self.points)

    @property
    def proved_for_surface(self) -> bool:
        """Whether every point is proved for any division of the surface."""
        return all(point.proved_for_surface for point in self.points)

    def at_least(self, share: float) -> FrontPoint:
        """The point with the fewest lift-offs that covers a share.

        Raises:
            InputError: the share is not from 0 to 1, or no division is known that covers as much.
        """
        if not 0 <= share <= 1:
            raise InputError(None, "share", f"must be from 0 to 1, is {share:g}")
        for point in self.points:
            if point.covered_share >= share - _ROUNDING:
                return point
        raise InputError(None, "share", f"no division is known that covers {100 * share:g} %")

    def cheapest(self, lift_off_price: float, uncovered_price: float) -> FrontPoint:
        """The point with the least weighted sum of lift-offs and what is left uncovered.

        Args:
            lift_off_price: of one lift-off.
            uncovered_price: of all that can be covered, if all of it were left out. Where it is
                priced by the square metre, that price times ``weight``.

        Raises:
            InputError: a price is negative or no number, or nothing is known.
        """
        for name, price in (
            ("lift_off_price", lift_off_price),
            ("uncovered_price", uncovered_price),
        ):
            if not 0 <= price < float("inf"):
                raise InputError(None, name, f"must be a number from 0 on, is {price:g}")
        if not self.points:
            raise InputError(None, None, "no division is known")
        return min(
            self.points,
            key=lambda point: (
                point.lift_offs * lift_off_price + (1 - point.covered_share) * uncovered_price
            ),
        )

    def __str__(self) -> str:
        return "\n".join([f"{self.instance.name}: what so many lift-offs cover", *map(str, self)])
