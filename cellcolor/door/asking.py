"""``cellcolor.tradeoff``, ``explain`` and ``place``: what saves a lift-off."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Any, Unpack

from cellcolor.door.asked import SearchAndTell, Work, begun, options_of
from cellcolor.door.drawing import kind_of_picture
from cellcolor.door.installed import extras_for
from cellcolor.door.subject import Solvable, open_subject, scene_of
from cellcolor.errors import InputError
from cellcolor.files.writing import Output, path_of, write
from cellcolor.questions.answers import Front
from cellcolor.questions.placements import PlacementQuestion, Placements
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

    return search_places(own, asked, jobs, deadline, report)


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
