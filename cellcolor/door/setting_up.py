"""``cellcolor.setups``: which set-ups of a part cover it with the fewest lift-offs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from cellcolor.data.wording import check_change_over, check_share
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.asked import SearchAndTell, options_of
from cellcolor.door.painting import paint
from cellcolor.door.planned import PlannedScene
from cellcolor.door.planning import plan
from cellcolor.door.subject import Result, Subject, scene_of
from cellcolor.errors import InputError
from cellcolor.questions.placements import PlacedMinimum, Placements, Pose
from cellcolor.questions.set_ups import SetUpPlan

if TYPE_CHECKING:
    from cellcolor.arrays import Mask
    from cellcolor.door.drawing import Drawing
    from cellcolor.frontend import Scene

_FOR_BUILDING = 0.6  # of the time that is left


@dataclass(frozen=True, eq=False, repr=False)
class ChosenSetUps:
    """The set-ups to use, with what is needed to look at them and to drive them.

    Attributes:
        answer: which they are, and what is proved of them.
        scenes: of each of them, in the order of ``answer.set_ups``.
    """

    answer: SetUpPlan
    scenes: tuple[Scene, ...]

    @property
    def result(self) -> Result:
        """The division of the surface, in the part's own frame, among all set-ups."""
        subject = Subject(None, given_surface=self.answer.surface)
        return Result(self.answer.solution, subject, self.answer.covered_share)

    def plot(self, path: str | PathLike[str] | None = None, **view: Any) -> Drawing:
        """Draw the segments of all set-ups on the part: ``cellcolor.show``."""
        return self.result.plot(path, **view)

    def left_alone(self) -> list[Mask]:
        """For each set-up, which vertices (n,) it does not paint."""
        painted = paint(self.result.subject, self.answer.solution)
        count = len(self.answer.surface.vertices)
        own = np.zeros(count, dtype=int)
        names = self.answer.surface.colors
        for vertex, color in enumerate(painted.plan.vertex_colors[:count]):
            if color is not None:
                own[vertex] = int(names[color].partition(":")[0])
        return [own != one.number for one in self.answer.set_ups]

    def plan(self, *, time_limit: TimeLimit = None, **given: Any) -> list[PlannedScene]:
        """A judged motion for each set-up, which paints its own part of the surface.

        Args:
            time_limit: seconds for all of them, None for as long as it takes.
            **given: what ``cellcolor.plan`` takes besides.

        Raises:
            InputError, OutOfTime: as of ``cellcolor.plan``.
        """
        deadline = Deadline.of(time_limit)
        return [
            plan(scene, left_alone=mask, time_limit=deadline, **given)
            for scene, mask in zip(self.scenes, self.left_alone(), strict=True)
        ]

    def __str__(self) -> str:
        return str(self.answer)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.answer.name!r}: {len(self.scenes)}>"


def setups(
    scene: str | PathLike[str] | Scene,
    *,
    at: Sequence[Sequence[float]] | Placements = (),
    others: Sequence[str | PathLike[str] | Scene] = (),
    stops: Mapping[str, Sequence[float]] | None = None,
    cover: float = 1.0,
    change_over: float | None = None,
    **search: Unpack[SearchAndTell],
) -> ChosenSetUps:
    """Choose set-ups of a part that cover enough with the fewest lift-offs, with proof.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value; as it stands it is the first candidate.
        at: where else the part may stand: x, y, z in m and roll, pitch, yaw in rad of each place
            (extrinsic, as in a scene), or what ``place`` has tried.
        others: other scenes of the same part, such as with another arm.
        stops: of external axes of the scene, such as a rail, where each may stand while the tool
            works, rad, or m of a prismatic one. Each combination is a candidate, in the place of
            the scene as it is; the arm does not drive them, so their moves are not planned.
        cover: the share that has to be covered of the area that any candidate reaches, 0 to 1.
        change_over: what a change from one set-up to the next costs, in lift-offs, 1 to 1,000,000
            with up to three decimals; None for the fewest set-ups first, then the fewest lift-offs.
        **search: :class:`~cellcolor.door.asked.SearchAndTell`.

    Raises:
        InputError: a scene cannot be used, a place or a share is none, another scene has another
            part, or nothing is reached; or the part stands in the ground, an obstacle or a link in
            a place of ``at`` or in another scene. Of several scenes each is asked about each place,
            and such a place of ``at`` is left out; so are those that ``place`` has refused.
        OutOfTime: the time limit came before there was a choice.
    """
    check_share("cover", cover)
    if change_over is not None:
        check_change_over(change_over)
    options, progress = options_of(search), search.get("progress")
    poses = _poses(at)
    scenes = [scene_of(one) for one in (scene, *others)]
    from cellcolor.questions.setting_up import at_stops, candidates_of, plan_of

    if stops is not None:
        scenes[:1] = at_stops(scenes[0], stops)
    building, by_hand = options.deadline.share(_FOR_BUILDING), not isinstance(at, Placements)
    found = candidates_of(
        scenes, poses, building, progress, by_hand=by_hand, stops=stops is not None
    )
    answer = plan_of(found, cover, change_over, options, progress)
    return ChosenSetUps(answer, tuple(found.scenes[one.number - 1] for one in answer.set_ups))


def _poses(at: Sequence[Sequence[float]] | Placements) -> list[Pose]:
    """Places, each once."""
    if isinstance(at, Placements):
        return list(dict.fromkeys(row.pose for row in at if isinstance(row, PlacedMinimum)))
    poses = []
    for number, place in enumerate(at):
        try:
            pose = tuple(float(value) for value in place)
        except (TypeError, ValueError):
            pose = ()
        if len(pose) != 6 or not np.isfinite(pose).all():
            message = "must be six numbers: x, y, z in m and roll, pitch, yaw in rad"
            raise InputError(None, f"at[{number}]", message)
        poses.append(pose)
    return list(dict.fromkeys(poses))
