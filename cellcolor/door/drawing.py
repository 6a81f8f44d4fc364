"""``cellcolor.show``: pictures of any subject, what they are drawn from, and their files."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from numbers import Integral
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cellcolor.checker.division import check_solution
from cellcolor.checker.groups import regions_on_surface
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.door.installed import extras_for
from cellcolor.door.subject import Result, Solvable, Subject, open_subject, solution_of
from cellcolor.errors import InputError, naming
from cellcolor.files.writing import HTML, PNG, SVG, FileKind, Output, path_of, write
from cellcolor.pictures.picture import Picture2D, Picture3D
from cellcolor.pictures.registry import Picture, make_picture

if TYPE_CHECKING:
    from cellcolor.checker.certificates import BoundVerdict

_OPTIONS = ("color", "vertex", "branch", "solution", "plan", "marked")
_PICTURE_OF = {"color": "color", "vertex": "arm", "solution": "segments", "plan": "plan"}
"""What is drawn if one of these options is given."""
_OF_RESULTS = ("segments", "why")
"""The pictures that a result has a solution for."""
_KINDS = {".html": HTML, ".png": PNG, ".svg": SVG}


@dataclass(frozen=True, repr=False, eq=False)
class Drawing:
    """A picture that has not been saved yet; a notebook displays it, to be turned by the mouse.

    Attributes:
        picture: its contents.
    """

    picture: Picture2D | Picture3D

    def render(self, suffix: str) -> bytes:
        """The contents of a file with the suffix ``.html``, ``.png`` or ``.svg``.

        Raises:
            InputError: the extra ``viz`` is not installed; a page of a surface does not need it.
        """
        with extras_for(f"a picture {suffix}"):
            if suffix == ".html":
                from cellcolor.pictures.viewer import page

                return page.render(self.picture)
            from cellcolor.pictures import static

            return static.render(self.picture, suffix[1:])

    def save(self, path: str | PathLike[str]) -> None:
        """Write it to a file .html, .png or .svg; only an older picture is overwritten.

        Raises:
            InputError: another suffix, the file is no picture of cellcolor's, or it cannot be
                written.
        """
        place = path_of(path)
        kind = kind_of_picture(place)
        write([Output(place, kind, [self.render(place.suffix)])])

    def __str__(self) -> str:
        return self.picture.title

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.picture.title!r}>"

    def _repr_html_(self) -> str:
        page = html.escape(self.render(".html").decode(), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="600" frameborder="0"></iframe>'


def kind_of_picture(path: Path, *, flat: bool = False) -> FileKind:
    """The kind of file for a picture, or for one that is ``flat`` and has no page.

    Raises:
        InputError: no picture has this suffix.
    """
    kind = None if flat and path.suffix == ".html" else _KINDS.get(path.suffix)
    if kind is None:
        message = f"must end in {'' if flat else '.html, '}.png or .svg"
        raise InputError(path, None, message)
    return kind


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
    marked: Sequence[int] | None = None,
) -> Drawing:
    """Draw a scene, a labelled surface, an instance or a result.

    A surface is drawn by cell and a result by segment, unless an option asks for something else;
    an instance is drawn on the surface that it names, and without one as a graph. All but pages in
    space need the extra ``viz``.

    Args:
        source: what to draw: its file, its shipped name, or the value.
        path: a file .html, .png or .svg; None draws without writing, for notebooks.
        view: the picture: ``cells``, ``color``, ``graph``, ``plan``, ``reasons`` (why points
            are out of reach), ``segments``, ``why`` (fewer are not enough) or ``arm``; None for
            what the options below ask for.
        solution: draws the segments of this solution, result or file of one.
        color: draws where this color is available, given by name or number.
        vertex: draws the arm on this vertex, in one ``branch``.
        branch: an inverse-kinematic branch, by name or number.
        plan: draws the segments of this plan of another planner, or of the file of one.
        marked: vertices of this plan to be pointed at; their segments are marked as well.

    Raises:
        InputError: the source has no such picture, or the file cannot be written.
    """
    if path is not None:
        kind_of_picture(path_of(path))
    result = source if isinstance(source, Result) else None
    subject = source.subject if isinstance(source, Result) else open_subject(source)
    usual = "graph"
    if subject.names_surface:
        usual = "segments" if result is not None and result.solution.cells is not None else "cells"
    given = (color, vertex, branch, solution, plan, marked)
    options: dict[str, Any] = dict(zip(_OPTIONS, given, strict=True))
    asked = view is not None or any(options[name] is not None for name in _PICTURE_OF)
    if result is not None and solution is None and (view if asked else usual) in _OF_RESULTS:
        options["solution"] = result.solution
    drawing = draw(picture_of(view, usual, options), subject, options)
    if path is not None:
        drawing.save(path)
    return drawing


def picture_of(name: str | None, usual: str, options: Mapping[str, Any]) -> Picture:
    """The picture that is asked for, after checking its options.

    Args:
        name: of the picture; None for the one that an option asks for.
        usual: the picture if none does.
        options: of :func:`show`, None where one is not given.

    Raises:
        InputError: options ask for several pictures; there is no such picture, it needs another
            option, or it does not take one.
    """
    if name is None:
        names = [own for part, own in _PICTURE_OF.items() if options.get(part) is not None]
        if len(names) > 1:
            raise InputError(None, None, "one of color, vertex, solution and plan at a time")
        name = names[0] if names else usual
    picture = make_picture(name)
    for part in _OPTIONS:
        given = options.get(part)
        if given is None and part in picture.needs:
            raise InputError(None, part, f"the picture {name} needs it")
        if given is not None and part not in picture.needs + picture.takes:
            raise InputError(None, part, f"the picture {name} does not take it")
    return picture


def draw(picture: Picture, subject: Subject, options: Mapping[str, Any]) -> Drawing:
    """Draw a picture from the inputs that it declares (``needs`` and ``takes``).

    Args:
        picture: see :func:`picture_of`.
        subject: the source of the inputs; they are made only if the picture uses them.
        options: those that the picture was chosen by.

    Raises:
        InputError: an input is missing, or the inputs cannot be drawn together.
    """
    given: dict[str, Any] = {**dict.fromkeys(_OPTIONS), **options}
    file = subject.path

    def vertex(asked: object, field: str) -> int:
        count = len(subject.surface.vertices)
        if isinstance(asked, Integral) and 0 <= int(asked) < count:
            return int(asked)
        raise InputError(file, field, f"{asked!r} is not among 0 to {count - 1}")

    def color() -> int:
        return _number(subject.surface.colors, given["color"], subject.surface_path, "colors")

    def plan() -> Plan:
        return given["plan"] if isinstance(given["plan"], Plan) else Plan.read(given["plan"])

    @cache
    def checked() -> tuple[Solution, tuple[BoundVerdict, ...]]:
        return _checked(subject, given["solution"])

    make: dict[str, Callable[[], object]] = {
        "build": subject.build,
        "surface": lambda: subject.surface,
        "graph": subject.graph,
        "decomposition": lambda: subject.decomposition,
        "solution": lambda: checked()[0],
        "verdicts": lambda: checked()[1],
        "plan": plan,
        "reasons": lambda: subject.reasons,
        "color": color,
        "vertex": lambda: vertex(given["vertex"], "vertex"),
        "marked": lambda: tuple(vertex(asked, "marked") for asked in given["marked"]),
        "branch": lambda: _number(subject.reasons.branches, given["branch"], file, "branch"),
    }
    if "surface" in picture.needs and not subject.names_surface:
        message = f"{subject.why_no_surface}; only the graph can be shown (--view graph)"
        raise InputError(file, "surface", message)
    used = (*picture.needs, *(part for part in picture.takes if given[part] is not None))
    parts = {part: make[part]() for part in make if part in used}
    with naming(file):
        return Drawing(picture.draw(**parts))


def _number(names: tuple[str, ...], asked: str | int | None, file: Path | None, field: str) -> int:
    """The number of an item that was asked for by name or by number."""
    if asked in names:
        return names.index(str(asked))
    if str(asked).isdecimal() and int(str(asked)) < len(names):
        return int(str(asked))
    known = ", ".join(f"{number} {name!r}" for number, name in enumerate(names)) or "none"
    raise InputError(file, field, f"no {asked!r} among {known}")


def _checked(
    subject: Subject, claim: Solution | Result | str | PathLike[str]
) -> tuple[Solution, tuple[BoundVerdict, ...]]:
    """A valid solution of the surface with a division, and the checker's verdicts on its bounds."""
    file = str(claim) if isinstance(claim, (str, PathLike)) else None
    solution = solution_of(claim)
    instance = subject.graph()
    regions = regions_on_surface(subject.surface, subject.decomposition.vertex_cell)
    report = check_solution(instance, solution, regions)
    if report.problems:
        message = f"no valid solution of {subject.path or instance.name}: {report.problems[0]}"
        raise InputError(file, None, message)
    if solution.cells is None:
        raise InputError(file, "cells", "no division was found")
    return solution, report.bounds
