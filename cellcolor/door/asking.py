"""``cellcolor.tradeoff``, ``explain`` and ``place``: what saves a lift-off."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any, Unpack

from cellcolor.deadline import Deadline
from cellcolor.door.asked import SearchAndTell, Work, begun, options_of
from cellcolor.door.drawing import kind_of_picture
from cellcolor.door.installed import extras_for
from cellcolor.door.subject import Solvable, open_subject, scene_of
from cellcolor.errors import CellcolorError, InputError
from cellcolor.files.writing import Output, path_of, write
from cellcolor.processes import Task, as_they_end
from cellcolor.questions.answers import Front
from cellcolor.questions.placements import PlacedMinimum, PlacementQuestion, Placements, Pose
from cellcolor.questions.places import Place

if TYPE_CHECKING:
    from cellcolor.frontend import Scene
    from cellcolor.questions.answers import Explanation


def tradeoff(
    source: Solvable,
    *,
    left_alone: Place | None = None,
    **search: Unpack[SearchAndTell],
) -> Front:
    """Find the largest share of area that each number of lift-offs can cover, with proof.

    Args:
        source: a scene, a labelled surface or an instance: its file, its shipped name, the value.
        left_alone: vertices that must not be covered: a mask (n,), a
            :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface gives up.
        **search: :class:`~cellcolor.door.asked.SearchAndTell`.

    Returns:
        The front. Shares are of the area that can be covered and is not left alone.

    Raises:
        InputError: the source cannot be used, or has no surface for a place to be on; or a mask is
            of another mesh.
        OutOfTime: the time limit came before any division was found.
    """
    options, progress = options_of(search), search.get("progress")
    subject = open_subject(source, options.deadline, progress).left_alone(left_alone)
    from cellcolor.questions.tradeoff import front_of  # imports a solver

    return front_of(subject.graph(options.deadline), options, progress)


def explain(
    scene: str | PathLike[str] | Scene,
    **search: Unpack[SearchAndTell],
) -> Explanation:
    """Find what costs a lift-off: the minimum with each limit, obstacle and test relaxed, proved.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        **search: :class:`~cellcolor.door.asked.SearchAndTell`.

    Returns:
        Rows, ranked.

    Raises:
        InputError: the scene cannot be used.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    options = options_of(search)
    own = scene_of(scene)
    from cellcolor.frontend.prepared import prepare
    from cellcolor.questions.explaining import explained

    return explained(prepare(own, options.deadline), options, search.get("progress"))


_BATCH = 32  # placements per task; reading the scene takes as long as one or two of them
_ATTEMPTS = 2  # how often a task is tried whose process was lost
_ENDING = 10.0  # s that a process may take beyond its time
_ALL_DAY = 86_400.0  # s, the limit of a process if there is no time limit


def place(
    scene: str | PathLike[str] | Scene,
    *,
    jobs: int = 1,
    **question: Any,
) -> Placements:
    """Look for placements of a scene's part that need fewer lift-offs, and prove the best ones.

    Needs the extra ``frontend``. The result is the same with any number of jobs.

    Args:
        scene: its file, its shipped name, or the value.
        jobs: processes at a time.
        x, y, z: from where to where the part may be moved, m; None for where it is.
        roll, pitch, yaw: the same of its angles, rad (extrinsic x, y, z).
        **question: whatever else :class:`~cellcolor.questions.placements.PlacementQuestion` and
            :class:`~cellcolor.door.asked.Work` have.

    Raises:
        InputError: the scene cannot be used; or a range, a share or a number is none.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    work: Any = {name: question.pop(name) for name in Work.__annotations__ if name in question}
    deadline, report = begun(work)
    own, asked = scene_of(scene), PlacementQuestion.of(**question)
    if jobs < 1:
        raise InputError(None, "jobs", f"must be 1 or more, is {jobs}")
    from cellcolor.questions.searching_places import search_places

    minima = partial(_minima, jobs, asked, deadline)
    return search_places(own, asked, minima, deadline, report)


def _minima(
    jobs: int,
    question: PlacementQuestion,
    deadline: Deadline,
    scene: Scene,
    poses: Sequence[Pose],
    cover: float | None,
) -> Iterator[list[PlacedMinimum]]:
    """The minima of placements in the order in which they are done, some at a time.

    Args:
        jobs: processes at a time; this one does what there is one of.
        cover: as of :data:`~cellcolor.questions.searching_places.Minima`.

    Raises:
        CellcolorError: a task failed, or its process was lost in every attempt.
    """
    from cellcolor.questions.placing import minima_at

    how = 1, question.seed, question.base, cover
    size = min(_BATCH, -(-len(poses) // jobs) or 1)
    lost = [poses[at : at + size] for at in range(0, len(poses), size)]
    if 1 in (jobs, len(poses)):
        for part in lost:
            yield minima_at(scene, part, deadline.left, *how)
        return
    for attempt in range(1, _ATTEMPTS + 1):
        left = deadline.left
        most = min(left, _ALL_DAY) + _ENDING
        tasks = [(part, Task(minima_at, (scene, part, left, *how), most)) for part in lost]
        lost = []
        for part, ended in as_they_end(jobs, tasks):
            if ended.end in ("done", "timeout", "stopped"):
                yield ended.value or []
            elif ended.end == "failed" or attempt == _ATTEMPTS:
                raise CellcolorError(f"placements could not be tried: {ended.error}")
            else:  # the process was lost; the work is repeated
                lost.append(part)


def save_map(found: Placements, path: str | PathLike[str]) -> None:
    """Draw the placements that :func:`place` tried to a file .png or .svg. Needs the extra ``viz``.

    Raises:
        InputError: another suffix, only one placement was tried, the file is no picture of
            cellcolor's, or it cannot be written.
    """
    file = path_of(path)
    kind = kind_of_picture(file, flat=True)
    with extras_for(f"a picture {file.suffix}"):
        from cellcolor.pictures.static import render_placements

        write([Output(file, kind, [render_placements(found, file.suffix[1:])])])
