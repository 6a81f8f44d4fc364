"""External solvers on the 0-1 model, each in its own process, which is killed at the deadline.

HiGHS and OR-Tools bring the same library in different versions, so one process cannot load both.
None of these solvers keeps a time limit to the second either. So each is run as a program
(``programs``). It reads the file that ``cellcolor export`` writes and prints what it
knows at once: lines ``bound B`` and ``solution x1 x7 …`` (the variables that are 1), and ``done``
once the last solution is proved the best.
"""

from __future__ import annotations

import math
import sys
import tempfile
from contextlib import suppress
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import ClassVar, Literal

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing
from cellcolor.processes import Child
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.linear.coloring import Coloring, joined_and_linked
from cellcolor.solvers.linear.model import mps, wcnf


class _Rival:
    """What HiGHS, SCIP and the MaxSAT solver have in common."""

    abilities = Abilities()
    name: ClassVar[str]
    package: ClassVar[str]  # what is installed
    module: ClassVar[str]  # what is imported
    ending: ClassVar[Literal["mps", "wcnf"]] = "mps"  # of the file that it reads
    called: ClassVar[str]

    def __init__(self) -> None:
        if find_spec(self.module) is None:
            raise SolverMissing(self.name, "pip install 'fewest-lift-offs[peers]'")

    @property
    def version(self) -> str:
        """The version of the solver's package."""
        return f"{self.called} {version(self.package)}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """As the interface says; a CellcolorError if it fails before it has found anything."""
        if not instance.cells:
            return Answer((), (), ())
        coloring = Coloring(instance)
        best: Division | None = None
        bound, size = 0, None
        failure = None
        # A moment is kept back for reading the answer.
        deadline = options.deadline.earlier(0.05 * min(options.deadline.left, 10.0))
        with tempfile.TemporaryDirectory(prefix="cellcolor-") as place, suppress(OutOfTime):
            file = Path(place) / f"model.{self.ending}"
            with file.open("w", encoding="ascii") as stream:
                lines = {"mps": mps, "wcnf": wcnf}[self.ending](coloring.model, instance.sha256)
                for line in deadline.watch(lines):
                    stream.write(f"{line}\n")
            size = coloring.model.size
            # Its own limit comes earlier, so that it can say what it knows in the end.
            arguments = self.name, str(file), f"{0.9 * deadline.left:.2f}", str(options.seed)
            command = [sys.executable, "-m", "cellcolor.solvers.linear.programs", *arguments]
            with Child(command, Path(place)) as child:
                # A signal may end this early, as an OutOfTime.
                for line in child.lines(deadline):
                    word, _, rest = line.partition(" ")
                    if word == "bound":
                        # A solver's bound may exceed the true one by its tolerance.
                        bound = max(bound, math.ceil(float(rest) - 1e-4))
                    elif word == "solution":
                        true = frozenset(int(name.removeprefix("x")) for name in rest.split())
                        found = division_of_chains(instance, *joined_and_linked(coloring, true))
                        # It may have fewer segments than its solution says.
                        best = min(best or found, found, key=count_segments)
                    elif word == "done" and best is not None:
                        bound = count_segments(best)
                    else:
                        continue  # other output of the solver
                    if progress is not None:
                        progress(None if best is None else count_segments(best), bound)
                failure = child.failure
        if failure is not None and best is None and bound == 0:
            raise CellcolorError(f"{self.name}: {failure}")
        notes = () if failure is None else (f"{self.called} ended early: {failure}.",)
        return Answer(best, (), (Bound("model", bound, "strands"),), notes, size)


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
