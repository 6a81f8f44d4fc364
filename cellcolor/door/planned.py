"""What ``cellcolor.plan`` gives, as far as there was time for it, and the files of its folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.data.instance import Instance, SurfaceReference
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.wording import count
from cellcolor.deadline import OutOfTime
from cellcolor.door.subject import Result, Subject
from cellcolor.errors import InputError, system_errors
from cellcolor.exports.interface import PlannedMotion
from cellcolor.exports.registry import EXPORTS, exported, programs_of, why_no_program
from cellcolor.files.writing import (
    HTML,
    SIDE_FILE,
    FileKind,
    Output,
    Writable,
    check_output,
    is_folder_or_nothing,
    kind_of_format,
    path_of,
    write,
)
from cellcolor.painting.paint import Painted

if TYPE_CHECKING:
    from cellcolor.arrays import Array
    from cellcolor.frontend import BuildReport, BuildResult
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.pictures.report_page.content import AnsweredScene


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class UnfinishedPlan:
    """A scene on its way to a motion, as far as it got within the time limit.

    Attributes:
        subject: the scene, built and decomposed.
        result: the fewest segments that were found, and what is proved; None before the search.
        painted: the segments on the surface, if they were painted.
        paths: where the tool goes, if that was laid out.
        trajectory: how the arm moves; none leaves the program without having been judged.
        verdict: an independent judge's on it.
        seconds: wall time of each stage.
        answered: what was asked besides, for the page; None if nothing was.
        unanswered: the questions that have no answer, or a part of one, each with the reason.
    """

    subject: Subject
    result: Result | None = None
    painted: Painted | None = None
    paths: ToolPaths | None = None
    trajectory: Trajectory | None = None
    verdict: TrajectoryVerdict | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)
    answered: AnsweredScene | None = None
    unanswered: tuple[str, ...] = ()

    @property
    def built(self) -> BuildResult:
        """Which colors reach each point."""
        return self.subject.build()

    @property
    def instance(self) -> Instance:
        """The topological graph."""
        return self.subject.graph()

    @property
    def solution(self) -> Solution | None:
        """The solver's answer, which the checker has passed."""
        return None if self.result is None else self.result.solution

    @property
    def missing(self) -> str:
        """What the time limit cut off, as a sentence; "" for a whole plan."""
        if self.verdict is not None:
            return ""
        if self.result is None or self.result.solution.cells is None:
            cut = "before any division into segments was found"
        elif self.painted is None:
            cut = "before the segments were painted on the surface"
        elif self.paths is None:
            cut = "before the tool paths were laid out"
        else:
            cut = "before the arm's motion on the tool paths was planned and judged"
        return f"The time limit came {cut}."

    @property
    def lacking(self) -> tuple[str, ...]:
        """What was asked for, or is usual, and is not there, a line each with the reason."""
        motion = self._motion()
        why = None if motion is None else why_no_program(motion)
        no_program = () if why is None else (f"program for a controller: not written: {why}",)
        return (*self.unanswered, *no_program)

    def page(self) -> bytes:
        """``report.html``, complete in itself: what there is, and what is missing."""
        from cellcolor.pictures.report_page.content import MotionReport
        from cellcolor.pictures.report_page.page import render_report

        motion = self._motion()
        return render_report(
            MotionReport(
                built=self.built,
                decomposition=self.subject.decomposition,
                solution=self.solution,
                painted=self.painted,
                trajectory=self.trajectory,
                verdict=self.verdict,
                paths=self.paths if motion is None else None,
                missing=self.missing,
                answered=self.answered,
                programs=() if motion is None else programs_of(motion),
                lacking=self.lacking,
            )
        )

    def files(self, export_step_s: float | None = None) -> dict[str, bytes]:
        """All files but the page, by name, as far as the plan came."""
        surface, decomposition = self.subject.surface, self.subject.decomposition
        reference = SurfaceReference(SURFACE, tuple(decomposition.vertex_cell), surface.sha256)
        painted, motion = self.painted, self._motion(export_step_s)
        values: dict[str, Writable | None] = {
            SURFACE: replace(surface, meta=surface.meta | {"side_file": SIDE}),
            "instance.json": replace(decomposition.instance, surface=reference),
            "solution.json": self.solution,
            "painted.plan.json": None if painted is None else painted.plan,
            "painted.surface.json": None if painted is None else painted.surface,
            "paths.json": self.paths,
            "trajectory.json": self.trajectory,
            "verdict.json": self.verdict,
        }
        return {
            SIDE: self.built.candidates.to_bytes(),
            **{name: own.to_json().encode() for name, own in values.items() if own is not None},
            **({} if motion is None else exported(motion)),
        }

    def save(
        self, folder: str | PathLike[str], export_step_s: float | None = None
    ) -> tuple[str, ...]:
        """Write all files that are ready to a folder (docs/plan.md), all of them or none.

        Args:
            folder: where; it is made if it is not there.
            export_step_s: the fixed time step of the files for controllers, s; None keeps the
                samples of the trajectory (docs/formats/other-programs.md).

        Returns:
            Their names.

        Raises:
            InputError: files of another plan are there that these would not replace, or something
                else that is not overwritten; or it cannot be written.
        """
        place = path_of(folder)
        files = self.files(export_step_s) | {"report.html": self.page()}
        for name in KINDS.keys() - files.keys():
            if (place / name).exists():
                other_arm = name in EXPORTS and self.verdict is not None
                whose = "for another arm" if other_arm else "that got further"
                message = f"belongs to a plan {whose}; files of two plans are not mixed"
                raise InputError(place / name, None, message)
        with system_errors(place, "cannot be made"):
            place.mkdir(parents=True, exist_ok=True)
        write([Output(place / name, KINDS[name], [files[name]]) for name in files])
        return tuple(files)

    def _motion(self, export_step_s: float | None = None) -> PlannedMotion | None:
        """What exports are made of; None without a trajectory."""
        if self.trajectory is None:
            return None
        prepared, robot = self.built.prepared, self.built.robot
        task, motion = prepared.setup.task, prepared.setup.motion
        given = None if motion is None else motion.joint_velocities_rad_per_s
        speeds = np.where(np.isnan(robot.velocity), given or np.nan, robot.velocity)
        return PlannedMotion(
            trajectory=self.trajectory,
            robot=replace(robot, velocity=speeds),
            flange=robot.frame_of(prepared.setup.robot.flange_link),
            base=controller_base(prepared),
            step_s=export_step_s,
            # A tool that stands off presses on nothing.
            force_n=0.0 if task.stand_off_m else task.normal_force_n,
            controller=prepared.setup.controller,
            led=bool(motion and motion.lead_m),
            part=prepared.scene.placement.matrix,
        )

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.missing or self.trajectory}>"


@dataclass(frozen=True, repr=False, eq=False, kw_only=True)
class PlannedScene(UnfinishedPlan):
    """A scene with its fewest lift-offs, a motion that has them, and the judge's verdict on it.

    Its attributes are those of an unfinished plan, and all of them are there.
    """

    result: Result
    painted: Painted
    paths: ToolPaths
    trajectory: Trajectory
    verdict: TrajectoryVerdict

    @property
    def solution(self) -> Solution:
        """The solver's answer, which the checker has passed."""
        return self.result.solution

    @property
    def complete(self) -> bool:
        """Whether all that was asked for is there: answers, and the program of a controller."""
        asked = self.built.scene.setup.controller is not None
        return not (self.lacking if asked else self.unanswered)

    def __str__(self) -> str:
        extra = len(self.trajectory.extra_lift_offs)
        said = [f"{self.built.surface.name}: {self.result}", str(self.paths)]
        if self.solution.preference is not None:
            said.insert(1, f"posture: {self.solution.preference}")
        if len(self.painted.minima) > 1:
            earlier = ", ".join(map(str, self.painted.minima[:-1]))
            said.insert(1, f"refined where the scene refused a painting; {earlier} segments before")
        said += [str(self.trajectory) + (f", {extra} beyond the minimum" if extra else "")]
        if self.trajectory.unplanned:
            moves = count(len(self.trajectory.unplanned), "move")
            between = "; ".join(dict.fromkeys(self.trajectory.meta.get("blocked", ())))
            said.append(
                f"{moves} between strokes not planned: the arm must not drive there"
                + (f"; in the way: {between}" if between else "")
            )
        covered = self.verdict.covered
        said.append(f"judge: {self.verdict}" + ("" if covered is None else f"; {covered}"))
        said += [f"  {line}" for line in self.verdict.feed_lines]
        said += [str(answer) for answer in (self.answered.answers if self.answered else ())]
        said += self.lacking
        coverage = self.instance.coverage
        if coverage is not None and coverage.given_up:
            left_out = "slivers" if self.built.left_alone is None else "left out on purpose"
            said.append(f"{left_out}: {coverage}")
        return "\n".join(said)


def controller_base(prepared: PreparedScene) -> Array:
    """(4, 4) pose in the world of the link that the arm's controller counts from.

    Raises:
        InputError: the arm has no link that the setup names as the base.
    """
    setup = prepared.setup
    base = None if setup.controller is None else setup.controller.base_link
    try:
        return prepared.robot.base_frame(base)
    except KeyError as error:
        message = f"no link {base!r} stands still before the first joint"
        raise InputError(setup.file, "controller.base_link", message) from error


class PlanOutOfTime(OutOfTime):
    """The time limit came before a motion was planned and judged.

    Attributes:
        unfinished: what there is.
    """

    def __init__(self, unfinished: UnfinishedPlan) -> None:
        self.unfinished = unfinished
        super().__init__(unfinished.missing)


class NothingCovered(InputError):
    """No point of the object can be covered.

    Attributes:
        report: what the build found, reachability by reason among it.
    """

    def __init__(self, report: BuildReport, file: Path | None) -> None:
        self.report = report
        super().__init__(file, None, report.nothing_covered or "there is nothing to cover")


SIDE, SURFACE = "instance.reasons.npz", "instance.surface.json"

KINDS: dict[str, FileKind] = {
    SIDE: SIDE_FILE,
    SURFACE: kind_of_format(LabelledSurface.FORMAT),
    "instance.json": kind_of_format(Instance.FORMAT),
    "solution.json": kind_of_format(Solution.FORMAT),
    "painted.plan.json": kind_of_format(Plan.FORMAT),
    "painted.surface.json": kind_of_format(LabelledSurface.FORMAT),
    "paths.json": kind_of_format(ToolPaths.FORMAT),
    "trajectory.json": kind_of_format(Trajectory.FORMAT),
    "verdict.json": kind_of_format(TrajectoryVerdict.FORMAT),
    **{name: export.kind for name, export in EXPORTS.items()},
    "report.html": HTML,
}
"""Every file by name; one that refers to others comes after them."""


def check_folder(folder: Path, inputs: list[Path]) -> None:
    """Refuse a folder where writing would destroy something, or cannot succeed.

    Raises:
        InputError: with the reason.
    """
    if is_folder_or_nothing(folder):
        for name, kind in KINDS.items():
            check_output(folder / name, kind, inputs)
