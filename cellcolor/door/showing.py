"""``cellcolor.show``: pictures of surfaces, graphs, solutions and the arm."""

from __future__ import annotations

from os import PathLike

from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.door.drawing import Drawing, View, draw, kind_of_picture, picture_of
from cellcolor.door.result import Result
from cellcolor.door.subject import Solvable, Subject, open_subject
from cellcolor.errors import InputError
from cellcolor.files.paths import path_of


def show(
    source: Solvable | Result,
    path: str | PathLike[str] | None = None,
    *,
    view: str | None = None,
    solution: Solution | Result | str | PathLike[str] | None = None,
    color: str | int | None = None,
    vertex: int | None = None,
    branch: str | int | None = None,
    plan: Plan | str | PathLike[str] | None = None,
) -> Drawing:
    """Draw a scene, a labelled surface, an instance or a result.

    A surface is drawn by cell and a result by segment, unless an option asks for something else;
    an instance is drawn on the surface that it names, and without one as a graph. Needs the extra
    ``viz``.

    Args:
        source: what to draw: its file, its shipped name, or the value.
        path: a file .html, .png or .svg; None draws without writing, for notebooks.
        view: the picture: ``cells``, ``color``, ``graph``, ``plan``, ``reasons`` (why points
            are out of reach), ``segments``, ``why`` (fewer are not enough) or ``arm``; None for
            what the options below ask for.
        solution: by segment, in this solution, result or file of one.
        color: where one color is available, by its name or number.
        vertex: the arm on this vertex, in one ``branch``.
        branch: an inverse-kinematic branch, by its name or number.
        plan: by segment, in this plan of another planner or the file of one.

    Raises:
        InputError: there is nothing of that kind to be seen, or the file cannot be written.
    """
    if path is not None:
        kind_of_picture(path_of(path))
    if isinstance(solution, Result):
        solution = solution.solution
    subject = source.subject if isinstance(source, Result) else open_subject(source)
    if view is None:
        asked = {"color": color, "arm": vertex, "segments": solution, "plan": plan}
        names = [name for name, given in asked.items() if given is not None]
        if len(names) > 1:
            raise InputError(None, None, "one of color, vertex, solution and plan at a time")
        view = names[0] if names else _usual_view(source, subject)
    if view in ("segments", "why") and solution is None and isinstance(source, Result):
        solution = source.solution
    seen = View(view, solution, color, vertex, branch, plan)
    drawing = draw(picture_of(seen), subject, seen)
    if path is not None:
        drawing.save(path)
    return drawing


def _usual_view(source: Solvable | Result, subject: Subject) -> str:
    """What says most of what can be drawn."""
    if not subject.names_surface:
        return "graph"
    found = isinstance(source, Result) and source.solution.cells is not None
    return "segments" if found else "cells"
