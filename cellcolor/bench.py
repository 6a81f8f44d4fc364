"""The reference solver against CP-SAT, each solve in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.errors import CellcolorError

__all__ = ["SOLVERS", "Contradiction", "Run", "compare", "max_live_darts", "measure"]

SOLVERS = ("dfs", "cp-sat")
_GRACE = 60.0
"""Seconds beyond its limit after which a process counts as not coming back."""


class Contradiction(CellcolorError):
    """Two solvers have proved different minima of one instance: one of them is wrong."""


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


def max_live_darts(instance: Instance) -> int:
    """The live darts of the cell that has most of them: what makes an instance hard."""
    return max(
        (sum(bool(instance.joinable(d)) for loop in c.loops for d in loop) for c in instance.cells),
        default=0,
    )


def measure(path: Path, solver: str, time_limit: float) -> Run:
    """Solve a file with ``cellcolor solve`` in a new process.

    Raises:
        CellcolorError: the file cannot be solved; with the line that the process printed.
    """
    command = [sys.executable, "-m", "cellcolor.cli", "solve", str(path), "--json"]
    command += ["--solver", solver, "--time-limit", str(time_limit)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=time_limit + _GRACE, check=False
        )
    except subprocess.TimeoutExpired:
        return Run(None, False, None)
    if done.returncode not in (0, 3):
        line = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        raise CellcolorError(line.removeprefix("cellcolor: "))
    solution: dict[str, Any] = json.loads(done.stdout)
    return Run(solution["segments"], solution["status"] == "optimal", solution["seconds"])


def compare(path: Path, time_limit: float) -> dict[str, Run]:
    """Every solver's run on one file.

    Raises:
        Contradiction: two proved minima differ.
        CellcolorError: the file cannot be solved.
    """
    runs = {solver: measure(path, solver, time_limit) for solver in SOLVERS}
    minima = {solver: run.segments for solver, run in runs.items() if run.optimal}
    if len(set(minima.values())) > 1:
        claims = ", ".join(f"{solver} {segments}" for solver, segments in minima.items())
        raise Contradiction(f"{path}: different proved minima: {claims}")
    return runs
