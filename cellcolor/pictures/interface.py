"""What every picture is given, and what it declares that it needs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

from cellcolor.pictures.picture import Picture2D, Picture3D

if TYPE_CHECKING:
    from cellcolor.checker.certificates import BoundVerdict
    from cellcolor.data.candidate_table import CandidateTable
    from cellcolor.data.instance import Instance
    from cellcolor.data.plan import Plan
    from cellcolor.data.solution import Solution
    from cellcolor.data.surface import LabelledSurface
    from cellcolor.decomposition import Decomposition
    from cellcolor.frontend import BuildResult

Drawn: TypeAlias = Picture2D | Picture3D
"""What a picture consists of, before any library draws it."""

Source = Literal[
    "surface",
    "graph",
    "decomposition",
    "solution",
    "verdicts",
    "plan",
    "reasons",
    "build",
    "color",
    "branch",
    "vertex",
]
"""What a picture can be drawn of; the attributes of :class:`Given` say what each is."""


class Given:
    """What one picture is drawn of: the sources that it declares, and no others.

    A source that is not there raises KeyError: it was not declared, or may be missing.
    """

    def __init__(self, sources: Mapping[Source, Any]) -> None:
        self._sources = sources

    def __contains__(self, source: Source) -> bool:
        return source in self._sources

    @property
    def surface(self) -> LabelledSurface:
        """The labelled surface."""
        surface: LabelledSurface = self._sources["surface"]
        return surface

    @property
    def graph(self) -> Instance:
        """The topological graph."""
        graph: Instance = self._sources["graph"]
        return graph

    @property
    def decomposition(self) -> Decomposition:
        """The topological graph and where it lies on the surface."""
        decomposition: Decomposition = self._sources["decomposition"]
        return decomposition

    @property
    def solution(self) -> Solution:
        """A solution of the graph with a division, which the checker has found valid."""
        solution: Solution = self._sources["solution"]
        return solution

    @property
    def verdicts(self) -> tuple[BoundVerdict, ...]:
        """What came of verifying the bounds of this solution on the surface."""
        verdicts: tuple[BoundVerdict, ...] = self._sources["verdicts"]
        return verdicts

    @property
    def plan(self) -> Plan:
        """One color per vertex of the surface, valid or not."""
        plan: Plan = self._sources["plan"]
        return plan

    @property
    def reasons(self) -> CandidateTable:
        """What became of every candidate of the scene that the surface was built from."""
        reasons: CandidateTable = self._sources["reasons"]
        return reasons

    @property
    def build(self) -> BuildResult:
        """All that the front end found when it built the scene."""
        build: BuildResult = self._sources["build"]
        return build

    @property
    def color(self) -> int:
        """The number of a color of the surface."""
        color: int = self._sources["color"]
        return color

    @property
    def branch(self) -> int:
        """The number of an inverse-kinematic branch."""
        branch: int = self._sources["branch"]
        return branch

    @property
    def vertex(self) -> int:
        """The index of a vertex of the surface."""
        vertex: int = self._sources["vertex"]
        return vertex


class Picture(Protocol):
    """One way to look at a surface, a graph, a solution or an arm."""

    @property
    def needs(self) -> tuple[Source, ...]:
        """What it cannot be drawn without."""

    @property
    def takes(self) -> tuple[Source, ...]:
        """What it uses besides, where there is such a thing."""

    def draw(self, given: Given) -> Drawn:
        """The picture.

        Raises:
            InputError: these parts cannot be drawn together; names the part.
        """
