"""A solver from outside on the 0-1 model, in a process of its own that is killed at the deadline.

HiGHS cannot be loaded into a process that has loaded OR-Tools, both of which bring the same library
in different versions; and none of these solvers keeps a time limit to the second. So each is run as
a program (``programs``). It reads the file that ``cellcolor export`` writes and prints what it
knows at once: lines ``bound B`` and ``solution x1 x7 …`` (the variables that are 1), and ``done``
once the last solution is proved the best.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import ClassVar

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing
from cellcolor.processes import Child
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.linear.coloring import Coloring, joined_and_linked
from cellcolor.solvers.linear.model import mps, wcnf


@dataclass
class _Heard:
    """What the program has printed so far.

    Attributes:
        bound: no division has fewer segments.
        true: the variables that are 1 in its best solution; None without one.
        done: that solution is proved the best.
    """

    bound: int = 0
    true: frozenset[int] | None = None
    done: bool = False

    def take(self, line: str) -> bool:
        """Read a line; False if it is one of the solver's own, which says nothing to us."""
        word, _, rest = line.partition(" ")
        if word == "bound":
            # A solver's own bound is off by its tolerance.
            self.bound = max(self.bound, math.ceil(float(rest) - 1e-4))
        elif word == "solution":
            self.true = frozenset(int(name.removeprefix("x")) for name in rest.split())
        elif word == "done":
            self.done = True
        else:
            return False
        return True


class _Rival:
    """What HiGHS, SCIP and the MaxSAT solver have in common."""

    abilities = Abilities()
    name: ClassVar[str]
    package: ClassVar[str]  # what is installed
    module: ClassVar[str]  # what is imported
    ending: ClassVar[str] = "mps"
    called: ClassVar[str]

    def __init__(self) -> None:
        """Check that the solver's package is there.

        Raises:
            SolverMissing: it is not.
        """
        if find_spec(self.module) is None:
            raise SolverMissing(self.name, "pip install 'fewest-lift-offs[peers]'")

    @property
    def version(self) -> str:
        """The version of the solver's package."""
        return f"{self.called} {version(self.package)}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: the model would have too many literals.
            CellcolorError: the solver failed before it found or proved anything.
        """
        if not instance.cells:
            return Answer((), (), ())
        coloring = Coloring(instance)
        heard = _Heard()
        failure = None
        # A moment is kept back for reading the answer.
        deadline = options.deadline.earlier(0.05 * min(options.deadline.left, 10.0))
        with tempfile.TemporaryDirectory(prefix="cellcolor-") as place, suppress(OutOfTime):
            file = Path(place) / f"model.{self.ending}"
            with file.open("w", encoding="ascii") as stream:
                for line in deadline.watch(self._lines(coloring, instance.sha256)):
                    stream.write(f"{line}\n")
            # Its own limit comes earlier, so that it can say what it knows in the end.
            arguments = self.name, str(file), f"{0.9 * deadline.left:.2f}", str(options.seed)
            command = [sys.executable, "-m", "cellcolor.solvers.linear.programs", *arguments]
            with Child(command, Path(place)) as child:
                # A signal may stand for the end of the time: OutOfTime.
                for line in child.lines(deadline):
                    if heard.take(line) and progress is not None:
                        progress(_segments(instance, coloring, heard.true), heard.bound)
                failure = child.failure
        if failure is not None and heard == _Heard():
            raise CellcolorError(f"{self.name}: {failure}")
        return self._answer(instance, coloring, heard, failure)

    def _answer(
        self, instance: Instance, coloring: Coloring, heard: _Heard, failure: str | None
    ) -> Answer:
        notes = () if failure is None else (f"{self.called} ended early: {failure}.",)
        if heard.true is None:
            return Answer(None, (), (Bound("model", heard.bound, "strands"),), notes=notes)
        division = division_of_chains(instance, *joined_and_linked(coloring, heard.true))
        bound = count_segments(division) if heard.done else heard.bound
        return Answer(division, (), (Bound("model", bound, "strands"),), notes=notes)

    def _lines(self, coloring: Coloring, title: str) -> Iterable[str]:
        """The file that the program reads."""
        return mps(coloring.model, title)


def _segments(instance: Instance, coloring: Coloring, true: frozenset[int] | None) -> int | None:
    if true is None:
        return None
    return count_segments(division_of_chains(instance, *joined_and_linked(coloring, true)))


class HighsSolver(_Rival):
    """HiGHS, branch and cut."""

    name, package, module, called = "highs", "highspy", "highspy", "HiGHS"


class ScipSolver(_Rival):
    """SCIP, branch and cut with constraint propagation."""

    name, package, module, called = "scip", "pyscipopt", "pyscipopt", "PySCIPOpt"


class MaxSatSolver(_Rival):
    """RC2 of PySAT, core-guided: it has no solution before it has proved the best one."""

    name, package, module, called = "maxsat", "python-sat", "pysat", "PySAT RC2"
    ending = "wcnf"

    def _lines(self, coloring: Coloring, title: str) -> Iterable[str]:
        return wcnf(coloring.model, title)
