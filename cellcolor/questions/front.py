"""Lift-offs against area: for each number of segments, the most that they cover."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, ulp
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.prices import MOST_CM2, check_price
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count, lift_offs_of
from cellcolor.errors import InputError

_ROUNDING = 1e-9
"""Of a share: weights are sums of floating-point areas."""
_CM2 = 1e4  # in a square meter


@dataclass(frozen=True, eq=False)
class FrontPoint:
    """The most that a number of segments covers.

    Attributes:
        segments: the number, at most.
        covered_share: of what can be covered, 0 to 1: what the solution covers.
        at_most_share: no division with that many segments covers more.
        left_out: the cells that the solution does not cover, ascending.
        solution: a division of the other cells, which are renumbered in their order
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
        return lift_offs_of(self.segments)

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
class FrontChoice:
    """The point of a front that answers a question best.

    Attributes:
        point: the point.
        proved: whether no division in the search space ``paper`` answers it better.
        proved_for_surface: whether no division of the surface does.
        cost_cm2: of lift-offs and of the area left out, where that was asked.
    """

    point: FrontPoint
    proved: bool
    proved_for_surface: bool
    cost_cm2: float | None = None

    def __str__(self) -> str:
        text = self.point.in_short
        if self.cost_cm2 is not None:
            text += f", costs {self.cost_cm2:.4g} cm²"
        if self.proved_for_surface:
            return f"{text}, proved for any division of the surface"
        return f"{text}, {'proved in the search space paper' if self.proved else 'not proved'}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        cost = {} if self.cost_cm2 is None else {"cost_cm2": self.cost_cm2}
        proof = {"proved_for_surface": self.proved_for_surface}
        return self.point.to_document() | proof | cost


@dataclass(frozen=True, eq=False)
class Front:
    """For each number of lift-offs the largest share that can be covered.

    Attributes:
        instance: the topological graph that was asked about.
        points: by the number of segments, ascending, each with a larger share than the one before;
            the last one covers everything that has a weight if that is known to be possible.
        weight: of everything that can be covered, in m² unless weights were given.
        at_most: for 1, 2, … segments the share that no division exceeds (-1 where none covers what
            is required), and whether that holds for any division of the surface; for more segments
            than these nothing is known.
    """

    instance: Instance
    points: tuple[FrontPoint, ...]
    weight: float
    at_most: tuple[tuple[float, bool], ...] = ()

    def __iter__(self) -> Iterator[FrontPoint]:
        return iter(self.points)

    @property
    def proved_for_surface(self) -> bool:
        """Whether every point is proved for any division of the surface."""
        return all(point.proved_for_surface for point in self.points)

    @property
    def complete(self) -> bool:
        """Whether the time limit left no number of segments out."""
        return not self.points or len(self.at_most) >= self.points[-1].segments - 1

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

    def cheapest(self, uncovered_price: float) -> FrontChoice:
        """The least sum of lift-offs and of what is left uncovered, and whether none is less.

        Args:
            uncovered_price: what it costs to leave out all that can be covered, in lift-offs; a
                share of it costs that share.

        Raises:
            InputError: the price is out of its range, or nothing is known.
        """
        check_price("uncovered_price", uncovered_price)
        return self._cheapest(
            lambda lift_offs, share: lift_offs + uncovered_price * (1 - share), uncovered_price
        )

    def fewest_for(self, share: float) -> FrontChoice:
        """The fewest lift-offs that cover a share, and whether it is proved that no fewer do.

        Raises:
            InputError: as of :meth:`at_least`.
        """
        return self._choice(
            self.at_least(share),
            lambda lift_offs, covered: lift_offs if covered >= share - _ROUNDING else inf,
            0.0,
        )

    def least_cost(self, lift_off_cm2: float) -> FrontChoice:
        """The least sum of lift-offs and area, and whether it is proved that none is less.

        Args:
            lift_off_cm2: a lift-off costs as much as so many square centimeters left out, from 0
                to ``MOST_CM2``.

        Raises:
            InputError: the price is out of its range, or the graph has no areas.
        """
        check_price("price", lift_off_cm2, most=MOST_CM2)
        if any(cell.area is None for cell in self.instance.cells):
            raise InputError(None, "price", "is one of area, and the cells of this graph have none")
        whole = _CM2 * self.weight

        def cost(lift_offs: int, covered: float) -> float:
            return lift_off_cm2 * lift_offs + whole * (1 - covered)

        found = self._cheapest(cost, whole)
        return replace(found, cost_cm2=cost(found.point.lift_offs, found.point.covered_share))

    def _cheapest(self, cost: Callable[[int, float], float], worth: float) -> FrontChoice:
        """The point that costs least, of its lift-offs and the share that it covers.

        Args:
            worth: what it costs to leave out everything.
        """
        if not self.points:
            raise InputError(None, None, "no division is known")
        point = min(self.points, key=lambda one: cost(one.lift_offs, one.covered_share))
        return self._choice(point, cost, worth)

    def _choice(
        self, point: FrontPoint, cost: Callable[[int, float], float], worth: float
    ) -> FrontChoice:
        """A point, and whether no division costs less: of so many lift-offs that cover a share."""
        own = cost(point.lift_offs, point.covered_share)

        def proved(*, on_surface: bool) -> bool:
            known = [share if sure or not on_surface else 1.0 for share, sure in self.at_most]
            least = min(
                cost(lift_offs, share)
                for lift_offs, share in enumerate([*known, 1.0])
                if share >= 0  # otherwise so few do not cover what is required
            )
            return own <= least + _ROUNDING * worth + 4 * ulp(own)

        return FrontChoice(point, proved(on_surface=False), proved(on_surface=True))

    def __str__(self) -> str:
        more = () if self.complete else ("  the time limit came before everything was tried",)
        return "\n".join(
            [f"{self.instance.name}: what lift-offs can cover", *map(str, self), *more]
        )
