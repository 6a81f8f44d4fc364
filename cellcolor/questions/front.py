"""Lift-offs against area: for each number of segments, the most that they cover."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.prices import check_share
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count, lift_offs_of
from cellcolor.errors import InputError

_ROUNDING = 1e-9
"""Of a share: weights are sums of floating-point areas."""


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
    """The fewest lift-offs that cover a share.

    Attributes:
        point: of the front.
        proved: whether no division in the search space ``paper`` covers the share with fewer.
        proved_for_surface: whether no division of the surface does.
    """

    point: FrontPoint
    proved: bool
    proved_for_surface: bool

    def __str__(self) -> str:
        if self.proved_for_surface:
            return f"{self.point.in_short}, proved for any division of the surface"
        proof = "proved in the search space paper" if self.proved else "not proved"
        return f"{self.point.in_short}, {proof}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        return self.point.to_document() | {"proved_for_surface": self.proved_for_surface}


@dataclass(frozen=True, eq=False)
class Front:
    """For each number of lift-offs the largest share that can be covered.

    Attributes:
        instance: the topological graph that was asked about.
        points: by the number of segments, ascending, each with a larger share than the one before;
            the last one covers everything that has a weight if that is known to be possible.
        weight: of everything that can be covered, m²; cells where a graph has no areas.
        at_most: for 1, 2, … segments the share that no division exceeds, and whether that holds
            for any division of the surface; for more segments than these nothing is known.
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

    def fewest_for(self, share: float) -> FrontChoice:
        """The fewest lift-offs that cover a share, and whether it is proved that no fewer do.

        Raises:
            InputError: the share is not from 0 to 1, or no division is known that covers as much.
        """
        check_share("share", share)
        enough = share - _ROUNDING
        point = next((one for one in self.points if one.covered_share >= enough), None)
        if point is None:
            message = f"no division is known that covers {100 * share:g} %"
            raise InputError(None, "share", message)
        fewer = self.at_most[: point.segments - 1]
        known = len(fewer) == point.segments - 1
        proved = known and all(most < enough for most, _ in fewer)
        return FrontChoice(point, proved, proved and all(sure for _, sure in fewer))

    def __str__(self) -> str:
        more = () if self.complete else ("  the time limit came before everything was tried",)
        return "\n".join(
            [f"{self.instance.name}: what lift-offs can cover", *map(str, self), *more]
        )
