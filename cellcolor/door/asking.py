"""``cellcolor.tradeoff`` and ``explain``: what fewer lift-offs cover, and what costs a lift-off."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, Unpack

import numpy as np

from cellcolor.door.asked import SearchAndTell, options_of
from cellcolor.door.drawing import save_plot
from cellcolor.door.extras import extras_for
from cellcolor.door.leaving_out import front_on
from cellcolor.door.leaving_out import left_alone as without_place
from cellcolor.door.subject import Solvable, open_subject, scene_or_file
from cellcolor.errors import InputError
from cellcolor.questions.front import Front
from cellcolor.questions.places import Place

if TYPE_CHECKING:
    from cellcolor.arrays import Array
    from cellcolor.frontend import Scene
    from cellcolor.questions.explanation import Explanation


def tradeoff(
    source: Solvable,
    *,
    weights: Sequence[float] | Array | None = None,
    required: Place | None = None,
    left_alone: Place | None = None,
    **search: Unpack[SearchAndTell],
) -> Front:
    """Find the largest share of area that each number of lift-offs can cover, with proof.

    Args:
        source: a scene, a labelled surface or an instance: its file, its shipped name, the value.
        weights: of each vertex (n,), as a factor of its area: quality, urgency; None for 1.
        required: vertices that have to be covered: a mask (n,), a
            :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface gives up.
        left_alone: vertices that must not be covered, the same kinds; nothing is asked of them.
        **search: :class:`~cellcolor.door.asked.SearchAndTell`.

    Returns:
        The front. Shares are of the area that can be covered and is not left alone.

    Raises:
        InputError: the source cannot be used, or has no surface for weights and places to be on; a
            mask is of another mesh, or a weight is negative or no number.
        OutOfTime: the time limit came before any division was found.
    """
    options, progress = options_of(search), search.get("progress")
    subject = without_place(open_subject(source, options.deadline, progress), left_alone)
    return front_on(subject, weights, required, options, progress)


def save_front(front: Front, path: str | PathLike[str]) -> None:
    """Draw a front to a file .png or .svg; see :func:`~cellcolor.door.drawing.save_plot`."""

    def render(form: str) -> bytes:
        from cellcolor.pictures.plots import render_front

        return render_front(front, form)

    save_plot(path, render)


def explain(
    scene: str | PathLike[str] | Scene,
    *,
    at: Sequence[float] | None = None,
    **search: Unpack[SearchAndTell],
) -> Explanation:
    """Find what costs a lift-off: the minimum with each limit, obstacle and test relaxed, proved.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        at: (3,) a point in the world, m; the report also says what each branch does at the vertex
            nearest to it.
        **search: :class:`~cellcolor.door.asked.SearchAndTell`.

    Returns:
        Rows, ranked.

    Raises:
        InputError: the scene cannot be used, or the point is none or far from the part.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    options = options_of(search)
    scene = scene_or_file(scene)
    point = None
    if at is not None:
        point = np.asarray(at, dtype=float)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(None, "at", "must be three numbers x, y, z in m")
    with extras_for("the front end"):
        from cellcolor.frontend.prepared import prepare
        from cellcolor.questions.explaining import explained

    return explained(prepare(scene, options.deadline), options, point, search.get("progress"))
