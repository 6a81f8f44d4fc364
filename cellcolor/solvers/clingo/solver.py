"""The answer-set solver clingo as a :class:`cellcolor.solvers.interface.Solver`.

The problem is stated in ``coloring.lp`` beside this module. This module writes an instance as facts
for that model, runs clingo, and reads the division off the last answer set.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from importlib.resources import files
from importlib.util import find_spec
from math import comb
from typing import TYPE_CHECKING

from cellcolor.data.bound import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, number_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import InputError, SolverMissing, TooLarge
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options

if TYPE_CHECKING:
    from clingo import Model, Symbol

__all__ = ["ClingoSolver", "asp_facts"]

_OPTIONS = ("--opt-strategy=usc,stratify", "--parallel-mode=2")
"""Two threads that search core-guided and stratified: of what was tried, the quickest."""

_MOST_CROSSINGS = 5_000_000
"""The most pairs of crossing links that a model may have. A link goes from one dart of a cell to
another, and for every two links that would cross the model has a rule. Nothing can interrupt clingo
while it writes the rules down, which takes up to ten seconds for so many."""

_HEARD_AFTER = 0.1
"""Seconds between two looks at the deadline. Python handles a signal, such as Ctrl-C, only then."""


class ClingoSolver:
    """Fewest segments in the search space ``paper``, for cells with one live loop each.

    A live loop is a border loop with edges that can be joined.
    """

    abilities = Abilities()

    def __init__(self) -> None:
        """Check that clingo can be imported.

        Raises:
            SolverMissing: it cannot.
        """
        if find_spec("clingo") is None:
            raise SolverMissing("clingo", "pip install 'fewest-lift-offs[peers]'")

    @property
    def version(self) -> str:
        """Of clingo."""
        return f"clingo {version('clingo')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: a cell has so many live darts that the model would not be written in time.
        """
        from clingo import Control

        facts = asp_facts(instance)
        if not instance.cells:
            return Answer((), (), ())
        deadline = options.deadline
        if deadline.over:
            return Answer(None, (), ())
        control = Control(list(_OPTIONS))
        control.load(str(files(__package__).joinpath("coloring.lp")))
        control.add("base", [], facts)
        control.ground([("base", [])])
        found: list[tuple[int, Sequence[Symbol]]] = []
        bounds = [0]

        def report() -> None:
            if progress is not None:
                progress(found[-1][0] if found else None, bounds[-1])

        def on_model(model: Model) -> None:
            found.append((sum(model.cost), model.symbols(shown=True)))
            report()

        def on_unsat(lower: Sequence[int]) -> None:
            bounds.append(max(bounds[-1], sum(lower)))
            report()

        complete = False
        with control.solve(on_model=on_model, on_unsat=on_unsat, async_=True) as search:
            try:
                while not search.wait(min(_HEARD_AFTER, deadline.left)) and not deadline.over:
                    pass
            except OutOfTime:
                pass  # a signal that stands for the end of the time
            finally:
                search.cancel()
                complete = bool(search.get().exhausted)
        if not found:
            return Answer(None, (), (Bound("search", bounds[-1], "strands"),))
        segments, symbols = found[-1]
        bound = Bound("search", segments if complete else bounds[-1], "strands")
        return Answer(_division(instance, symbols), (), (bound,))


def asp_facts(instance: Instance) -> str:
    """An instance as facts for the model ``coloring.lp``, which lists them; one fact a line.

    Raises:
        InputError: a cell has several loops with live darts, which the model cannot divide.
        TooLarge: the cells have so many live darts that the model would not be written in time.
    """
    facts = []
    crossings = 0
    for cell in instance.cells:
        facts.append(f"cell({cell.id}).")
        live = instance.live_loops[cell.id]
        if len(live) > 1:
            where = f"cells[{cell.id}].loops"
            raise InputError(None, where, f"the model knows one live loop, here are {len(live)}")
        facts += [f"at({cell.id},{place},{d})." for loop in live for place, d in enumerate(loop)]
        crossings += sum(comb(len(loop), 4) for loop in live)
    if crossings > _MOST_CROSSINGS:
        raise TooLarge(f"{crossings} pairs of cutting paths that may cross are too many for clingo")
    for edge in instance.edges:
        colors = instance.joinable(edge.id)
        if colors:
            facts += [f"side({edge.id},{edge.id}).", f"side({edge.id},{-edge.id})."]
            facts += [f"joinable({edge.id},{color})." for color in colors]
    return "".join(f"{fact}\n" for fact in facts)


def _division(instance: Instance, symbols: Sequence[Symbol]) -> Division:
    """The division that an answer set describes: its sub-cells are chains of linked darts.

    In the model the sub-cells of a segment form a tree: it does not join an edge that would close a
    circle of them. In a division such an edge has to be joined, because it has the same color on
    both sides (docs/semantics.md, section 3, rule 5). So every dart that the model left unjoined is
    given to the sub-cell before it in cyclic order, and its edge is joined if the dart on the other
    side then has the same, joinable color. That makes no new segment.

    A sub-cell is named here by its first dart and its color. The first dart is 0 for the one
    sub-cell of a cell without joined darts.
    """
    color: dict[int, int] = {}
    after: dict[int, int] = {}
    for symbol in symbols:
        first, second = (argument.number for argument in symbol.arguments)
        if symbol.name == "joined":
            color[first] = second
        else:
            after[first] = second
    start = {dart: dart for dart in after}  # the first dart of the chain that a dart is in
    shown: dict[int, tuple[int, int]] = {}  # the sub-cell that each live dart is given to
    for cell in instance.cells:
        live = [dart for loop in instance.live_loops[cell.id] for dart in loop]
        for dart in live:
            if dart in after:
                start[after[dart]] = start[dart]
        own = (0, cell.colors[0])
        joined = [dart for dart in live if abs(dart) in color]
        if joined:
            own = start.get(joined[-1], joined[-1]), color[abs(joined[-1])]
        for dart in live:
            if abs(dart) in color:
                own = start.get(dart, dart), color[abs(dart)]
            shown[dart] = own
    blocks: list[list[tuple[int, list[int]]]] = []
    for cell in instance.cells:
        found: dict[tuple[int, int], list[int]] = {}
        for dart in (dart for loop in cell.loops for dart in loop if dart in shown):
            own, other = shown[dart], shown[-dart]
            if own[1] == other[1] and own[1] in instance.joinable(dart):
                found.setdefault(own, []).append(dart)
        blocks.append([(own[1], darts) for own, darts in found.items()] or [(cell.colors[0], [])])
    return number_segments(blocks)
