"""The same problem put to somebody else's solver, in a process of its own: clingo.

The model is ``models/constraints/coloring.lp``. This takes part in no proof; it is there to be
compared with (docs/benchmarks.md).
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict
from pathlib import Path

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError
from cellcolor.files.documents import parse_json
from cellcolor.lab.races import Run, run_apart

__all__ = ["asp_facts", "measure_clingo"]

_OPTIONS = ("--opt-strategy=usc,stratify", "--parallel-mode=2")
"""Core-guided and stratified: the quickest of the strategies that were tried."""


def asp_facts(instance: Instance) -> str:
    """An instance as facts for the model, one fact a line.

    Raises:
        InputError: a cell has several loops with live darts, which the model does not know.
    """
    facts = []
    for cell in instance.cells:
        facts.append(f"cell({cell.id}).")
        loops = [[dart for dart in loop if instance.joinable(dart)] for loop in cell.loops]
        live = [loop for loop in loops if loop]
        if len(live) > 1:
            raise InputError(
                None,
                f"cells[{cell.id}].loops",
                f"the model is for cells with one live loop, this one has {len(live)}",
            )
        facts += [f"at({cell.id},{place},{d})." for loop in live for place, d in enumerate(loop)]
    for edge in instance.edges:
        colors = instance.joinable(edge.id)
        if colors:
            facts += [f"side({edge.id},{edge.id}).", f"side({edge.id},{-edge.id})."]
            facts += [f"joinable({edge.id},{color})." for color in colors]
    return "".join(f"{fact}\n" for fact in facts)


def measure_clingo(instance: Instance, model: Path, time_limit: float) -> Run:
    """Solve an instance with clingo in a new process, in the search space ``paper``.

    Args:
        instance: cells with one live loop.
        model: ``models/constraints/coloring.lp``.
        time_limit: seconds.

    Raises:
        CellcolorError: the process failed, or clingo is not installed; with the last line that it
            printed.
    """
    command = [sys.executable, "-m", "cellcolor.lab.peers", str(model), str(time_limit)]
    return run_apart("clingo", command, instance, time_limit)


def _run(model: Path, time_limit: float) -> Run:
    """What the new process does with the instance on its standard input."""
    from clingo import Control, Model

    facts = asp_facts(Instance.from_document(parse_json(sys.stdin.read())))
    started = time.monotonic()
    control = Control(list(_OPTIONS))
    control.load(str(model))
    control.add("base", [], facts)
    control.ground([("base", [])])
    costs: list[int] = []

    def note(found: Model) -> None:
        costs.append(sum(found.cost))

    left = max(0.0, time_limit - (time.monotonic() - started))
    with control.solve(on_model=note, async_=True) as search:
        search.wait(left)
        search.cancel()
        complete = search.get().exhausted
    return Run(min(costs, default=None), bool(complete and costs), time.monotonic() - started)


if __name__ == "__main__":
    print(json.dumps(asdict(_run(Path(sys.argv[1]), float(sys.argv[2])))))
