"""Races between solvers, each solve in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from cellcolor.data.instance import Cell, Instance
from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError, Disagreement
from cellcolor.files.documents import parse_json
from cellcolor.solvers.interface import Options

__all__ = ["Run", "measure", "race"]

_GRACE = 60.0
"""Seconds beyond its limit after which a process counts as not coming back."""


@dataclass(frozen=True, slots=True)
class Run:
    """One solve.

    Attributes:
        segments: of the best division found; None when none was found.
        optimal: whether that is proved to be the minimum.
        seconds: the solver's own wall-clock time; None when its process did not come back.
    """

    segments: int | None
    optimal: bool
    seconds: float | None


def measure(instance: Instance, solver: str, time_limit: float) -> Run:
    """Solve an instance in a new process, in the search space ``paper``.

    Args:
        instance: what to solve.
        solver: the name of any registered solver.
        time_limit: seconds; a process that overruns it by far counts as not coming back.

    Raises:
        CellcolorError: the process failed; with the last line that it printed.
    """
    command = [sys.executable, "-m", "cellcolor.lab.races", solver, str(time_limit)]
    try:
        done = subprocess.run(
            command,
            input=instance.to_json(),
            capture_output=True,
            encoding="utf-8",
            timeout=time_limit + _GRACE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Run(None, False, None)
    if done.returncode != 0:
        line = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        raise CellcolorError(f"{solver} failed: {line}")
    return Run(**json.loads(done.stdout))


def race(instance: Instance, solvers: Sequence[str], time_limit: float) -> dict[str, Run]:
    """The runs of some solvers on one instance, one after the other.

    Raises:
        Disagreement: two proved minima differ.
        CellcolorError: a solver failed.
    """
    runs = {solver: measure(instance, solver, time_limit) for solver in solvers}
    minima = {solver: run.segments for solver, run in runs.items() if run.optimal}
    if len(set(minima.values())) > 1:
        claims = ", ".join(f"{solver} {segments}" for solver, segments in minima.items())
        raise Disagreement(f"different proved minima: {claims}")
    return runs


def _run(solver: str, time_limit: float) -> Run:
    """What the new process does with the instance on its standard input."""
    from cellcolor.solvers.checked import solve

    instance = Instance.from_document(parse_json(sys.stdin.read()))
    # Solvers import what they need on first use, which is not what is measured here.
    solve(Instance("warm-up", ("any",), (Cell(0, (0,), ()),), ()), Options(), solver)
    solution = solve(instance, Options(deadline=Deadline.after(time_limit)), solver)
    return Run(solution.segments, solution.status == "optimal", solution.seconds)


if __name__ == "__main__":
    print(json.dumps(asdict(_run(sys.argv[1], float(sys.argv[2])))))
