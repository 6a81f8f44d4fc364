"""Several set-ups of one part, as a value: which are used, what each covers, what one needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
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
        return {
            "number": self.number,
            "scene": self.scene,
            **pose_document(self.pose),
            "fixed_joints": dict(self.fixed_joints),
            "segments": self.segments,
            "covered_share": self.covered_share,
        }

    def __str__(self) -> str:
        place = pose_in_words(self.pose)
        if self.fixed_joints:
            place += f" with {positions_in_words(self.fixed_joints)}"
        segments = count(self.segments, "segment")
        return f"{self.scene} at {place}: {segments}, {100 * self.covered_share:.1f} %"


@dataclass(frozen=True, eq=False)
class SetUpPlan:
    """The set-ups to use, and how the surface is divided among them.

    Attributes:
        name: of the scene.
        set_ups: those that are used, in the order of their numbers.
        surface: in the part's own frame, the colors of the set-ups side by side, each with the
            number of its set-up before its name; what is left out on purpose has none.
        solution: of that surface, which the checker has passed.
        covered_share: of the area that any set-up reaches, 0 to 1.
        fewest_set_ups: no fewer of the given set-ups cover enough.
        at_least_segments: with as many of them, no division has fewer segments.
        proved: whether no other choice among the given set-ups is better, for any division of the
            surface.
        alone: the set-up that covers most by itself, with the segments that it needs then.
        candidates: how many set-ups could be used.
        refused: why others could not be, a sentence each.
        left: how many candidates the time limit left unbuilt.
    """

    name: str
    set_ups: tuple[SetUp, ...]
    surface: LabelledSurface
    solution: Solution
    covered_share: float
    fewest_set_ups: int
    at_least_segments: int
    proved: bool
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
        return {
            "lift_offs": self.lift_offs,
            "segments": self.segments,
            "change_overs": self.change_overs,
            "covered_share": self.covered_share,
            "proved_for_surface": self.proved,
            "fewest_set_ups": self.fewest_set_ups,
            "at_least_segments": self.at_least_segments,
            "setups": [one.to_document() for one in self.set_ups],
            "alone": self.alone.to_document(),
            "candidates": self.candidates,
            "refused": list(self.refused),
            "left": self.left,
        }

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
