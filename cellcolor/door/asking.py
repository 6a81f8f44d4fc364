"""``cellcolor.tradeoff`` and ``explain``: what fewer lift-offs cover, and what costs a lift-off."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.door.drawing import kind_of_plot
from cellcolor.door.extras import extras_for
from cellcolor.door.leaving_out import front_on
from cellcolor.door.leaving_out import left_alone as without_place
from cellcolor.door.placing import place
from cellcolor.door.setting_up import setups
from cellcolor.door.subject import Solvable, Subject, open_subject, scene_or_file
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of
from cellcolor.files.writing import Output, write
from cellcolor.questions.front import Front
from cellcolor.questions.places import Place
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.arrays import Array
    from cellcolor.frontend import Scene
    from cellcolor.pictures.report_page.content import AnsweredScene, Answers
    from cellcolor.questions.explanation import Explanation

QUESTIONS = ("tradeoff", "explain", "place", "setups")
"""What a plan's page can tell besides."""

_MOVED = 0.1  # m; so far the part is moved where nothing else is said
_PLACEMENTS = 32


def tradeoff(
    source: Solvable,
    *,
    weights: Sequence[float] | Array | None = None,
    required: Place | None = None,
    left_alone: Place | None = None,
    time_limit: TimeLimit = None,
    workers: int | None = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Front:
    """Find the largest share of area that each number of lift-offs can cover, with proof.

    Args:
        source: a scene, a labelled surface or an instance: its file, its shipped name, the value.
        weights: of each vertex (n,), as a factor of its area: quality, urgency; None for 1.
        required: vertices that have to be covered: a mask (n,), a
            :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface gives up.
        left_alone: vertices that must not be covered, the same kinds; nothing is asked of them.
        time_limit: seconds for all of it, None for as long as it takes.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: for all random choices.
        progress: told what is being done.

    Returns:
        The front. Shares are of the area that can be covered and is not left alone.

    Raises:
        InputError: the source cannot be used, or has no surface for weights and places to be on; a
            mask is of another mesh, or a weight is negative or no number.
        OutOfTime: the time limit came before any division was found.
    """
    deadline = Deadline.of(time_limit)
    subject = without_place(open_subject(source, deadline, progress), left_alone)
    options = Options(deadline=deadline, workers=workers, seed=seed)
    return front_on(subject, weights, required, options, progress)


def save_front(front: Front, path: str | PathLike[str]) -> None:
    """Draw a front to a file .png or .svg.

    Nothing but an older picture is overwritten.

    Raises:
        InputError: another ending, something else is there, it cannot be written, or the extra
            ``viz`` is not installed.
    """
    file = path_of(path)
    kind = kind_of_plot(file)
    with extras_for("plots"):
        from cellcolor.pictures.plots import render_front
    write([Output(file, kind, [render_front(front, file.suffix[1:])])])


def explain(
    scene: str | PathLike[str] | Scene,
    *,
    at: Sequence[float] | None = None,
    time_limit: TimeLimit = None,
    workers: int | None = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Explanation:
    """Find what costs a lift-off: the minimum with each limit, obstacle and test relaxed, proved.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        at: (3,) a point in the world, m; the report also says what each branch does at the vertex
            nearest to it.
        time_limit: seconds for all of it, None for no limit.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: for all random choices.
        progress: told what is being tried.

    Returns:
        Rows, ranked. Shares are of the whole surface, since what can be reached changes.

    Raises:
        InputError: the scene cannot be used, nothing of it is reached, or the point is none.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    deadline = Deadline.of(time_limit)
    scene = scene_or_file(scene)
    point = None
    if at is not None:
        point = np.asarray(at, dtype=float)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(None, "at", "must be three numbers x, y, z in m")
    with extras_for("the front end"):
        from cellcolor.frontend.prepared import prepare
        from cellcolor.questions.explaining import explained

    options = Options(deadline=deadline, workers=workers, seed=seed)
    return explained(prepare(scene, deadline), options, point, progress)


def check_questions(names: Sequence[str]) -> None:
    """Refuse a question that a plan's page cannot answer.

    Raises:
        InputError: there is none of that name.
    """
    for name in names:
        if name not in QUESTIONS:
            raise InputError(None, "ask", f"{name!r} is not one of {', '.join(QUESTIONS)}")


def asked_besides(
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

    scene = subject.build().scene
    x, y = (float(value) for value in scene.placement.position_m[:2])
    answers: list[Answers] = []
    try:
        if "tradeoff" in names:
            answers.append(tradeoff(subject, time_limit=deadline, progress=progress))
        if "explain" in names:
            answers.append(explain(scene, time_limit=deadline, progress=progress))
        if "place" in names:
            found = place(
                scene,
                x=(x - _MOVED, x + _MOVED),
                y=(y - _MOVED, y + _MOVED),
                points=_PLACEMENTS,
                time_limit=deadline,
                progress=progress,
            )
            answers.append(found)
        if "setups" in names:
            position, (roll, pitch, yaw) = scene.placement.position_m, scene.placement.rpy_rad
            turned = [(*position, roll, pitch, yaw + turns * pi / 2) for turns in (1, 2, 3)]
            chosen = setups(scene, at=turned, time_limit=deadline, progress=progress)
            answers.append(chosen.answer)
    except OutOfTime:
        pass  # the page is about the plan, and has what there is
    return AnsweredScene(subject.surface, subject.decomposition, tuple(answers))
