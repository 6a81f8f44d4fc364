"""``cellcolor.plan``: from a scene to a judged motion, with all that leads to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.data.instance import Instance, SurfaceReference
from cellcolor.data.solution import Solution
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.asking import explain, tradeoff
from cellcolor.door.extras import require_motion
from cellcolor.door.leaving_out import Wanted, rest_of
from cellcolor.door.placing import place
from cellcolor.door.plan_files import SIDE, SURFACE, save
from cellcolor.door.result import Result
from cellcolor.door.solving import solve
from cellcolor.door.subject import Subject, scene_or_file
from cellcolor.errors import InputError
from cellcolor.exports.registry import exported
from cellcolor.files.paths import path_of
from cellcolor.painting.paint import Painted
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.data.trajectory_verdict import TrajectoryVerdict
    from cellcolor.frontend import BuildReport, BuildResult, Scene
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.stage_clock import StageClock
    from cellcolor.pictures.report_page.content import AnsweredScene, Answers, MotionReport
    from cellcolor.tool_paths.measures import PathMeasures

_NEEDED = ("pinocchio", "fcl", "trimesh", "scipy", "potpourri3d", "ompl", "toppra")
_FOR_SOLVING = 0.5  # of the time that is left then; a proof can take any time
_QUESTIONS = ("tradeoff", "explain", "place", "setups")  # that a plan's page can answer besides
_MOVED = 0.1  # m; so far a question moves the part along x and y
_PLACEMENTS = 32
_FOR_BUILDING = 0.6  # of the time that is left then, with several set-ups


@dataclass(frozen=True, repr=False, eq=False)
class UnfinishedPlan:
    """A scene on its way to a motion, as far as it got within the time limit.

    A trajectory is not part of it: none leaves the program without having been judged.

    Attributes:
        subject: the scene, built and decomposed.
        result: the fewest segments that were found, and what is proved; None before the search.
        painted: the segments on the surface, if they were painted.
        paths: where the tool goes, if that was laid out.
        measures: of each of these paths.
    """

    subject: Subject
    result: Result | None
    painted: Painted | None
    paths: ToolPaths | None
    measures: tuple[PathMeasures, ...]

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
        if self.result is None or self.result.solution.cells is None:
            cut = "before any division into segments was found"
        elif self.painted is None:
            cut = "before the segments were painted on the surface"
        elif self.paths is None:
            cut = "before the tool paths were laid out"
        else:
            cut = "before the arm's motion on the tool paths was planned and judged"
        return f"The time limit came {cut}."

    def _report(self) -> MotionReport:
        """What the page tells of."""
        from cellcolor.pictures.report_page.content import MotionReport

        decomposition, painted = self.subject.decomposition, self.painted
        return MotionReport(
            self.built,
            decomposition,
            self.solution,
            painted,
            None,
            self.measures,
            None,
            self.paths,
            self.missing,
        )

    def page(self) -> bytes:
        """``report.html``, complete in itself: what there is, and what is missing."""
        from cellcolor.pictures.report_page.page import render_page

        return render_page(self._report())

    def _files(self, export_step_s: float | None = None) -> dict[str, bytes]:  # noqa: ARG002
        """All files but the page, by name, as far as the plan came."""
        surface, decomposition = self.subject.surface, self.subject.decomposition
        reference = SurfaceReference(SURFACE, tuple(decomposition.vertex_cell), surface.sha256)
        named = replace(decomposition.instance, surface=reference)
        content = {
            SIDE: self.built.candidates.to_bytes(),
            SURFACE: replace(surface, meta=surface.meta | {"side_file": SIDE}).to_json().encode(),
            "instance.json": named.to_json().encode(),
        }
        if self.solution is not None:
            content["solution.json"] = self.solution.to_json().encode()
        if self.painted is not None:
            content["painted.plan.json"] = self.painted.plan.to_json().encode()
            content["painted.surface.json"] = self.painted.surface.to_json().encode()
        if self.paths is not None:
            content["paths.json"] = self.paths.to_json().encode()
        return content

    def save(
        self, folder: str | PathLike[str], export_step_s: float | None = None
    ) -> tuple[str, ...]:
        """Write all files that are ready to a folder (docs/plan.md), all of them or none.

        Args:
            folder: where; it is made if it is not there.
            export_step_s: the fixed time step of the files for controllers, s; None keeps the
                samples of the trajectory (docs/formats/controllers.md).

        Returns:
            Their names.

        Raises:
            InputError: a plan that got further is there, or something else that is not
                overwritten; or it cannot be written.
        """
        return save(path_of(folder), self._files(export_step_s) | {"report.html": self.page()})

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.missing}>"


@dataclass(frozen=True, repr=False, eq=False)
class PlannedScene(UnfinishedPlan):
    """A scene with its fewest lift-offs, a motion that has them, and the judge's verdict on it.

    Attributes:
        trajectory: how the arm moves.
        verdict: an independent judge's.
        seconds: wall time of each stage.
        answered: what was asked besides, for the page; None if nothing was.
    """

    result: Result
    painted: Painted
    paths: ToolPaths
    measures: tuple[PathMeasures, ...]
    trajectory: Trajectory
    verdict: TrajectoryVerdict
    seconds: Mapping[str, float]
    answered: AnsweredScene | None = None

    @property
    def solution(self) -> Solution:
        """The solver's answer, which the checker has passed."""
        return self.result.solution

    @property
    def missing(self) -> str:
        """Nothing."""
        return ""

    def _report(self) -> MotionReport:
        return replace(
            super()._report(),
            trajectory=self.trajectory,
            verdict=self.verdict,
            paths=None,
            answered=self.answered,
        )

    def _files(self, export_step_s: float | None = None) -> dict[str, bytes]:
        from cellcolor.exports.interface import ArmAxes, PlannedMotion
        from cellcolor.pictures.report_page.surface_modes import segment_fills

        painted, trajectory = self.painted, self.trajectory
        fills = segment_fills(painted)
        arm = self.built.robot
        axes = ArmAxes.of(arm.joint_names, arm.placement, arm.axis, bool(arm.slides.any()))
        motion = PlannedMotion(
            painted.surface,
            painted.segment_of,
            fills,
            self.paths,
            trajectory,
            axes,
            export_step_s,
            self.built.prepared.setup.task.normal_force_n,
        )
        return {
            **super()._files(),
            "trajectory.json": trajectory.to_json().encode(),
            "verdict.json": self.verdict.to_json().encode(),
            **exported(motion),
        }

    def __str__(self) -> str:
        extra = len(self.trajectory.extra_lift_offs)
        said = [f"{self.built.surface.name}: {self.result}", str(self.paths)]
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
        said += [str(answer) for answer in (self.answered.answers if self.answered else ())]
        coverage = self.instance.coverage
        if coverage is not None and coverage.given_up:
            left_out = "slivers" if self.built.left_alone is None else "left out on purpose"
            said.append(f"{left_out}: {coverage}")
        return "\n".join(said)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.trajectory}>"


class PlanOutOfTime(OutOfTime):
    """The time limit came before a motion was planned and judged.

    Attributes:
        unfinished: what there is.
    """

    def __init__(self, unfinished: UnfinishedPlan) -> None:
        self.unfinished = unfinished
        super().__init__(unfinished.missing)

    def __reduce__(self) -> tuple[type[PlanOutOfTime], tuple[UnfinishedPlan]]:
        # Python would hand the text to __init__, which takes the plan.
        return type(self), (self.unfinished,)


class NothingCovered(InputError):
    """No point of the object can be covered.

    Attributes:
        report: what the build found, reachability by reason among it.
    """

    def __init__(self, report: BuildReport, file: str | None) -> None:
        self.report = report
        super().__init__(file, None, report.nothing_covered or "there is nothing to cover")

    def __reduce__(self) -> tuple[type[NothingCovered], tuple[BuildReport, str | None]]:
        # As in InputError.
        return type(self), (self.report, self.file)


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
    for name in ask:
        if name not in _QUESTIONS:
            raise InputError(None, "ask", f"{name!r} is not one of {', '.join(_QUESTIONS)}")
    deadline = Deadline.of(time_limit)

    given_or_file = scene_or_file(scene)
    require_motion("planning a motion", _NEEDED)
    find_pattern(pattern or DEFAULT_PATTERN)
    from cellcolor.frontend.prepared import prepare
    from cellcolor.frontend.scene import Scene
    from cellcolor.frontend.stage_clock import StageClock
    from cellcolor.motion.home import home_of
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
        home_of(prepared, motion_of(prepared))
    with clock.timed("colors"):
        subject = _built(prepared, path, StageClock(deadline, progress))
    so_far, whole = UnfinishedPlan(subject, None, None, None, ()), subject

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
            answered = _answered(ask, whole, deadline, progress)
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


def _answered(
    names: Sequence[str],
    subject: Subject,
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
) -> AnsweredScene:
    """What a plan's page tells besides, as far as there is time.

    Args:
        names: of the questions.
        subject: a scene, built, nothing left out.
        deadline: when to be content with the answers so far.
        progress: told what is being done.
    """
    from cellcolor.pictures.report_page.content import AnsweredScene
    from cellcolor.questions.setting_up import candidates_of, plan_of

    scene = subject.build().scene
    (x, y, z), (roll, pitch, yaw) = scene.placement.position_m, scene.placement.rpy_rad
    given: dict[str, Any] = {"time_limit": deadline, "progress": progress}
    answers: list[Answers] = []
    try:
        if "tradeoff" in names:
            answers.append(tradeoff(subject, **given))
        if "explain" in names:
            answers.append(explain(scene, **given))
        if "place" in names:
            around: dict[str, Any] = {"x": (x - _MOVED, x + _MOVED), "y": (y - _MOVED, y + _MOVED)}
            answers.append(place(scene, **around, points=_PLACEMENTS, **given))
        if "setups" in names:
            turned = [(x, y, z, roll, pitch, yaw + turns * pi / 2) for turns in (1, 2, 3)]
            found = candidates_of([scene], turned, deadline.share(_FOR_BUILDING), progress)
            answers.append(plan_of(found, 1.0, None, Options(deadline=deadline), progress))
    except OutOfTime:
        pass  # the page is about the plan, and has what there is
    return AnsweredScene(subject.surface, subject.decomposition, tuple(answers))
