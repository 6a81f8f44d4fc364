"""Better divisions of a part: by local search, by segments left out, by windows solved anew."""

from __future__ import annotations

from math import isfinite

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.cpsat.part_state import PartState
from cellcolor.solvers.cpsat.routes.dropping import FRUITLESS, drop_segments
from cellcolor.solvers.cpsat.routes.recoloring import FEW_MOVES
from cellcolor.solvers.cpsat.windows import improve

WIDE_GAP, SHARE_OF_ROUTES = 2, 1 / 4
"""Segments above the bound from which other routes are tried before models; and what part of the
time that is left one kind of them gets before the other has its turn."""

MORE_TRIES = 10
"""Segments left out in vain for each segment, once other routes have their turns."""

MOVES = 1_000
"""Moves of local search in vain for each segment, before nothing better is expected."""

TURNS = 2
"""Turns of both kinds in a row without a better division before models are tried all the same."""

WINDOW_EFFORT = 0.1
"""Deterministic seconds for the model of a window."""


class Improving:
    """Improves the best division of a part, without proving anything."""

    def __init__(self, part: PartState) -> None:
        self._part = part
        self._tries = 0

    def begin_large(self, deadline: Deadline) -> None:
        """Local search on a large part, so that plans can be held against a good division."""
        if self._part.large:
            self._part.recolor(*self._part.best, self._part.options.seed, deadline, FEW_MOVES)

    def drop(self, deadline: Deadline) -> None:
        """Better divisions by leaving out a segment and routing all others anew.

        Around hubs the model works better, for divisions and for the bound.
        """
        if self._part.hubs is None and not self._part.large:
            self._drop(self._part.options.seed, deadline, FRUITLESS)

    def recolor_large(self, deadline: Deadline) -> None:
        """Better divisions of a large part by local search.

        On small parts other routes and windows find as much or more.
        """
        if self._part.large:
            self._part.recolor(*self._part.best, self._part.options.seed, deadline, MOVES)

    def narrow_gap(self, deadline: Deadline) -> None:
        """Turns of what follows, where more is missing than a model is likely to close."""
        in_vain = 0
        part = self._part
        while in_vain < TURNS and part.hubs is None and part.segments - part.bound >= WIDE_GAP:
            before = part.segments
            self._take_turns(deadline)
            in_vain = 0 if part.segments < before else in_vain + 1

    def improve_on(self, deadline: Deadline) -> None:
        """Turns of what follows, as long as there is time."""
        while isfinite(deadline.moment) and not self._part.done:
            self._take_turns(deadline)

    def _take_turns(self, deadline: Deadline) -> None:
        """Local search on a large part; on others segments left out, then windows. New seeds."""
        deadline.check()
        self._tries += 1
        seed = self._part.options.seed + self._tries
        if self._part.large:
            self._part.recolor(*self._part.best, seed, deadline.share(SHARE_OF_ROUTES), MOVES)
        else:
            self._drop(seed, deadline.share(SHARE_OF_ROUTES), MORE_TRIES)
            self._improve(seed, deadline.share(SHARE_OF_ROUTES))

    def _drop(self, seed: int, deadline: Deadline, tries: float) -> None:
        graph, painting = self._part.best
        for better in drop_segments(graph, painting, self._part.regions, seed, deadline, tries):
            self._part.keep(graph, better)
            if self._part.done:
                return

    def _improve(self, seed: int, deadline: Deadline) -> None:
        graph, painting = self._part.best
        for better in improve(graph, painting, self._solve_window, seed, deadline):
            self._part.keep(graph, better)
            if self._part.done:
                return

    def _solve_window(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = self._part.runner.single(WINDOW_EFFORT, seed)
        return solver, self._part.runner.solve(solver, model)
