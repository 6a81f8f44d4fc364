"""HiGHS, SCIP and RC2 as programs: ``programs SOLVER FILE SECONDS SEED``; see ``rivals``.

Each solves a model in a file and prints what it knows as soon as it knows it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import Any


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


def say_solution(names: Sequence[str], values: Iterable[float]) -> None:
    """Print the variables that are 1."""
    true = [name for name, value in zip(names, values, strict=True) if value > 0.5]
    say(f"solution {' '.join(true)}")


def highs(file: str, seconds: str, seed: str) -> None:
    """HiGHS on a file in MPS."""
    import highspy

    solver = highspy.Highs()
    solver.silent()
    solver.setOptionValue("random_seed", int(seed))
    solver.setOptionValue("mip_rel_gap", 0.0)
    if seconds != "inf":
        solver.setOptionValue("time_limit", float(seconds))
    if solver.readModel(file) == highspy.HighsStatus.kError:
        raise SystemExit(f"cannot read {file}")
    names = [f"x{number}" for number in range(1, solver.getNumCol() + 1)]

    def improved(event: Any) -> None:
        say_solution(names, event.data_out.mip_solution)

    def logged(event: Any) -> None:
        say(f"bound {event.data_out.mip_dual_bound}")

    solver.cbMipImprovingSolution.subscribe(improved)
    solver.cbMipLogging.subscribe(logged)
    solver.run()
    if solver.getModelStatus() == highspy.HighsModelStatus.kOptimal:
        say_solution(names, solver.getSolution().col_value)
        say("done")
    else:
        say(f"bound {solver.getInfo().mip_dual_bound}")


def scip(file: str, seconds: str, seed: str) -> None:
    """SCIP on a file in MPS."""
    from pyscipopt import SCIP_EVENTTYPE, Eventhdlr, Model

    model = Model()
    model.hideOutput()
    model.setParam("randomization/randomseedshift", int(seed))
    model.setParam("limits/memory", 3500.0)  # MB
    if seconds != "inf":
        model.setParam("limits/time", float(seconds))
    model.readProblem(file, extension="mps")
    variables = model.getVars()
    names = [variable.name for variable in variables]

    def tell() -> None:
        best = model.getBestSol()
        say_solution(names, [model.getSolVal(best, variable) for variable in variables])

    class Watcher(Eventhdlr):  # type: ignore[misc]
        def eventinit(self) -> None:
            self.model.catchEvent(SCIP_EVENTTYPE.BESTSOLFOUND, self)
            self.model.catchEvent(SCIP_EVENTTYPE.LPSOLVED, self)

        def eventexec(self, event: Any) -> None:
            if event.getType() == SCIP_EVENTTYPE.BESTSOLFOUND:
                tell()
            else:
                say(f"bound {self.model.getDualbound()}")

    model.includeEventhdlr(Watcher(), "watcher", "reports better solutions and bounds")
    model.optimize()
    if model.getStatus() == "optimal":
        tell()
        say("done")
    else:
        say(f"bound {model.getDualbound()}")


def maxsat(file: str, _seconds: str, _seed: str) -> None:
    """RC2 on a file in WCNF. Nothing is random in it; it can only be killed."""
    from pysat.examples.rc2 import RC2
    from pysat.formula import WCNF

    class Told(RC2):  # type: ignore[misc]
        # The cost is a lower bound after each core.
        def process_core(self) -> None:
            super().process_core()
            say(f"bound {self.cost}")

    with Told(WCNF(from_file=file), solver="g4", adapt=True, exhaust=True, minz=True) as solver:
        found = solver.compute()
        if found is not None:
            say_solution([f"x{abs(value)}" for value in found], [float(v > 0) for v in found])
            say("done")


if __name__ == "__main__":
    {"highs": highs, "scip": scip, "maxsat": maxsat}[sys.argv[1]](*sys.argv[2:])
