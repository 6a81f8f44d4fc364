"""HiGHS, SCIP and RC2 on the 0-1 model.

HiGHS and OR-Tools bring the same library in different versions, so one process cannot load both:
each is run as a program (``programs``). It reads the file that ``cellcolor export`` writes and
prints lines ``bound B`` and ``solution x1 x7 …`` (the variables that are 1), and ``done`` once the
last solution is proved the best.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import ClassVar, Literal

from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.linear.coloring import Coloring, joined_and_linked
from cellcolor.solvers.linear.model import mps, wcnf
from cellcolor.solvers.peers import PeerSearch, ProgramPeer, Started


class _Rival(ProgramPeer):
    """What HiGHS, SCIP and the MaxSAT solver have in common."""

    proof = "model"
    ending: ClassVar[Literal["mps", "wcnf"]] = "mps"  # of the file that it reads

    def begin(self, search: PeerSearch, folder: Path) -> Started:
        coloring = Coloring(search.instance)
        file = folder / f"model.{self.ending}"
        with file.open("w", encoding="ascii") as stream:
            lines = {"mps": mps, "wcnf": wcnf}[self.ending](coloring.model, search.instance.sha256)
            for line in search.deadline.watch(lines):
                stream.write(f"{line}\n")
        search.size = coloring.model.size

        def hear(line: str) -> None:
            word, _, rest = line.partition(" ")
            if word == "bound":
                # A solver's bound may exceed the true one by its tolerance.
                search.bounded(math.ceil(float(rest) - 1e-4))
            elif word == "solution":
                true = frozenset(int(name.removeprefix("x")) for name in rest.split())
                chains = joined_and_linked(coloring, true)
                search.found(division_of_chains(search.instance, *chains))
            elif word == "done":
                search.done()

        # Its own limit comes earlier, so that it can say what it knows in the end.
        arguments = self.name, str(file), f"{0.9 * search.deadline.left:.2f}", str(search.seed)
        return [sys.executable, "-m", "cellcolor.solvers.linear.programs", *arguments], hear


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
