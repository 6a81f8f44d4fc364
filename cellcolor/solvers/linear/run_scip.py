"""SCIP on a file in MPS, as a program: ``run_scip FILE SECONDS SEED``; see ``rival``."""

from __future__ import annotations

import sys
from typing import Any

from cellcolor.solvers.linear.printed import say, say_solution


def main(file: str, seconds: str, seed: str) -> None:
    """Solve a model, and print what is known as soon as it is."""
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
        """Told of each better solution."""

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


if __name__ == "__main__":
    main(*sys.argv[1:])
