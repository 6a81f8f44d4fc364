"""``cellcolor.plan``: from a scene to a judged motion, with all that leads to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import pi
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

from cellcolor.data.wording import check_share, listed
from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.asking import explain, place, tradeoff
from cellcolor.door.installed import require_motion
from cellcolor.door.planned import (
    NothingCovered,
    PlannedScene,
    PlanOutOfTime,
    UnfinishedPlan,
    controller_base,
)
from cellcolor.door.solving import rest_of, solve
from cellcolor.door.subject import Result, Subject, scene_of
from cellcolor.errors import InputError, naming
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.frontend import Scene
    from cellcolor.frontend.build import StageClock
    from cellcolor.motion.plan import MotionPlan
    from cellcolor.pictures.report_page.content import AnsweredScene, Answers

_NEEDED = ("pinocchio", "fcl", "igl", "trimesh", "scipy", "potpourri3d")
_FOR_SOLVING = 0.5  # share of the time left then; a proof can take any time
_QUESTIONS = ("tradeoff", "explain", "place", "setups")  # that a plan's page can answer besides
_MOVED = 0.1  # m; how far the question ``place`` moves the part along x and y
_PLACEMENTS = 32  # that the question ``place`` tries
_DIVISIONS = 3  # tried at most: another if the arm finds no way to some color
_FOR_BUILDING = 0.6  # share of the time left then, for the question ``setups``


def plan(
    scene: str | PathLike[str] | Scene,
    *,
    pattern: str | None = None,
    cover: float | None = None,
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
        pattern: of the tool paths, as for ``cover``; None for the usual one.
        cover, left_alone: what has to be covered, as for ``solve``; the judge does not
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

    check_share("cover", cover)
    for name in ask:
        if name not in _QUESTIONS:
            raise InputError(None, "ask", f"{name!r} is not one of {', '.join(_QUESTIONS)}")
    deadline = Deadline.of(time_limit)
    require_motion("planning a motion", _NEEDED)
    given = scene_of(scene)
    find_pattern(pattern or DEFAULT_PATTERN)
    from cellcolor.frontend.build import StageClock, build_prepared
    from cellcolor.frontend.prepared import prepare
    from cellcolor.motion.limits import home_of, motion_of

    clock = StageClock(deadline, progress)
    with clock.timed("preparation"):
        prepared = prepare(_with_motion(given, motion), deadline)
        # What is wrong with the motion is refused before the long work begins.
        home_of(prepared, motion_of(prepared))
        controller_base(prepared)
    with clock.timed("colors"):
        built = build_prepared(prepared, StageClock(deadline, progress))
        whole = Subject(given.file, built)
        if whole.graph(deadline).nothing_to_cover:
            raise NothingCovered(built.report, prepared.scene.file)
    run = _Run(whole, pattern or DEFAULT_PATTERN, clock, progress)
    try:
        planned = run.planned(cover, left_alone)
    except OutOfTime as error:
        unasked = tuple(f"{name}: not asked, the time limit came first" for name in ask)
        raise PlanOutOfTime(replace(run.so_far, unanswered=unasked)) from error
    if not ask:
        return planned
    with clock.timed("questions"):
        answered, unanswered = _answered(ask, whole, deadline, progress)
    return replace(planned, answered=answered, unanswered=unanswered)


_Driven: TypeAlias = tuple[UnfinishedPlan, "MotionPlan"]
"""A division with its tool paths, and the motion on them; some moves may be unplanned."""


class _Run:
    """One call of :func:`plan`, from the built scene to the verdict.

    Attributes:
        so_far: what is ready, in case the time limit comes.
    """

    def __init__(
        self,
        whole: Subject,
        pattern: str,
        clock: StageClock,
        progress: Callable[[str], None] | None,
    ) -> None:
        self.so_far = UnfinishedPlan(subject=whole)
        self._pattern, self._clock, self._progress = pattern, clock, progress
        self._deadline = clock.deadline
        # On what is left out on purpose, and the share of the area that is covered then.
        self._notes: tuple[str, ...] = ()
        self._share = 1.0

    def planned(self, cover: float | None, place: Place | None) -> PlannedScene:
        """The motion for what has to be covered, and what the independent judge says of it."""
        from cellcolor.trajectory_checker.check import check_trajectory

        with self._clock.timed("fewest segments"):
            options = Options(deadline=self._deadline)
            subject, self._notes, self._share = rest_of(self.so_far.subject, cover, place, options)
            self._has(subject=subject)
            result = self._solved(subject)
            self._has(result=result)
            if result.solution.cells is None:
                raise OutOfTime("the time limit came before any division was found")
        self.so_far, motion = self._best_of(subject, result)
        with self._clock.timed("judging"):
            solution = self.so_far.solution
            proved = solution if solution and solution.proved_for_surface else None
            verdict = check_trajectory(
                self.so_far.built,
                motion.trajectory,
                minimum_lift_offs=None if proved is None else proved.lift_offs,
                deadline=self._deadline,
                progress=self._progress,
            )
        self._has(trajectory=motion.trajectory, verdict=verdict, seconds=self._clock.seconds)
        return PlannedScene(**vars(self.so_far))

    def _best_of(self, subject: Subject, result: Result) -> _Driven:
        """A division driven; or, where the arm finds no way to some colors, one without these.

        Such a division may have no more lift-offs than are proved with all colors.
        """
        tried = [self._driven(subject, result)]
        least = tried[0][0].solution
        while least is not None and least.proved_for_surface and len(tried) < _DIVISIONS:
            built, motion = tried[-1][0].built, tried[-1][1]
            surface = built.surface.without_colors(motion.cut_off)
            if surface.vertex_colors == built.surface.vertex_colors:
                break
            rest = Subject(subject.path, replace(built, surface=surface))
            colors = listed([surface.colors[color] for color in motion.cut_off])
            note = (
                f"The arm found no way to what it would do in {colors}, so this division"
                " does without, wherever it can. As many lift-offs are proved with all colors."
            )
            try:
                with self._clock.timed("fewest segments"):
                    again = self._solved(rest, note)
                if again.solution.lift_offs != least.lift_offs:
                    break
                tried.append(self._driven(rest, again))
            except OutOfTime:
                break
        return min(tried, key=lambda one: len(one[1].trajectory.unplanned))

    def _has(self, **more: Any) -> None:
        self.so_far = replace(self.so_far, **more)

    def _solved(self, subject: Subject, *about: str) -> Result:
        """The fewest segments, with notes on what was left out on purpose."""
        found = solve(subject, time_limit=self._deadline.share(_FOR_SOLVING))
        return self._with_notes(found, *about)

    def _with_notes(self, result: Result, *about: str) -> Result:
        notes = (*self._notes, *about, *result.solution.notes)
        solution = replace(result.solution, notes=notes)
        return replace(result, solution=solution, covered_share=self._share)

    def _driven(self, subject: Subject, result: Result) -> _Driven:
        """A division painted and driven."""
        from cellcolor.motion.plan import plan_motion
        from cellcolor.motion.scene_painting import paint_scene

        with self._clock.timed("painting"):
            painting = paint_scene(
                subject.build(),
                subject.decomposition,
                result.solution,
                deadline=self._deadline,
                progress=self._progress,
            )
        if len(painting.painted.minima) > 1:  # the surface was refined and solved again
            subject = Subject(subject.path, painting.built)
            result = self._with_notes(Result(painting.solution, subject))
        self._has(subject=subject, result=result, painted=painting.painted)
        with self._clock.timed("motion"):
            motion = plan_motion(
                painting.built,
                painting.painted,
                pattern=self._pattern,
                deadline=self._deadline,
                progress=self._progress,
                on_paths=lambda paths: self._has(paths=paths),
            )
        self._has(paths=motion.paths)
        return self.so_far, motion


def _with_motion(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """The scene with some keys of its setup's table ``[motion]`` replaced."""
    if not changes:
        return scene
    with naming(scene.setup.file):
        # Both keep the names of their files: the labelled surface says what it was built from.
        setup = scene.setup.varied(motion=dict(changes), file=scene.setup.file)
        return scene.varied(setup=setup, file=scene.file)


def _answered(
    names: Sequence[str],
    subject: Subject,
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
) -> tuple[AnsweredScene, tuple[str, ...]]:
    """The answers to the questions asked of a built scene, and why others have none or a part."""
    from cellcolor.pictures.report_page.content import AnsweredScene
    from cellcolor.questions.setting_up import candidates_of, plan_of

    scene = subject.build().scene
    (x, y, z), (roll, pitch, yaw) = scene.placement.position_m, scene.placement.rpy_rad
    around: dict[str, Any] = {"x": (x - _MOVED, x + _MOVED), "y": (y - _MOVED, y + _MOVED)}
    turned = [(x, y, z, roll, pitch, yaw + turns * pi / 2) for turns in (1, 2, 3)]
    given: dict[str, Any] = {"time_limit": deadline, "progress": progress}

    def set_ups() -> Answers:
        found = candidates_of([scene], turned, deadline.share(_FOR_BUILDING), progress)
        return plan_of(found, 1.0, None, Options(deadline=deadline), progress)

    ways: dict[str, Callable[[], Answers]] = {
        "tradeoff": lambda: tradeoff(subject, **given),
        "explain": lambda: explain(scene, **given),
        "place": lambda: place(scene, **around, points=_PLACEMENTS, **given),
        "setups": set_ups,
    }
    answers: list[Answers] = []
    unanswered: list[str] = []
    for name in (name for name in _QUESTIONS if name in names):
        try:
            answers.append(ways[name]())
            if not answers[-1].complete:
                unanswered.append(f"{name}: answered in part, the time limit came first")
        except OutOfTime:
            unanswered.append(f"{name}: not answered, the time limit came first")
        except InputError as error:  # the motion is planned and judged all the same
            unanswered.append(f"{name}: not answered: {error}")
    return AnsweredScene(subject.surface, subject.decomposition, tuple(answers)), tuple(unanswered)
