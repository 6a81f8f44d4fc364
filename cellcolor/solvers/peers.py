"""Solvers of other projects, most of them run as programs that are killed at the deadline.

These neither keep a time limit to the second nor hear signals while they search; an error of theirs
ends the process. Such a program prints what it knows at once, and what it has said by then counts.
"""

from __future__ import annotations

import tempfile
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import ClassVar

from cellcolor.data.bounds import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, ModelSize, count_segments
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing
from cellcolor.processes import Child
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options

Started = tuple[list[str | Path], Callable[[str], None]]
"""The command of a program, and what becomes of a line that it prints."""


class Peer:
    """A solver in a Python package of the extra ``peers``, and what it declares.

    It divides cells with one live loop each (:class:`~cellcolor.solvers.interface.Abilities`).
    """

    abilities = Abilities()
    name: ClassVar[str]
    package: ClassVar[str]  # what is installed
    module: ClassVar[str]  # what is imported
    called: ClassVar[str]

    def __init__(self) -> None:
        if find_spec(self.module) is None:
            raise SolverMissing(self.name, "pip install 'fewest-lift-offs[peers]'")

    @property
    def version(self) -> str:
        """The version of the solver's package."""
        return f"{self.called} {version(self.package)}"


@dataclass
class PeerSearch:
    """What a solver is given, and what it has said so far.

    Attributes:
        known: bounds from before it begins.
        best: the best division, None for none.
        bound: the best bound of its own.
    """

    instance: Instance
    deadline: Deadline
    seed: int
    progress: OnProgress | None
    known: tuple[Bound, ...] = ()
    best: Division | None = None
    bound: int = 0
    size: ModelSize | None = None

    def found(self, division: Division) -> None:
        """It has a division, which may have fewer segments than it counts."""
        self.best = min(self.best or division, division, key=count_segments)
        self.bounded(0)

    def bounded(self, bound: int) -> None:
        """It has a lower bound."""
        self.bound = max(self.bound, bound)
        if self.progress is not None:
            best = None if self.best is None else count_segments(self.best)
            self.progress(best, max(self.bound, greatest(self.known, "strands")))

    def done(self) -> None:
        """It has proved that no division is better than the best."""
        if self.best is not None:
            self.bounded(count_segments(self.best))


class ProgramPeer(Peer, ABC):
    """A solver that runs as a program."""

    proof: ClassVar[str] = "search"  # the kind of its bounds

    @abstractmethod
    def begin(self, search: PeerSearch, folder: Path) -> Started:
        """Write what the program reads into a folder."""

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """As the interface says; a CellcolorError if it fails before it has found anything."""
        if not instance.cells:
            return Answer((), (), ())
        failure = None
        # A moment is kept back for reading the answer.
        deadline = options.deadline.earlier(0.05 * min(options.deadline.left, 10.0))
        # A signal may end this early, as an OutOfTime.
        with tempfile.TemporaryDirectory(prefix="cellcolor-") as place, suppress(OutOfTime):
            search = PeerSearch(instance, deadline, options.seed, progress)
            command, hear = self.begin(search, Path(place))
            with Child(command, Path(place)) as child:
                for line in child.lines(deadline):
                    hear(line)
                failure = child.failure
        if failure is not None and search.best is None and search.bound == 0:
            raise CellcolorError(f"{self.name}: {failure}")
        notes = () if failure is None else (f"{self.called} ended early: {failure}.",)
        bounds = (*search.known, Bound(self.proof, search.bound, "strands"))
        return Answer(search.best, (), bounds, notes, search.size)
