"""Where a part should stand, as a value: the placements that were tried, and the best of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import floor, isfinite
from typing import Any

from cellcolor.data.value import named_members
from cellcolor.data.wording import check_share, count, lift_offs_of
from cellcolor.errors import InputError

VARIABLES = ("x", "y", "z", "roll", "pitch", "yaw")
"""Of a placement: the position in m, and extrinsic x, y, z angles in rad, as in a scene."""

Pose = tuple[float, float, float, float, float, float]
"""Position in m and angles in rad, in the order of :data:`VARIABLES`."""

Ranges = Mapping[str, tuple[float, float]]
"""From where to where each variable goes; those that are missing stay."""

SAME_SHARE = 1e-9
"""Shares of an area that differ by no more are the same."""
_FEW = 3  # reasons of refusals that are told


def pose_in_words(pose: Pose, turned: str = " turned by", digits: str = ".4g") -> str:
    """Where a part stands, its angles only where it is turned."""
    where, angles = (", ".join(format(v, digits) for v in own) for own in (pose[:3], pose[3:]))
    return f"({where}) m" + (f"{turned} ({angles}) rad" if any(pose[3:]) else "")


def pose_document(pose: Pose) -> dict[str, Any]:
    """The members of a JSON object that say where a part stands."""
    return {"position_m": list(pose[:3]), "rpy_rad": list(pose[3:])}


@dataclass(frozen=True, kw_only=True)
class PlacementQuestion:
    """What is asked about placements.

    Attributes:
        ranges: from where to where the variables may go; what is not in it stays.
        cover: the share of the whole surface that has to be covered, 0 to 1; None for as much as
            where the part stands.
        points: placements that are tried all over the ranges; about three quarters as many, 15 at
            least, are tried around the best of them.
        best: how many are proved on the scene's own mesh and listed.
        vertices: about how many the coarse mesh has on which placements are tried.
        base: move the arm's base instead of the part, upright; its ranges are those of the base in
            the scene's world, where it stands in the origin.
        seed: for all random choices.

    Raises:
        InputError: a range, a share or a number is none.
    """

    ranges: Ranges
    cover: float | None = None
    points: int = 128
    best: int = 3
    vertices: int = 300
    base: bool = False
    seed: int = 0

    @classmethod
    def of(cls, **given: Any) -> PlacementQuestion:
        """A question whose ranges are given one by one; a range that is None is missing."""
        named = {name: given.pop(name, None) for name in VARIABLES}
        return cls(ranges={name: own for name, own in named.items() if own is not None}, **given)

    def __post_init__(self) -> None:
        for name in ("points", "best", "vertices"):
            if getattr(self, name) < 1:
                raise InputError(None, name, f"must be 1 or more, is {getattr(self, name)}")
        check_share("cover", self.cover)
        for name, own in self.ranges.items():
            self._check_range(name, own)
        if not self.ranges:
            message = f"nothing may move: give a range of {', '.join(VARIABLES)}"
            raise InputError(None, None, message)

    def _check_range(self, name: str, given: tuple[float, float]) -> None:
        try:
            low, high = map(float, given)
        except (TypeError, ValueError) as error:
            raise InputError(None, name, "its range must be two numbers") from error
        if not (isfinite(low) and isfinite(high)):
            raise InputError(None, name, "its range must be two numbers")
        if low >= high:
            raise InputError(None, name, f"the range from {low:g} to {high:g} is empty")
        if self.base and name in ("roll", "pitch"):
            raise InputError(None, name, "the arm's base stays upright")


@dataclass(frozen=True)
class PlacedMinimum:
    """The fewest lift-offs where a part stands.

    Attributes:
        pose: where it stands, or the arm's base if that is moved.
        segments: the fewest that were found; None if the part cannot stand there, or none were
            found in time.
        covered_share: the area with a color, as a share of the whole surface, 0 to 1; the most that
            this can be of a placement that was not built whole.
        proved_for_surface: whether ``segments`` is the fewest of any division of the mesh that was
            solved.
        vertices: of that mesh.
        refused: why the part cannot stand there, or "".
        at_least: of a placement that was not built whole, no division that covers enough has fewer
            segments; 0 of others.
    """

    pose: Pose
    segments: int | None
    covered_share: float
    proved_for_surface: bool
    vertices: int
    refused: str = ""
    at_least: int = 0

    @property
    def lift_offs(self) -> int | None:
        """One between each two segments."""
        return None if self.segments is None else lift_offs_of(self.segments)

    @property
    def least_lift_offs(self) -> int | None:
        """Of a placement that was not built whole, at least."""
        return lift_offs_of(self.at_least) if self.at_least else self.lift_offs

    def rank(self, cover: float) -> tuple[bool, int, bool, float]:
        """What a better placement has less of.

        Enough area comes first, then the number of segments, then the proof, then the area left
        uncovered. A placement that was not built whole has no more of it than it will have then.
        """
        segments = self.segments or self.at_least
        enough = segments > 0 and self.covered_share >= cover - SAME_SHARE
        unproved = not (self.proved_for_surface or self.at_least)
        return not enough, segments if enough else 0, unproved, 1.0 - self.covered_share

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        least = {"at_least_segments": self.at_least or self.segments}
        found = pose_document(self.pose) | named_members(self, "lift_offs", "segments") | least
        more = named_members(self, "covered_share", "proved_for_surface", "vertices", "refused")
        return found | more

    def __str__(self) -> str:
        place, area = pose_in_words(self.pose), f"{100 * self.covered_share:.1f} % of the area"
        if self.at_least:
            least = self.least_lift_offs or 0
            number = f"at least {count(least, 'lift-off')}, " if least else ""
            return f"{place}: {number}at most {area}"
        if self.lift_offs is None:
            why = f"the part cannot stand there: {self.refused}"
            return f"{place}: {why if self.refused else 'not solved in time'}"
        proof = "" if self.proved_for_surface else " (not proved)"
        number = count(self.lift_offs, "lift-off")
        return f"{place}: {number}{proof}, {area}"


@dataclass(frozen=True, eq=False)
class Placements:
    """Where a part may stand, with the fewest lift-offs of each place.

    Attributes:
        name: of the scene.
        cover: the share of the surface that has to be covered.
        here: where the scene has the part, on the scene's own mesh.
        best: the best placements that were found, on the scene's own mesh, the best first.
        tried: all others, most of them on a coarser mesh, in the order in which they were asked; of
            those that could not be among the best there are bounds only.
        complete: whether the time limit left nothing out.
        base: whether the arm's base is moved instead of the part.
    """

    name: str
    cover: float
    here: PlacedMinimum
    best: tuple[PlacedMinimum, ...]
    tried: tuple[PlacedMinimum, ...]
    complete: bool = True
    base: bool = False

    def __iter__(self) -> Iterator[PlacedMinimum]:
        yield self.here
        yield from self.best
        yield from self.tried

    def __str__(self) -> str:
        stands = "where the arm's base stands" if self.base else "where it stands"
        lines = [f"{self.name}: {stands}, {self.here}"]
        enough = [row for row in self.best if not row.rank(self.cover)[0]]
        lines += [f"  {number}. {row}" for number, row in enumerate(enough, 1)]
        asked = f"{100 * self.cover:.1f} % of the area"
        if not enough:
            lines.append(f"  no placement that was tried covers {asked}{self._most()}")
        tried = count(len(self.tried), "placement")
        bounded = sum(row.at_least > 0 for row in self.tried)
        lines.append(f"  {tried} tried that had to cover {asked}, {bounded} left aside by bounds")
        if refused := Counter(row.refused for row in self.tried if row.refused):
            why = "; ".join(f"{reason} ({number})" for reason, number in refused.most_common(_FEW))
            more = "; …" * (len(refused) > _FEW)
            lines.append(f"  in {refused.total()} of them the part cannot stand: {why}{more}")
        if not self.complete:
            lines.append("  the time limit came before everything was tried")
        return "\n".join(lines)

    def _most(self) -> str:
        """How much of the area can be covered, on the scene's own mesh, and how to ask for it."""
        solved = [row for row in (self.here, *self.best) if row.segments is not None]
        if not solved:
            return ""
        most = max(solved, key=lambda row: row.covered_share)
        share = floor(1000 * most.covered_share) / 1000
        return f"; the most is {most}: ask for it by --cover {share:g}"
