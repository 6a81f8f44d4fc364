"""Choco as a :class:`cellcolor.solvers.interface.Solver`.

Run as a program, ``python -m cellcolor.solvers.choco.solver INSTANCE SECONDS``, this module solves
an instance. It prints the size of the model, then each better solution, as lines of JSON.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import color_regions, greedy_independent_set
from cellcolor.solvers.choco.model import Problem, Ranks
from cellcolor.solvers.joined_chains import division_of_chains
from cellcolor.solvers.peers import PeerSearch, ProgramPeer, Started

MOST_MEMORY = 3 * 2**30
"""Bytes of memory that the process may take; then it ends, and what it has found is kept."""


class ChocoSolver(ProgramPeer):
    """Choco searches from above and tells no bound of its own until it has proved the minimum.

    Until then the bound is a number of cells of which no two lie in one color region.
    """

    name, package, module, called = "choco", "pychoco", "pychoco", "pychoco"

    def begin(self, search: PeerSearch, folder: Path) -> Started:
        instance = search.instance
        Problem.of(instance)  # what cannot be solved is refused here
        search.known = (Bound("strangers", _fewest(instance), "surface"),)
        file = folder / "instance.json"
        file.write_text(instance.to_json(), encoding="utf-8")

        def hear(line: str) -> None:
            told = _told(line)
            if "variables" in told:
                search.size = ModelSize(told["variables"], told["constraints"])
            if "segments" in told:
                colors, after = dict(told["colors"]), dict(told["after"])
                search.found(division_of_chains(instance, colors, after))
            if told.get("proved"):
                search.done()

        return [sys.executable, "-m", __name__, file, str(search.deadline.left)], hear


def _fewest(instance: Instance) -> int:
    return len(greedy_independent_set(color_regions(instance)))


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
    built = Ranks(Problem.of(instance), _fewest(instance))
    size = {"variables": built.variables, "constraints": built.constraints}
    print(json.dumps(size), flush=True)
    for solution in built.solutions(deadline.left):
        print(json.dumps(solution), flush=True)


if __name__ == "__main__":
    _main(sys.argv[1], float(sys.argv[2]))
