"""``cellcolor.tradeoff`` and ``explain``: what fewer lift-offs cover, and what costs a lift-off."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Unpack

from cellcolor.door.asked import SearchAndTell, options_of
from cellcolor.door.extras import extras_for
from cellcolor.door.leaving_out import left_alone as without_place
from cellcolor.door.subject import Solvable, open_subject, scene_or_file
from cellcolor.questions.front import Front
from cellcolor.questions.places import Place

if TYPE_CHECKING:
    from cellcolor.frontend import Scene
    from cellcolor.questions.explanation import Explanation


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
    subject = without_place(open_subject(source, options.deadline, progress), left_alone)
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
    scene = scene_or_file(scene)
    with extras_for("the front end"):
        from cellcolor.frontend.prepared import prepare
        from cellcolor.questions.explaining import explained

    return explained(prepare(scene, options.deadline), options, search.get("progress"))
