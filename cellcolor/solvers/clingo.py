"""The answer-set solver clingo, on the model ``models/constraints/coloring.lp``.

This module writes an instance as facts for that model, runs clingo, and reads the division off the
last answer set. It shares nothing with the other solvers, so its answers are independent evidence.
It needs the extra ``peers``.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from math import comb
from typing import TYPE_CHECKING

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize
from cellcolor.deadline import OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.files.writing import shipped_folder
from cellcolor.solvers.interface import Answer, OnProgress, Options
from cellcolor.solvers.joined_chains import division_of_chains, only_loops
from cellcolor.solvers.peers import Peer, PeerSearch

if TYPE_CHECKING:
    from clingo import Model

MODEL = shipped_folder() / "models" / "constraints" / "coloring.lp"
"""The answer set program."""

_OPTIONS = ("--opt-strategy=usc,stratify", "--parallel-mode=2")
"""Two threads that search core-guided and stratified: the quickest of the settings tried."""

_MOST_CROSSINGS = 5_000_000
"""The most pairs of crossing links that a model may have. A link goes from one dart of a cell to
another, and the model has a rule for every two links that would cross. Nothing can interrupt clingo
while it writes these rules, which takes up to ten seconds for that many."""

_HEARD_AFTER = 0.1
"""Seconds between two looks at the deadline; Python handles a signal (Ctrl-C) only then."""


class ClingoSolver(Peer):
    """clingo in this process, since it can be interrupted."""

    name, package, module, called = "clingo", "clingo", "clingo", "clingo"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        from clingo import Control

        facts = asp_facts(instance)
        if not instance.cells:
            return Answer((), (), ())
        deadline = options.deadline
        if deadline.over:
            return Answer(None, (), ())
        control = Control(list(_OPTIONS))
        control.load(str(MODEL))
        control.add("base", [], facts)
        control.ground([("base", [])])
        heard = PeerSearch(instance, deadline, options.seed, progress)

        def on_model(model: Model) -> None:
            color: dict[int, int] = {}
            after: dict[int, int] = {}
            for symbol in model.symbols(shown=True):
                first, second = (argument.number for argument in symbol.arguments)
                (color if symbol.name == "joined" else after)[first] = second
            heard.found(division_of_chains(instance, color, after))

        def on_unsat(lower: Sequence[int]) -> None:
            heard.bounded(sum(lower))

        # A signal may end this early, as an OutOfTime.
        with (
            suppress(OutOfTime),
            control.solve(on_model=on_model, on_unsat=on_unsat, async_=True) as search,
        ):
            try:
                while not search.wait(min(_HEARD_AFTER, deadline.left)) and not deadline.over:
                    pass
            finally:
                search.cancel()
                if search.get().exhausted:
                    heard.done()
        program = control.statistics["problem"]["lp"]
        size = ModelSize(int(program["atoms"]), int(program["rules"]))
        bound = Bound("search", heard.bound, "strands")
        return Answer(heard.best, (), (bound,), model=size)


def asp_facts(instance: Instance) -> str:
    """An instance as facts for the model ``coloring.lp``, which lists them; one fact a line.

    Raises:
        InputError: a cell has several loops with live darts, which the model cannot divide.
        TooLarge: the cells have so many live darts that the model would not be written in time.
    """
    facts = []
    crossings = 0
    for cell, loop in enumerate(only_loops(instance)):
        facts.append(f"cell({cell}).")
        facts += [f"at({cell},{place},{dart})." for place, dart in enumerate(loop)]
        crossings += comb(len(loop), 4)
    if crossings > _MOST_CROSSINGS:
        raise TooLarge(f"{crossings} pairs of cutting paths that may cross are too many for clingo")
    for edge in instance.edges:
        colors = instance.joinable(edge.id)
        if colors:
            facts += [f"side({edge.id},{edge.id}).", f"side({edge.id},{-edge.id})."]
            facts += [f"joinable({edge.id},{color})." for color in colors]
    return "".join(f"{fact}\n" for fact in facts)
