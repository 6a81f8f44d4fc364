"""Several set-ups of one part, as a value: which are used, what each covers, what one needs."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from cellcolor.data.solution import Solution
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.data.value import named_members
from cellcolor.data.wording import count, lift_offs_of
from cellcolor.questions.placements import Pose, pose_document, pose_in_words


def positions_in_words(joints: Mapping[str, float]) -> str:
    """Where joints stand still, rad or m."""
    return ", ".join(f"{name} = {position:.4g}" for name, position in joints.items())


@dataclass(frozen=True)
class SetUp:
    """A part in one place before one arm.

    Attributes:
        number: among those that could be used, from 1.
        scene: the name of the scene that has the arm.
        pose: where the part stands in it.
        segments: that are painted here.
        covered_share: of the area that any set-up reaches, what is painted here, 0 to 1.
        fixed_joints: where the joints stand that do not move here, rad, or m of prismatic ones.
    """

    number: int
    scene: str
    pose: Pose
    segments: int
    covered_share: float
    fixed_joints: Mapping[str, float] = field(default_factory=dict)

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        found = named_members(self, "number", "scene") | pose_document(self.pose)
        return found | named_members(self, "fixed_joints", "segments", "covered_share")

    def __str__(self) -> str:
        place = pose_in_words(self.pose)
        if self.fixed_joints:
            place += f" with {positions_in_words(self.fixed_joints)}"
        segments = count(self.segments, "segment")
        return f"{self.scene} at {place}: {segments}, {100 * self.covered_share:.1f} %"


@dataclass(frozen=True, eq=False)
class Choice:
    """Set-ups that cover enough, and how the surface is divided among them.

    Attributes:
        numbers: of the set-ups among the given ones, from 0, ascending.
        surface: in the part's own frame, the colors of the set-ups side by side, each with the
            number of its set-up before its name; what is left out on purpose has none.
        solution: of that surface, which the checker has passed.
        covered_share: of the area that any set-up reaches, 0 to 1.
        fewest_set_ups: no fewer of the given set-ups cover enough.
        at_least_segments: with as many of them, no division has fewer segments.
        proved: whether no other choice among the given set-ups is better, for any division of the
            surface.
    """

    numbers: tuple[int, ...]
    surface: LabelledSurface
    solution: Solution
    covered_share: float
    fewest_set_ups: int = 1
    at_least_segments: int = 1
    proved: bool = False


@dataclass(frozen=True, eq=False, kw_only=True)
class SetUpPlan(Choice):
    """The set-ups to use, and how the surface is divided among them.

    Attributes:
        name: of the scene.
        set_ups: those that are used, in the order of their numbers.
        alone: the set-up that covers most by itself, with the segments that it needs then.
        candidates: how many set-ups could be used.
        refused: why others could not be, a sentence each.
        left: how many candidates the time limit left unbuilt.
    """

    name: str
    set_ups: tuple[SetUp, ...]
    alone: SetUp
    candidates: int
    refused: tuple[str, ...] = ()
    left: int = 0

    @property
    def complete(self) -> bool:
        """Whether the time limit left no candidate out."""
        return not self.left

    @property
    def segments(self) -> int:
        """In all set-ups together."""
        return self.solution.segments or 0

    @property
    def lift_offs(self) -> int:
        """Between segments of one set-up; a change-over is not one."""
        return self.segments - len(self.set_ups)

    @property
    def change_overs(self) -> int:
        """One between each two set-ups."""
        return len(self.set_ups) - 1

    @property
    def proved_for_surface(self) -> bool:
        """The same as ``proved``."""
        return self.proved

    def __iter__(self) -> Iterator[SetUp]:
        return iter(self.set_ups)

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        shares = ("covered_share", "proved_for_surface", "fewest_set_ups", "at_least_segments")
        found = named_members(self, "lift_offs", "segments", "change_overs", *shares)
        found["setups"] = [one.to_document() for one in self.set_ups]
        found["alone"] = self.alone.to_document()
        return found | named_members(self, "candidates", "refused", "left")

    def __str__(self) -> str:
        proof = "proved" if self.proved else f"at least {count(self.at_least_segments, 'segment')}"
        used = count(len(self.set_ups), "set-up")
        lines = [
            f"{self.name}: {used}, {count(self.lift_offs, 'lift-off')} within them, "
            f"{100 * self.covered_share:.1f} % of what {count(self.candidates, 'candidate')} "
            f"{'reaches' if self.candidates == 1 else 'reach'}, {proof}"
        ]
        lines += [f"  {one.number}. {one}" for one in self.set_ups]
        alone = self.alone
        if len(self.set_ups) > 1 or alone.covered_share < self.covered_share:
            lift_offs = count(lift_offs_of(alone.segments), "lift-off")
            lines.append(f"  one set-up alone: {alone}, {lift_offs}")
        if self.refused:
            lines.append(f"  {count(len(self.refused), 'candidate')} refused: {self.refused[0]}")
        if self.left:
            lines.append(f"  the time limit left {count(self.left, 'candidate')} unbuilt")
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class Region:
    """A color region of a set-up: one color, connected over mesh edges that are not cracks."""

    set_up: int
    color: int
    vertices: frozenset[int]


def side_by_side(
    surfaces: Sequence[LabelledSurface], regions: Collection[Region]
) -> LabelledSurface:
    """One surface with the colors of some regions; before a color's name is its set-up's number.

    Args:
        surfaces: of all set-ups, on one mesh.
        regions: those that may be painted.
    """
    first = surfaces[0]
    names: list[str] = []
    colors: list[list[int]] = [[] for _ in first.vertices]
    cracks: dict[tuple[int, int], list[int]] = {}
    given_up: set[int] = set()
    inside: dict[tuple[int, int], set[int]] = {}
    for region in regions:
        inside.setdefault((region.set_up, region.color), set()).update(region.vertices)
    for number, (set_up, color) in enumerate(sorted(inside)):
        own, vertices = surfaces[set_up], inside[set_up, color]
        names.append(f"{set_up + 1}: {own.colors[color]}")
        for vertex in vertices:
            colors[vertex].append(number)
        for crack in own.cracks:
            if color in crack.colors and {crack.i, crack.j} <= vertices:
                cracks.setdefault((crack.i, crack.j), []).append(number)
        given_up |= set(own.given_up)
    return LabelledSurface(
        first.name,
        tuple(names),
        first.vertices,
        first.faces,
        tuple(map(tuple, colors)),
        tuple(Crack(i, j, tuple(own)) for (i, j), own in cracks.items()),
        given_up=tuple(vertex for vertex in sorted(given_up) if not colors[vertex]),
    )
