"""What ``tradeoff`` and ``explain`` answer: what lift-offs can cover, and what costs one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.value import named_members
from cellcolor.data.wording import check_share, count, lift_offs_of
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
        shares = ("covered_share", "at_most_share", "proved_for_surface", "left_out")
        return named_members(self, "lift_offs", "segments", *shares)


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


@dataclass(frozen=True)
class RelaxedMinimum:
    """The fewest lift-offs of a scene without some of what it asks for.

    Attributes:
        relaxed: what is left out or asked for less, in words; empty for the scene as it is.
        keys: where scene, setup or URDF have it.
        segments: the fewest that were found; None if nothing is reached, or none were found in
            time.
        at_least: no division has fewer segments.
        covered_share: the area with a color, as a share of the area where the arm has any
            configuration at all, whatever refuses it, 0 to 1.
        surface_share: the same area as a share of the whole surface.
        proved_for_surface: whether ``segments`` is the fewest of any division.
        note: what else has to be said of it, or "".
    """

    relaxed: tuple[str, ...]
    keys: tuple[str, ...]
    segments: int | None
    at_least: int
    covered_share: float
    surface_share: float
    proved_for_surface: bool
    note: str = ""

    @property
    def fault(self) -> str:
        """Why there is no number, or ""."""
        return "" if self.segments is not None else self.note or "not solved in time"

    @property
    def lift_offs(self) -> int | None:
        """One between each two segments."""
        return None if self.segments is None else lift_offs_of(self.segments)

    def same_as(self, other: RelaxedMinimum) -> bool:
        """Whether number and area are the same."""
        return (self.segments, self.surface_share) == (other.segments, other.surface_share)

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        found = named_members(self, "relaxed", "keys", "lift_offs", "segments")
        shares = named_members(self, "covered_share", "surface_share", "proved_for_surface", "note")
        return found | {"at_least_segments": self.at_least} | shares

    def __str__(self) -> str:
        what = f"; {' and '.join(self.relaxed)}" if self.relaxed else ""
        if self.lift_offs is None:
            return self.fault + what
        known = count(self.lift_offs, "lift-off")
        proof = "" if self.proved_for_surface else " (not proved)"
        area = f"{100 * self.surface_share:.1f} % of the area"
        return f"{known}{proof}, {area}{what}{f' ({self.note})' if self.note else ''}"


@dataclass(frozen=True, eq=False)
class Explanation:
    """What holds an arm back in a scene.

    Attributes:
        name: of the scene.
        base: the scene as it is.
        alone: each thing relaxed alone, the fewest lift-offs first, then the largest area.
        amounts: of each thing that saves a lift-off, the least amount that was found to do so; and
            a longer tool, whether it saves one or not.
        sets: the smallest sets that save a lift-off where no single thing does (minimal correction
            sets).
        complete: whether the time limit left nothing out.
    """

    name: str
    base: RelaxedMinimum
    alone: tuple[RelaxedMinimum, ...]
    amounts: tuple[RelaxedMinimum, ...] = ()
    sets: tuple[RelaxedMinimum, ...] = ()
    complete: bool = True

    def __iter__(self) -> Iterator[RelaxedMinimum]:
        yield self.base
        yield from self.alone
        yield from self.amounts
        yield from self.sets

    @property
    def only_moving_helps(self) -> bool:
        """Whether something is left to gain, and nothing that was relaxed gains it.

        Neither saves anything a lift-off nor does it cover more, as far as that is known.
        """
        base = self.base
        left = base.lift_offs != 0 or base.surface_share < 1
        rows = (*self.alone, *self.amounts, *self.sets)
        helps = any(
            row.segments is not None
            and (
                base.segments is None
                or row.segments < base.segments
                or row.surface_share > base.surface_share
            )
            for row in rows
        )
        return left and self.complete and not helps

    def __str__(self) -> str:
        lines = [f"{self.name}: {self.base}"]
        if self.base.lift_offs == 0:
            lines.append("  no lift-off is left to save: only area can be gained")
        changing = [row for row in self.alone if not row.same_as(self.base)]
        lines += [f"  without {row.relaxed[0]}: {self._change(row)}" for row in changing]
        lines += [f"  {row.relaxed[0]}: {self._change(row)}" for row in self.amounts]
        lines += [
            f"  without {' and '.join(row.relaxed)}: {self._change(row)}" for row in self.sets
        ]
        same = [row for row in self.alone if row.same_as(self.base)]
        if same:
            lines.append(f"  no change without: {', '.join(_in_short(same))}")
        if self.only_moving_helps:
            lines.append("  nothing of this helps: move the part (cellcolor place)")
        if not self.complete:
            lines.append("  the time limit came before everything was tried")
        return "\n".join(lines)

    def _change(self, row: RelaxedMinimum) -> str:
        if row.lift_offs is None:
            return row.fault
        before, after = self.base.lift_offs, row.lift_offs
        number = f"still {count(after, 'lift-off')}"
        if before != after:
            number = f"{self.base.fault if before is None else before} → {count(after, 'lift-off')}"
        proof = "" if row.proved_for_surface else " (not proved)"
        shares = f"{100 * self.base.surface_share:.1f} → {100 * row.surface_share:.1f} %"
        if row.surface_share == self.base.surface_share:
            shares = f"{100 * row.surface_share:.1f} %"
        return f"{number}{proof}, {shares} of the area{f'; {row.note}' if row.note else ''}"


def _in_short(rows: Sequence[RelaxedMinimum]) -> Iterator[str]:
    """What is relaxed in each of the rows; joints and pairs of links are only counted."""
    joints = [row for row in rows if row.keys[0].startswith("joint[")]
    pairs = [row for row in rows if row.keys[0] == "robot.may_touch"]
    yield from (row.relaxed[0] for row in rows if row not in joints and row not in pairs)
    if joints:
        yield f"limits of {count(len(joints), 'joint')}"
    if len(pairs) > 1:
        yield f"contact of {count(len(pairs), 'pair')} of links"
    yield from (row.relaxed[0] for row in pairs if len(pairs) == 1)
