"""Choco as a :class:`cellcolor.solvers.interface.Solver`.

Run as a program, ``python -m cellcolor.solvers.choco.solver INSTANCE SECONDS``, this module solves
an instance. It prints the size of the model, then each better solution, as lines of JSON. The
solver runs it in a process of its own: Choco hears no signal while it searches, its errors end the
process, and it may print.
"""

from __future__ import annotations

import json
import sys
import tempfile
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError, SolverMissing
from cellcolor.processes import Child
from cellcolor.solvers.bounds.cover import color_regions, greedy_independent_set
from cellcolor.solvers.choco.model import Problem, Ranks
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains

MOST_MEMORY = 3 * 2**30
"""Bytes of memory that the process may take; then it ends, and what it has found is kept."""


class ChocoSolver:
    """Fewest segments in the search space ``paper``, for cells with one live loop each."""

    abilities = Abilities()

    def __init__(self) -> None:
        if find_spec("pychoco") is None:
            raise SolverMissing("choco", "pip install 'fewest-lift-offs[peers]'")

    @property
    def version(self) -> str:
        """The version of pychoco, which includes Choco."""
        return f"pychoco {version('pychoco')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """Choco searches from above and tells no bound of its own until it has proved the minimum.

        Until then the bound is a number of cells of which no two lie in one color region.

        Raises:
            CellcolorError: Choco failed before it found a solution.
        """
        if not instance.cells:
            return Answer((), (), ())
        deadline = options.deadline
        best: dict[str, Any] | None = None
        proved, fewest = False, 0
        model: ModelSize | None = None
        try:
            Problem.of(instance, deadline)  # what cannot be solved is refused here
            fewest = len(greedy_independent_set(color_regions(instance)))
            with tempfile.TemporaryDirectory(prefix="cellcolor-") as name:
                folder = Path(name)
                file = folder / "instance.json"
                file.write_text(instance.to_json(), encoding="utf-8")
                command = [sys.executable, "-m", __name__, str(file), str(deadline.left)]
                with Child(command, folder) as child:
                    for line in child.lines(deadline):
                        told = _told(line)
                        proved = told.get("proved", proved)
                        if "variables" in told:
                            model = ModelSize(told["variables"], told["constraints"])
                        if "segments" in told:
                            best = told
                            if progress is not None:
                                progress(told["segments"], fewest)
                    if best is None and child.failure is not None:
                        raise CellcolorError(child.failure)
        except OutOfTime:
            pass  # before the search began; or a signal that stands for the end of the time
        bounds = [Bound("strangers", fewest, "surface")]
        if best is None:
            return Answer(None, (), tuple(bounds), model=model)
        if proved:
            bounds.append(Bound("search", best["segments"], "strands"))
        division = division_of_chains(instance, dict(best["colors"]), dict(best["after"]))
        return Answer(division, (), tuple(bounds), model=model)


def _told(line: str) -> dict[str, Any]:
    """What a line of the program says; Choco may print lines of its own."""
    try:
        told = json.loads(line)
    except json.JSONDecodeError:
        return {}
    return told if isinstance(told, dict) else {}


def _main(path: str, seconds: float) -> None:
    """What the process of its own does."""
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))
    deadline = Deadline.after(seconds)
    instance = Instance.read(path)
    built = Ranks(
        Problem.of(instance, deadline), len(greedy_independent_set(color_regions(instance)))
    )
    size = {"variables": built.variables, "constraints": built.constraints}
    print(json.dumps(size), flush=True)
    for solution in built.solutions(deadline.left):
        print(json.dumps(solution), flush=True)


if __name__ == "__main__":
    _main(sys.argv[1], float(sys.argv[2]))
