"""Whatever can be solved, checked or shown, opened once with all that follows; and its result."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, Union

from cellcolor.arrays import Mask
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.value import Drawn, read_one_of
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import Decomposition, decomposition_of, locate
from cellcolor.decomposition.on_mesh import wrong_cell
from cellcolor.door.installed import extras_for, find_file
from cellcolor.errors import InputError, naming, refuse
from cellcolor.files.writing import Output, path_of, write
from cellcolor.questions.places import Place, chosen

if TYPE_CHECKING:
    from cellcolor.frontend import BuildResult, Scene

Solvable: TypeAlias = Union[
    str, "PathLike[str]", "Scene", "BuildResult", LabelledSurface, Instance, "Subject"
]
"""A scene, a labelled surface or an instance: its file, its shipped name, or the value."""


@dataclass(unsafe_hash=True)
class Subject:
    """A scene, a labelled surface or an instance, opened.

    Attributes:
        path: the file, None for a value.
        built: what the front end made of a scene; None for anything else.
        given_surface: the labelled surface that was given, read or built.
        given_instance: the instance that was given or read.
    """

    path: Path | None
    built: BuildResult | None = None
    given_surface: LabelledSurface | None = None
    given_instance: Instance | None = None
    _decomposed: Decomposition | None = field(default=None, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.built is not None and self.given_surface is None:
            self.given_surface = self.built.surface

    @property
    def warnings(self) -> tuple[str, ...]:
        """Likely mistakes in a scene, one sentence each."""
        return () if self.built is None else self.built.report.warnings

    def graph(self, deadline: Deadline = NEVER) -> Instance:
        """The instance; an instance from a file refers to the surface as if it lay beside the file.

        Raises:
            InputError: the surface cannot be decomposed.
        """
        if self.given_instance is not None:
            return self.given_instance
        if self._decomposed is None:
            name = None if self.path is None else self.path.name
            if self.built is not None and self.path is not None:
                name = f"{self.path.stem}.surface.json"
            with naming(self.path):
                self._decomposed = decomposition_of(self.surface, name, deadline)
        return self._decomposed.instance

    @property
    def decomposition(self) -> Decomposition:
        """The graph on the surface.

        Raises:
            InputError: there is no surface, or it cannot be decomposed.
        """
        surface, instance = self.surface, self.graph()
        if self._decomposed is None:  # of an instance
            assert instance.surface is not None
            self._decomposed = locate(surface, instance, instance.surface.vertex_cell)
        return self._decomposed

    @cached_property
    def reasons(self) -> CandidateTable:
        """The fate of the candidates of a scene, or of the scene that the surface was built from.

        Raises:
            InputError: it is a value that no front end has built, or there is no file of them.
        """
        if self.built is not None:
            return self.built.candidates
        if self.surface_path is None:
            raise InputError(None, "reasons", "are known only for a scene, or for a surface's file")
        return CandidateTable.beside(self.surface, self.surface_path)

    def build(self) -> BuildResult:
        """What the front end found.

        Raises:
            InputError: this is no scene.
        """
        if self.built is None:
            raise InputError(self.path, "format", "only a scene (.toml) has an arm")
        return self.built

    @cached_property
    def surface(self) -> LabelledSurface:
        """The labelled surface; that of an instance is read from the file that it names.

        Raises:
            InputError: there is none, or it is not the one the instance was made of.
        """
        if self.given_surface is not None:
            return self.given_surface
        with naming(self.path):
            if self.surface_path is None or not self.names_surface:
                raise InputError(None, "surface", self.why_no_surface)
            surface = LabelledSurface.read(self.surface_path)
            refuse(self._faults_of(surface))
        return surface

    @property
    def surface_path(self) -> Path | None:
        """The file that the surface is in; the scene for a scene."""
        reference = None if self.given_instance is None else self.given_instance.surface
        if self.path is None or reference is None:
            return self.path
        return self.path.parent / reference.path

    @property
    def names_surface(self) -> bool:
        """Whether there is a surface, or the name of a file that should have it."""
        if self.given_instance is None:
            return True
        return self.path is not None and self.given_instance.surface is not None

    @property
    def why_no_surface(self) -> str:
        """What is wrong with its field ``surface`` where :attr:`names_surface` is false."""
        reference = None if self.given_instance is None else self.given_instance.surface
        if reference is None:
            return "is missing: this is a graph without a surface"
        return (
            f"lies in {reference.path!r} beside the instance's file, and a value read from there "
            "does not know where that is: give the file, or the surface"
        )

    def left_alone(self, place: Place | None) -> Subject:
        """Without colors in a place; None leaves it as it is.

        Raises:
            InputError: the place is of another mesh, or there is no surface.
        """
        if place is None:
            return self
        return self.without_vertices(chosen(self.surface, place, "left_alone"))

    def without_vertices(self, mask: Mask) -> Subject:
        """Without colors at some vertices (n,) of the surface."""
        if self.built is not None:
            return Subject(self.path, self.built.without(mask))
        return Subject(None, given_surface=self.surface.without_vertices(mask))

    def check_graph(self, deadline: Deadline = NEVER) -> str | None:
        """Compare an instance that names its surface with that surface, if it is available.

        Returns:
            The path of a surface that is not available, so the graph is trusted.

        Raises:
            InputError: the surface cannot be used, or has another graph.
        """
        instance = self.given_instance
        if instance is None or instance.surface is None:
            return None
        reference = instance.surface
        file = self.surface_path
        if self.path is None or file is None or not file.is_file():
            return reference.path
        wrong = wrong_cell(self.surface, instance, reference.vertex_cell, deadline)
        if wrong is not None:
            what = f"not those on the surface {reference.path}, in the part with cell {wrong}"
            raise InputError(self.path, "edges", what)
        return None

    def _faults_of(self, surface: LabelledSurface) -> Iterator[tuple[str, str]]:
        """Why a surface is not the one that the instance was made of."""
        instance = self.given_instance
        assert instance is not None
        assert instance.surface is not None
        path, cells = instance.surface.path, instance.surface.vertex_cell
        if instance.surface.sha256 not in (None, surface.sha256):
            yield "surface.sha256", f"{path} is not the surface that this instance was built from"
        if instance.colors != surface.colors or len(cells) != len(surface.vertices):
            yield "surface.path", "the surface has other colors or vertices"
        for vertex, cell in enumerate(cells):
            own = () if cell == OUTSIDE else tuple(sorted(instance.cells[cell].colors))
            if own != surface.vertex_colors[vertex]:
                yield f"surface.vertex_cell[{vertex}]", "the surface has other colors there"


def open_subject(
    source: Solvable, deadline: Deadline = NEVER, progress: Callable[[str], None] | None = None
) -> Subject:
    """Read what is to be solved, checked or shown; build it if it is a scene.

    Args:
        source: a scene, a labelled surface or an instance: its file, its shipped name, the value.
        deadline: when a build has to end.
        progress: told the name of each stage of a build as it begins.

    Raises:
        InputError: it cannot be used; names the file and what is wrong with it.
        OutOfTime: the deadline came before there was a surface.
    """
    if isinstance(source, Subject):
        return source
    if isinstance(source, Instance):
        return Subject(None, given_instance=source)
    if isinstance(source, LabelledSurface):
        return Subject(None, given_surface=source)
    if _is_made_by(source, "cellcolor.frontend.build", "BuildResult"):
        return Subject(None, source)  # type: ignore[arg-type]
    path = None
    if not _is_made_by(source, "cellcolor.frontend.scene", "Scene"):
        if not isinstance(source, (str, PathLike)):
            kinds = "a scene, a surface, an instance or a file of one"
            raise InputError(None, None, f"must be {kinds}, is {source!r:.100}")
        path = find_file(source)
        if path.suffix.lower() in _MESHES and path.is_file():
            message = "is a mesh, which has no colors: cellcolor new makes a scene of it and an arm"
            raise InputError(path, None, message)
        if not is_scene(path):
            found: Instance | LabelledSurface = read_one_of(path, (Instance, LabelledSurface))
            if isinstance(found, Instance):
                return Subject(path, given_instance=found)
            return Subject(path, given_surface=found)
    scene = scene_of(path or source)  # type: ignore[arg-type]
    from cellcolor.frontend import build_surface

    return Subject(path, build_surface(scene, deadline, progress))


_MESHES = (".stl", ".obj", ".ply")


def _is_made_by(value: object, module: str, name: str) -> bool:
    """Whether a value is of a class, without importing the class: any value has imported it."""
    kind = getattr(sys.modules.get(module), name, None)
    return isinstance(kind, type) and isinstance(value, kind)


def is_scene(path: Path) -> bool:
    """The suffix identifies scenes, ``format`` everything else."""
    return path.suffix == ".toml"


def scene_of(scene: str | PathLike[str] | Scene) -> Scene:
    """A scene: its file, its shipped name, or the value.

    Raises:
        InputError: there is no such file, it cannot be used, or the front end is not installed.
    """
    if _is_made_by(scene, "cellcolor.frontend.scene", "Scene"):
        return scene  # type: ignore[return-value]
    path = find_file(scene)  # type: ignore[arg-type]
    if not is_scene(path):
        raise InputError(path, None, "is no scene: a scene is a file .toml")
    with extras_for(path):
        from cellcolor.frontend import Scene as SceneValue
    return SceneValue.read(path)


@dataclass(frozen=True, repr=False)
class Result(Drawn):
    """The fewest segments that were found, and what is proved about them.

    Attributes:
        solution: the solver's answer, which the checker has passed.
        subject: what was solved, opened.
        covered_share: what was solved, as a share of the area that can be covered and is not left
            alone, 0 to 1.
    """

    solution: Solution
    subject: Subject = field(hash=False)
    covered_share: float = 1.0

    @property
    def instance(self) -> Instance:
        """The topological graph that was solved."""
        return self.subject.graph()

    @property
    def surface(self) -> LabelledSurface | None:
        """The labelled surface; None for an instance without one.

        Raises:
            InputError: the file that the instance names cannot be read, or is another surface.
        """
        return self.subject.surface if self.subject.names_surface else None

    @property
    def segments(self) -> int | None:
        """How many there are; None when no division was found."""
        return self.solution.segments

    @property
    def lift_offs(self) -> int | None:
        """``max(0, segments - 1)``; None when no division was found."""
        return self.solution.lift_offs

    @property
    def optimal(self) -> bool:
        """Proved to be the fewest in the search space."""
        return self.solution.status == "optimal"

    def save(self, path: str | PathLike[str]) -> None:
        """Write the solution to a file; only an older solution is overwritten.

        Raises:
            InputError: there is something else, or it cannot be written.
        """
        write([Output.of(path_of(path), self.solution)])

    def __str__(self) -> str:
        return self.solution.in_words(self.instance)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.instance.name!r}: {self}>"


def solution_of(claim: Solution | Result | str | PathLike[str]) -> Solution:
    """The solution that is given: by itself, in a result, or in a file.

    Raises:
        InputError: the file cannot be used.
    """
    if isinstance(claim, Result):
        return claim.solution
    return claim if isinstance(claim, Solution) else Solution.read(claim)
