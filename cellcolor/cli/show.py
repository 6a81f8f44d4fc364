"""``cellcolor show``: pictures of surfaces, graphs, solutions and the arm."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.exits import Exit
from cellcolor.cli.extras import extras_for
from cellcolor.cli.inputs import instance_of, is_scene, read_graph
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.terminal import say
from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.files.writing import HTML, PNG, SVG, Output, check_output, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from cellcolor.frontend import BuildResult
    from cellcolor.pictures.picture import Picture2D, Picture3D

_KINDS = {".html": HTML, ".png": PNG, ".svg": SVG}


@dataclass(frozen=True, slots=True)
class View:
    """What the command line asked to see; at most one of the first four.

    Attributes:
        color: the domain of this color, by name or number.
        reason: why vertices are out of reach.
        graph: the topological graph.
        vertex: the arm on this vertex.
        branch: of the arm, or of the reasons.
    """

    color: str | None
    reason: bool
    graph: bool
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

    def graph(self) -> Instance:
        """The topological graph."""
        if self.instance is not None:
            return self.instance
        return instance_of(self.mesh(), self.path)

    def mesh(self) -> LabelledSurface:
        """The labelled surface.

        Raises:
            InputError: there is none.
        """
        if self.surface is None:
            message = "is missing: without a surface only --graph can be shown"
            raise InputError(str(self.path), "surface", message)
        return self.surface


def show_files(files: tuple[Path, ...], output: Path, view: View) -> Exit:
    """Draw one picture."""
    kind = _KINDS.get(output.suffix)
    if kind is None:
        raise InputError(str(output), None, "must end in .html, .png or .svg")
    check_output(output, kind, files)
    with extras_for(files[0]):
        subject = _read(files[0])
    with extras_for(output):
        picture = _picture(subject, files[1] if len(files) > 1 else None, view)
        if output.suffix == ".html":
            from cellcolor.pictures import interactive

            content = interactive.render(picture)
        else:
            from cellcolor.pictures import static

            content = static.render(picture, output.suffix[1:])
    INTERRUPTS.check()
    write([Output(output, kind, [content])], files)
    say(f"wrote {output}: {picture.title}")
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


def _picture(subject: _Subject, claim: Path | None, view: View) -> Picture2D | Picture3D:
    from cellcolor.pictures import by_cell_and_color as paintings
    from cellcolor.pictures.mesh_picture import draw_surface

    if view.graph:
        return _graph(subject)
    if view.vertex is not None:
        return _arm(subject, view.vertex, view.branch or "")
    surface = subject.mesh()
    if view.color is not None:
        color = _number(surface.colors, view.color, subject.surface_path, "colors")
        return draw_surface(surface, paintings.by_color(surface, color))
    if view.reason:
        return _reasons(subject, view.branch)
    if claim is not None:
        return _solution(subject, claim)
    instance = subject.graph()
    return draw_surface(surface, paintings.by_cell(surface, instance, _cells(instance)))


def _number(names: tuple[str, ...], asked: str, path: Path, field: str) -> int:
    """The number of something given by name or by number."""
    if asked in names:
        return names.index(asked)
    if asked.isdecimal() and int(asked) < len(names):
        return int(asked)
    known = ", ".join(f"{number} {name!r}" for number, name in enumerate(names)) or "none"
    raise InputError(str(path), field, f"no {asked!r} among {known}")


def _cells(instance: Instance) -> NDArray[np.int64]:
    """The cell of each vertex of the instance's surface, which it has."""
    import numpy as np

    assert instance.surface is not None
    return np.array(instance.surface.vertex_cell, dtype=np.int64)


def _graph(subject: _Subject) -> Picture2D:
    from cellcolor.pictures.topological_graph import draw_graph, places_on

    instance = subject.graph()
    if subject.surface is None:
        return draw_graph(instance)
    cells = _cells(instance)
    return draw_graph(instance, places_on(subject.surface, cells, len(instance.cells)))


def _solution(subject: _Subject, claim: Path) -> Picture3D:
    from cellcolor.checker.division import check_solution
    from cellcolor.data.solution import Solution
    from cellcolor.pictures.by_segment import by_solution
    from cellcolor.pictures.mesh_picture import draw_surface

    instance, surface = subject.graph(), subject.mesh()
    solution = Solution.read(claim)
    problems = check_solution(instance, solution).problems
    if problems:
        raise InputError(str(claim), None, f"no valid solution of {subject.path}: {problems[0]}")
    if solution.cells is None:
        raise InputError(str(claim), "cells", "no division was found")
    return draw_surface(surface, by_solution(surface, instance, _cells(instance), solution))


def _reasons(subject: _Subject, branch: str | None) -> Picture3D:
    from cellcolor.pictures.by_reason import CandidateReasons, by_reason, read_candidate_reasons
    from cellcolor.pictures.mesh_picture import draw_surface

    surface = subject.mesh()
    if subject.result is None:
        verdicts = read_candidate_reasons(surface, subject.surface_path)
    else:
        from cellcolor.frontend import Reason

        result = subject.result
        names = tuple(reason.text for reason in Reason)
        verdicts = CandidateReasons(result.branches, names, result.reasons, result.node_color)
    if branch is None:
        return draw_surface(surface, by_reason(surface, verdicts))
    number = _number(verdicts.branches, branch, subject.path, "--branch")
    return draw_surface(surface, by_reason(surface, verdicts, number))


def _arm(subject: _Subject, vertex: int, branch: str) -> Picture3D:
    if subject.result is None:
        raise InputError(str(subject.path), "format", "the arm is in a scene (.toml)")
    from cellcolor.frontend import Reason
    from cellcolor.pictures.arm import arm_at

    result = subject.result
    count = len(result.surface.vertices)
    if vertex >= count:
        raise InputError(str(subject.path), "--vertex", f"{vertex} is not among 0 to {count - 1}")
    number = _number(result.branches, branch, subject.path, "--branch")
    reasons = [Reason(code) for code in result.reasons[vertex]]
    if reasons[number] != Reason.VALID:
        valid = [n for n, r in zip(result.branches, reasons, strict=True) if r == Reason.VALID]
        message = (
            f"{result.branches[number]!r} is not valid on vertex {vertex}: "
            f"{reasons[number].text}; valid there: {', '.join(valid) or 'none'}"
        )
        raise InputError(str(subject.path), "--branch", message)
    return arm_at(subject.path, result, vertex, number)
