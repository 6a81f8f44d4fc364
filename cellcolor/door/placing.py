"""``cellcolor.place``: where a part should stand."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any

from cellcolor.door.asked import Work, begun
from cellcolor.door.drawing import save_plot
from cellcolor.door.extras import extras_for
from cellcolor.door.placements_asked import AskedPlacements
from cellcolor.door.subject import scene_or_file
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of
from cellcolor.lab.workers import Workers
from cellcolor.questions.placements import PlacementQuestion, Placements

if TYPE_CHECKING:
    from cellcolor.frontend import Scene


def place(
    scene: str | PathLike[str] | Scene,
    *,
    table: str | PathLike[str] | None = None,
    jobs: int | Workers = 1,
    **question: Any,
) -> Placements:
    """Look for placements of a scene's part that need fewer lift-offs, and prove the best ones.

    Needs the extra ``frontend``. The result is the same with any number of jobs.

    Args:
        scene: its file, its shipped name, or the value.
        table: a CSV file in which each row is kept as it is proved; one that is there is continued,
            and what it has is not asked again.
        jobs: processes at a time, or who does the work.
        **question: the ranges ``x``, ``y``, ``z``, ``roll``, ``pitch`` and ``yaw``, and whatever
            else :class:`~cellcolor.questions.placements.PlacementQuestion` and
            :class:`~cellcolor.door.asked.Work` have.

    Raises:
        InputError: the scene cannot be used; a range, a share or a number is none; or the table is
            damaged or of another scene.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    work: Any = {name: question.pop(name) for name in Work.__annotations__ if name in question}
    deadline, report = begun(work)
    scene = scene_or_file(scene)
    asked = PlacementQuestion.of(**question)
    if isinstance(jobs, int) and jobs < 1:
        raise InputError(None, "jobs", f"must be 1 or more, is {jobs}")
    with extras_for("the front end"):
        from cellcolor.frontend.scene import Scene as SceneValue
        from cellcolor.questions.searching_places import search_places

    own: Scene = scene if isinstance(scene, SceneValue) else SceneValue.read(scene)
    workers: AbstractContextManager[Workers | None] = nullcontext()
    if not isinstance(jobs, int):
        workers = jobs
    elif jobs > 1:
        workers = Workers(jobs)
    file = None if table is None else path_of(table)
    with (
        AskedPlacements(own, file, asked, deadline, report) as placements,
        workers as others,
    ):
        alone, many = partial(placements.minima, None), partial(placements.minima, others)
        return search_places(own, asked, alone, many, deadline, report)


def save_map(found: Placements, path: str | PathLike[str]) -> None:
    """Draw the map of ``place(..., tiles=…)`` to a file .png or .svg.

    Raises:
        InputError: no map was asked for; or as of :func:`~cellcolor.door.drawing.save_plot`.
    """
    tiled = found.map
    if tiled is None:
        raise InputError(None, "tiles", "no map was asked for")

    def render(form: str) -> bytes:
        from cellcolor.pictures.plots import render_map

        return render_map(found.name, tiled, found.here, found.best, form)

    save_plot(path, render)
