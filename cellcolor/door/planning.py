"""``cellcolor.plan``: from a scene to a judged motion, with all that leads to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.asking import asked_besides, check_questions
from cellcolor.door.extras import require_motion
from cellcolor.door.leaving_out import Wanted, rest_of
from cellcolor.door.result import Result
from cellcolor.door.solving import solve
from cellcolor.door.subject import Subject, scene_or_file
from cellcolor.door.unfinished import NothingCovered, PlanOutOfTime, UnfinishedPlan
from cellcolor.files.paths import path_of
from cellcolor.painting.paint import Painted
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.data.trajectory_verdict import TrajectoryVerdict
    from cellcolor.frontend import BuildResult, Scene
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.stage_clock import StageClock
    from cellcolor.pictures.report_page.content import AnsweredScene
    from cellcolor.tool_paths.measures import PathMeasures

_NEEDED = ("pinocchio", "fcl", "trimesh", "scipy", "potpourri3d", "ompl", "toppra")
_FOR_SOLVING = 0.5  # of the time that is left then; a proof can take any time


@dataclass(frozen=True, repr=False, eq=False)
class PlannedScene:
    """A scene with its fewest lift-offs, a motion that has them, and the judge's verdict on it.

    Attributes:
        subject: the scene, built and decomposed.
        result: the fewest segments, and what is proved about them.
        painted: the segments on the surface.
        paths: where the tool goes.
        measures: of each of these paths.
        trajectory: how the arm moves.
        verdict: an independent judge's.
        seconds: wall time of each stage.
        answered: what was asked besides, for the page; None if nothing was.
    """

    subject: Subject
    result: Result
    painted: Painted
    paths: ToolPaths
    measures: tuple[PathMeasures, ...]
    trajectory: Trajectory
    verdict: TrajectoryVerdict
    seconds: Mapping[str, float]
    answered: AnsweredScene | None = None

    @property
    def built(self) -> BuildResult:
        """Which colors reach each point."""
        return self.subject.build()

    @property
    def instance(self) -> Instance:
        """The topological graph."""
        return self.subject.graph()

    @property
    def solution(self) -> Solution:
        """The solver's answer, which the checker has passed."""
        return self.result.solution

    def page(self) -> bytes:
        """``report.html``, complete in itself."""
        from cellcolor.pictures.report_page.content import MotionReport
        from cellcolor.pictures.report_page.page import render_page

        return render_page(
            MotionReport(
                self.built,
                self.subject.decomposition,
                self.solution,
                self.painted,
                self.trajectory,
                self.measures,
                self.verdict,
                answered=self.answered,
            )
        )

    def save(self, folder: str | PathLike[str]) -> None:
        """Write all files of a plan to a folder (docs/plan.md), all of them or none.

        Raises:
            InputError: something else is there, or it cannot be written.
        """
        from cellcolor.door.plan_files import files_of_motion, files_so_far, save

        files = files_so_far(self.subject, self.solution, self.painted, self.paths)
        files |= files_of_motion(self.painted, self.paths, self.trajectory, self.verdict)
        save(path_of(folder), files | {"report.html": self.page()})

    def __str__(self) -> str:
        extra = len(self.trajectory.extra_lift_offs)
        said = [f"{self.built.surface.name}: {self.result}", str(self.paths)]
        if len(self.painted.minima) > 1:
            earlier = ", ".join(map(str, self.painted.minima[:-1]))
            said.insert(1, f"refined where the scene refused a painting; {earlier} segments before")
        said += [str(self.trajectory) + (f", {extra} beyond the minimum" if extra else "")]
        if self.trajectory.unplanned:
            moves = count(len(self.trajectory.unplanned), "move")
            said.append(f"{moves} between strokes not planned: the arm must not drive there")
        covered = self.verdict.covered
        said.append(f"judge: {self.verdict}" + ("" if covered is None else f"; {covered}"))
        said += [str(answer) for answer in (self.answered.answers if self.answered else ())]
        coverage = self.instance.coverage
        if coverage is not None and coverage.given_up:
            left_out = "slivers" if self.built.left_alone is None else "left out on purpose"
            said.append(f"{left_out}: {coverage}")
        return "\n".join(said)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.trajectory}>"


def plan(
    scene: str | PathLike[str] | Scene,
    *,
    pattern: str | None = None,
    cover: float | None = None,
    required: Place | None = None,
    left_alone: Place | None = None,
    ask: Sequence[str] = (),
    time_limit: TimeLimit = None,
    progress: Callable[[str], None] | None = None,
    **motion: Any,
) -> PlannedScene:
    """Plan a motion over a scene's object, with the fewest lift-offs, and have it judged.

    Needs the extra ``motion``.

    Args:
        scene: its file, its shipped name, or the value.
        pattern: how tool paths are laid out, such as ``contour``; None for the usual one.
        cover, required, left_alone: what has to be covered, as for ``solve``; the judge does not
            ask for what is left out.
        ask: what the page is to tell besides, of ``tradeoff``, ``explain``, ``place`` and
            ``setups``; it is asked of the whole scene in the time that is left. ``place`` moves the
            part by up to 10 cm along x and y, ``setups`` turns it by quarter turns.
        time_limit: seconds for all of it, None for as long as it takes.
        progress: told the name of each stage as it begins.
        **motion: keys of the setup's table ``[motion]``, which they replace, such as
            ``spacing_m`` or ``speed_m_per_s`` (docs/plan.md).

    Raises:
        InputError: the scene or a key cannot be used, no point of the object can be covered, or
            the setup has no table ``[motion]`` and not all that is needed of it is given.
        PlanOutOfTime: the time limit came after the topological graph was known; what is ready by
            then can be saved.
        OutOfTime: it came earlier.
    """
    from cellcolor.tool_paths.registry import DEFAULT_PATTERN, find_pattern

    wanted = Wanted(cover, required, left_alone)
    check_questions(ask)
    deadline = Deadline.of(time_limit)

    given_or_file = scene_or_file(scene)
    require_motion("planning a motion", _NEEDED)
    find_pattern(pattern or DEFAULT_PATTERN)
    from cellcolor.frontend.prepared import prepare
    from cellcolor.frontend.scene import Scene
    from cellcolor.frontend.stage_clock import StageClock
    from cellcolor.motion.home import check_home
    from cellcolor.motion.limits import motion_of
    from cellcolor.motion.plan import plan_motion
    from cellcolor.motion.scene_painting import paint_scene
    from cellcolor.trajectory_checker.check import check_trajectory

    clock = StageClock(deadline, progress)
    given = Scene.read(given_or_file) if isinstance(given_or_file, Path) else given_or_file
    path = given.file
    with clock.timed("preparation"):
        prepared = prepare(_with_motion(given, motion), deadline)
        # What is wrong with the motion is refused before the long work begins.
        check_home(prepared, motion_of(prepared))
    with clock.timed("colors"):
        subject = _built(prepared, path, StageClock(deadline, progress))
    so_far, whole = UnfinishedPlan(subject), subject

    def has(**more: Any) -> None:
        nonlocal so_far
        so_far = replace(so_far, **more)

    try:
        with clock.timed("fewest segments"):
            subject, notes, share = rest_of(subject, wanted, Options(deadline=deadline))
            has(subject=subject)
            result = solve(subject, time_limit=deadline.share(_FOR_SOLVING))
            result = _with_notes(result, notes, share)
            has(result=result)
            if result.solution.cells is None:
                raise OutOfTime("the time limit came before any division was found")
        with clock.timed("painting"):
            painting = paint_scene(
                subject.build(),
                subject.decomposition,
                result.solution,
                deadline=deadline,
                progress=progress,
            )
        if len(painting.painted.minima) > 1:  # the surface was refined and solved again
            subject = Subject(path, painting.built, painting.built.surface)
            result = _with_notes(Result(painting.solution, subject), notes, share)
        has(subject=subject, result=result, painted=painting.painted)
        built = painting.built
        with clock.timed("motion"):
            planned = plan_motion(
                built,
                painting.painted,
                painting.normals,
                pattern=pattern or DEFAULT_PATTERN,
                deadline=deadline,
                progress=progress,
                on_paths=lambda paths, measures: has(paths=paths, measures=measures),
            )
        solution = result.solution
        with clock.timed("judging"):
            verdict = check_trajectory(
                built,
                planned.trajectory,
                minimum_lift_offs=solution.lift_offs if solution.proved_for_surface else None,
                deadline=deadline,
                progress=progress,
            )
    except OutOfTime as error:
        raise PlanOutOfTime(so_far) from error
    answered = None
    if ask:
        with clock.timed("questions"):
            answered = asked_besides(ask, whole, deadline, progress)
    return PlannedScene(
        subject,
        result,
        painting.painted,
        planned.paths,
        planned.measures,
        planned.trajectory,
        verdict,
        clock.seconds,
        answered,
    )


def _with_notes(result: Result, notes: tuple[str, ...], share: float) -> Result:
    """The result with what is said of what was left out on purpose."""
    solution = replace(result.solution, notes=(*notes, *result.solution.notes))
    return replace(result, solution=solution, covered_share=share)


def _with_motion(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """The scene with some keys of its setup's table ``[motion]`` replaced."""
    from cellcolor.frontend.tables import in_file

    if not changes:
        return scene
    with in_file(scene.setup.file):
        # Both keep the names of their files: the labelled surface says what it was built from.
        setup = scene.setup.varied(motion=dict(changes), file=scene.setup.file)
        return scene.varied(setup=setup, file=scene.file)


def _built(prepared: PreparedScene, path: Path | None, clock: StageClock) -> Subject:
    """The scene, built.

    Raises:
        NothingCovered: no point of the object can be covered.
    """
    from cellcolor.frontend.build import build_prepared

    built = build_prepared(prepared, clock)
    subject = Subject(path, built, built.surface)
    if subject.graph(clock.deadline).nothing_to_cover:
        raise NothingCovered(built.report, str(prepared.scene.file or "") or None)
    return subject
