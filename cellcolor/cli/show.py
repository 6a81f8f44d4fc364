"""``cellcolor show``: pictures of surfaces, graphs, solutions and the arm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellcolor.cli.exits import Exit
from cellcolor.cli.extras import extras_for
from cellcolor.cli.inputs import is_scene, read_graph
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.terminal import say
from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition, decomposition_of, locate
from cellcolor.errors import InputError
from cellcolor.files.writing import HTML, PNG, SVG, Output, check_output, write
from cellcolor.pictures.interface import Given
from cellcolor.pictures.registry import make_picture

if TYPE_CHECKING:
    from cellcolor.data.solution import Solution
    from cellcolor.frontend import BuildResult
    from cellcolor.pictures.by_reason import CandidateReasons
    from cellcolor.pictures.interface import Drawn, Part, Picture

_KINDS = {".html": HTML, ".png": PNG, ".svg": SVG}


@dataclass(frozen=True, slots=True)
class View:
    """What the command line asked to see.

    Attributes:
        picture: its name.
        color: of a domain, by name or number.
        vertex: that the arm is on.
        branch: of the arm, or of the reasons, by name or number.
    """

    picture: str
    color: str | None
    vertex: int | None
    branch: str | None


@dataclass(frozen=True)
class _Subject:
    """The first file: what it is, with all that leads to it or follows from it.

    Attributes:
        path: the file.
        surface: the labelled surface; None for an instance that names none.
        surface_path: the file it is in; the scene for a scene.
        instance: an instance that was read; None for what ``build`` would have to make one of.
        result: of a scene, what the front end found.
    """

    path: Path
    surface: LabelledSurface | None
    surface_path: Path
    instance: Instance | None = None
    result: BuildResult | None = None

    def mesh(self) -> LabelledSurface:
        """The labelled surface.

        Raises:
            InputError: there is none.
        """
        if self.surface is None:
            message = "is missing: without a surface only --graph can be shown"
            raise InputError(str(self.path), "surface", message)
        return self.surface

    @cached_property
    def decomposition(self) -> Decomposition:
        """The topological graph on the surface.

        Raises:
            InputError: there is no surface, or it cannot be decomposed.
        """
        surface = self.mesh()
        if self.instance is not None and self.instance.surface is not None:
            return locate(surface, self.instance, self.instance.surface.vertex_cell)
        try:
            return decomposition_of(surface)
        except InputError as error:
            raise error.in_file(str(self.path)) from error

    @cached_property
    def reasons(self) -> CandidateReasons:
        """What became of the candidates of a scene, or of the one that the surface is of."""
        from cellcolor.pictures.by_reason import CandidateReasons, read_candidate_reasons

        if self.result is None:
            return read_candidate_reasons(self.mesh(), self.surface_path)
        from cellcolor.frontend import Reason

        result = self.result
        names = tuple(reason.text for reason in Reason)
        return CandidateReasons(result.branches, names, result.reasons, result.node_color)

    def build(self) -> BuildResult:
        """What the front end found.

        Raises:
            InputError: this is no scene.
        """
        if self.result is None:
            raise InputError(str(self.path), "format", "the arm is in a scene (.toml)")
        return self.result


def show_files(files: tuple[Path, ...], output: Path, view: View) -> Exit:
    """Draw one picture."""
    kind = _KINDS.get(output.suffix)
    if kind is None:
        raise InputError(str(output), None, "must end in .html, .png or .svg")
    check_output(output, kind, files)
    with extras_for(files[0]):
        picture = make_picture(view.picture)
        claim = files[1] if len(files) > 1 else None
        _check_options(picture, view, claim)
        subject = _read(files[0])
    with extras_for(output):
        drawn = _drawn(picture, subject, claim, view)
        if output.suffix == ".html":
            from cellcolor.pictures import interactive

            content = interactive.render(drawn)
        else:
            from cellcolor.pictures import static

            content = static.render(drawn, output.suffix[1:])
    INTERRUPTS.check()
    write([Output(output, kind, [content])], files)
    say(f"wrote {output}: {drawn.title}")
    return Exit.DONE


def _read(path: Path) -> _Subject:
    if is_scene(path):
        from cellcolor.frontend import build_surface

        result = build_surface(path)
        return _Subject(path, result.surface, path, result=result)
    found = read_graph(path)
    if isinstance(found, LabelledSurface):
        return _Subject(path, found, path)
    if found.surface is None:
        return _Subject(path, None, path, found)
    surface_path = path.parent / found.surface.path
    surface = LabelledSurface.read(surface_path)
    _same_surface(path, found, surface)
    return _Subject(path, surface, surface_path, found)


def _same_surface(path: Path, instance: Instance, surface: LabelledSurface) -> None:
    """Refuse a surface that is not the one the instance was made of."""
    assert instance.surface is not None
    cells, fingerprint = instance.surface.vertex_cell, instance.surface.sha256
    if fingerprint is not None and fingerprint != surface.sha256:
        message = f"{instance.surface.path} is not the surface that this instance was built from"
        raise InputError(str(path), "surface.sha256", message)
    if instance.colors != surface.colors or len(cells) != len(surface.vertices):
        raise InputError(str(path), "surface.path", "the surface has other colors or vertices")
    for vertex, cell in enumerate(cells):
        own = () if cell == OUTSIDE else tuple(sorted(instance.cells[cell].colors))
        if own != surface.vertex_colors[vertex]:
            field = f"surface.vertex_cell[{vertex}]"
            raise InputError(str(path), field, "the surface has other colors there")


def _check_options(picture: Picture, view: View, claim: Path | None) -> None:
    """Refuse what the picture does not take, and the lack of what it needs.

    Raises:
        click.UsageError: an option, or the solution, is missing or too much.
    """
    options: dict[Part, tuple[object, str]] = {
        "color": (view.color, "--color"),
        "vertex": (view.vertex, "--vertex"),
        "branch": (view.branch, "--branch"),
        "solution": (claim, "a solution"),
    }
    for part, (given, name) in options.items():
        if given is None and part in picture.needs:
            raise click.UsageError(f"the picture {view.picture} needs {name}")
        if given is not None and part not in picture.needs + picture.takes:
            raise click.UsageError(f"the picture {view.picture} does not take {name}")


def _drawn(picture: Picture, subject: _Subject, claim: Path | None, view: View) -> Drawn:
    """The picture, drawn of the parts that it declares."""

    def vertex() -> int:
        count, asked = len(subject.mesh().vertices), view.vertex or 0
        if asked < count:
            return asked
        raise InputError(str(subject.path), "--vertex", f"{asked} is not among 0 to {count - 1}")

    def color() -> int:
        return _number(subject.mesh().colors, view.color, subject.surface_path, "colors")

    def branch() -> int:
        return _number(subject.reasons.branches, view.branch, subject.path, "--branch")

    make: dict[Part, Callable[[], object]] = {
        "build": subject.build,
        "surface": subject.mesh,
        "graph": lambda: subject.instance or subject.decomposition.instance,
        "decomposition": lambda: subject.decomposition,
        "solution": lambda: _solution(subject, claim),
        "reasons": lambda: subject.reasons,
        "color": color,
        "vertex": vertex,
        "branch": branch,
    }
    missing: set[Part] = set()
    if subject.surface is None:
        missing |= {"surface", "decomposition"}
    if subject.result is None:
        missing.add("build")
    asked: dict[Part, object] = {"color": view.color, "vertex": view.vertex, "branch": view.branch}
    missing |= {part for part, given in (asked | {"solution": claim}).items() if given is None}
    parts = {part: make[part]() for part in make if part in picture.needs}
    parts |= {part: make[part]() for part in picture.takes if part not in missing}
    try:
        return picture.draw(Given(parts))
    except InputError as error:
        raise (error if error.file else error.in_file(str(subject.path))) from error


def _number(names: tuple[str, ...], asked: str | None, path: Path, field: str) -> int:
    """The number of something given by name or by number."""
    if asked in names:
        return names.index(asked)
    if asked is not None and asked.isdecimal() and int(asked) < len(names):
        return int(asked)
    known = ", ".join(f"{number} {name!r}" for number, name in enumerate(names)) or "none"
    raise InputError(str(path), field, f"no {asked!r} among {known}")


def _solution(subject: _Subject, claim: Path | None) -> Solution:
    """The solution in a file, which has a division that is valid for the subject."""
    from cellcolor.checker.division import check_solution
    from cellcolor.data.solution import Solution

    assert claim is not None
    solution = Solution.read(claim)
    problems = check_solution(subject.instance or subject.decomposition.instance, solution).problems
    if problems:
        raise InputError(str(claim), None, f"no valid solution of {subject.path}: {problems[0]}")
    if solution.cells is None:
        raise InputError(str(claim), "cells", "no division was found")
    return solution
