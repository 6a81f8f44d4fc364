"""Which set-ups to use: few that cover enough, and among these the ones with the fewest segments.

A set-up is the same surface as another placement, or another arm, labels it. The colors of several
set-ups stand side by side on one labelled surface; no color of one leads on into a color of
another, so the ordinary solver proves its minimum. Which set-ups these are is settled in turns
(logic-based Benders decomposition, docs/questions.md). A master model chooses color regions that
cover enough; every segment lies in one region of one set-up, so at least so many are needed. The
surface with the colors of these regions alone is solved, which is quick. What it needs in truth the
master learns, for these regions and all that lie within them, and chooses others, until none of
those could be better. Where the fewest set-ups are asked for, each set of so few has a master of
its own, as far as these can be listed: small models are solved in no time, one with all regions is
not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from math import ceil, inf
from operator import attrgetter

import numpy as np
from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.questions.set_ups import Choice, Region, side_by_side
from cellcolor.questions.tradeoff import few_that_cover, solved_model
from cellcolor.solvers import checked
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.interface import PORTFOLIO, Options

_WHOLE = 2**40
"""What all vertices weigh together as integers, for CP-SAT: a share is told to 1e-12."""
_UNIT = 1000
"""Costs are added as whole numbers of thousandths of a lift-off, which an objective's price is."""
_MOST_SETS = 20_000  # of set-ups, each with a model of its own


def choose(
    surfaces: Sequence[LabelledSurface],
    cover: float,
    change_over: float | None,
    options: Options,
    progress: Callable[[str], None] | None = None,
) -> Choice:
    """The set-ups to use.

    Args:
        surfaces: of each set-up that may be used, all on one mesh.
        cover: the share that has to be covered of the area that any of them reaches, 0 to 1.
        change_over: what a change from one set-up to the next costs, in lift-offs, 1 or more, since
            it takes a lift-off. None for the fewest set-ups first, whatever that costs.
        options: deadline, workers and seed; the search space is ``paper``.

    Raises:
        InputError: nothing is reached.
        OutOfTime: the deadline came before there was any choice.
    """
    in_turn = change_over is None  # set-ups first, then segments
    # What a change-over costs beyond the lift-off that it takes; one is counted before the first.
    extra = 0 if change_over is None else round(_UNIT * (change_over - 1))
    report = progress or (lambda _: None)
    asked = _Asked(surfaces, cover, options)
    report("the fewest set-ups")
    fewest = asked.fewest_set_ups()
    sets = asked.sets_of(fewest) if in_turn else None
    if sets is None:
        number = fewest if in_turn else None
        masters = [_Master(asked, range(len(surfaces)), extra, number)]
    else:
        report(f"{len(sets)} sets of {fewest}")
        masters = [_Master(asked, set_ups, extra) for set_ups in sets]
    best: Choice | None = None
    cost, tried = inf, 0
    cheapest = attrgetter("least")
    try:
        while (master := min(masters, key=cheapest)).least < cost:
            chosen = master.next_choice()
            least = min(masters, key=cheapest).least
            if master.least > least or least >= cost:  # another one looks better now, or none
                continue
            if chosen in master.tried or not asked.everything:
                # Its regions alone are not enough, or not what has to be covered: all of the same
                # set-ups.
                chosen = asked.regions_of({asked.regions[one].set_up for one in chosen})
                if chosen in master.tried:  # no solver knows better
                    break
            tried += 1
            report(f"choice {tried}, at least {least / _UNIT:g}")
            solved, needed = asked.solved(chosen)
            master.learn(chosen, needed)
            if solved is not None:
                own = _UNIT * (solved.solution.segments or 0) + extra * len(solved.numbers)
                if own < cost:
                    best, cost = solved, own
    except OutOfTime:
        if best is None:
            raise
    if best is None:
        raise OutOfTime
    least = min(masters, key=cheapest).least
    proved = least >= cost
    least -= extra * len(best.numbers)
    return replace(
        best,
        fewest_set_ups=fewest,
        at_least_segments=(best.solution.segments or 0 if proved else max(1, ceil(least / _UNIT))),
        proved=proved,
    )


class _Asked:
    """The regions of all set-ups, and what some of them need."""

    def __init__(self, surfaces: Sequence[LabelledSurface], cover: float, options: Options) -> None:
        self.surfaces, self.options = surfaces, options
        self.areas = surfaces[0].vertex_areas
        self.regions: list[Region] = []
        for number, surface in enumerate(surfaces):
            self.regions += _regions_of(number, surface, options.deadline)
        self._reach = np.array([one.colored for one in surfaces])
        reached = self._reach.any(axis=0)
        self.whole = float(self.areas[reached].sum())
        if not self.whole:
            raise InputError(None, None, "nothing is reached in any of the set-ups")
        self.cover, self.everything = cover, cover >= 1

    def fewest_set_ups(self) -> int:
        """No fewer cover enough.

        Raises:
            OutOfTime: that was not proved in time.
        """
        model = cp_model.CpModel()
        used = [model.new_bool_var("") for _ in self.surfaces]
        self.cover_enough(model, used, [np.flatnonzero(row).tolist() for row in self._reach.T])
        model.minimize(sum(used))
        solver = self.run(model)
        if solver.best_objective_bound < solver.objective_value - 0.5:
            raise OutOfTime
        return round(solver.objective_value)

    def sets_of(self, size: int) -> list[tuple[int, ...]] | None:
        """All sets of this many set-ups that cover everything; None if they cannot be listed."""
        if not self.everything:
            return None
        places = _hardest({tuple(np.flatnonzero(row).tolist()) for row in self._reach.T} - {()})
        found: set[tuple[int, ...]] = set()
        begun: list[tuple[int, ...]] = [()]
        while begun:
            some = begun.pop()
            open_place = next((p for p in places if not set(p) & set(some)), None)
            if open_place is None:
                # Without what is not needed it would be a smaller set, which there is none of.
                found.add(tuple(sorted(some)))
            elif len(some) < size:
                begun += [(*some, number) for number in open_place]
            if len(found) + len(begun) > _MOST_SETS:
                return None
        return sorted(found)

    def cover_enough(
        self,
        model: cp_model.CpModel,
        literals: Sequence[cp_model.IntVar],
        covering: Iterable[Iterable[int]],
    ) -> None:
        """Require that enough vertices have something chosen that covers them.

        Args:
            literals: of what can be chosen.
            covering: the numbers, for each vertex, of those that cover it.
        """
        # Vertices that are covered by the same are one place with one weight.
        places: Counter[tuple[int, ...]] = Counter()
        for own, area in zip(covering, self.areas.tolist(), strict=True):
            if numbers := tuple(own):
                places[numbers] += area
        if self.everything:
            for place in _hardest(places):
                model.add_bool_or([literals[number] for number in place])
            return
        covered = []
        for place, area in places.items():
            one = model.new_bool_var("")
            model.add_bool_or([~one, *(literals[number] for number in place)])
            covered.append(round(area / self.whole * _WHOLE) * one)
        model.add(sum(covered) >= round(self.cover * _WHOLE) - len(places))

    def run(self, model: cp_model.CpModel) -> cp_model.CpSolver:
        """The solver with a choice.

        Raises:
            OutOfTime: none was found in time.
        """
        # By measure, with 200 set-ups of which all have to be covered: 15 s instead of minutes.
        level = 0 if self.everything else 2
        asked = self.options
        return solved_model(model, asked.deadline, asked.workers or PORTFOLIO, asked.seed, level)

    def regions_of(self, set_ups: Collection[int]) -> frozenset[int]:
        """The numbers of all regions of some set-ups."""
        return frozenset(n for n, region in enumerate(self.regions) if region.set_up in set_ups)

    def solved(self, chosen: Collection[int]) -> tuple[Choice | None, int]:
        """The best division found of some regions that covers enough, and what any one needs."""
        surface = side_by_side(self.surfaces, [self.regions[one] for one in chosen])
        deadline = self.options.deadline
        options = replace(self.options, deadline=deadline.share(0.5))
        found = decomposition_of(surface, deadline=deadline)
        if self.everything:
            solution = checked.solve(found.instance, options)
            least = solution.surface_lower_bound
        else:
            cells = np.array(found.vertex_cell)
            inside = cells != OUTSIDE
            weights = np.bincount(
                cells[inside], self.areas[inside], minlength=len(found.instance.cells)
            )
            share = min(1.0, self.cover * self.whole / float(weights.sum()))
            point, least = few_that_cover(found.instance, share, options)
            surface = surface.without_vertices(np.isin(cells, point.left_out))
            instance = decomposition_of(surface, deadline=deadline).instance
            solution = checked.solve(instance, options)
        if solution.segments is None:
            return None, least
        covered = float(self.areas[surface.colored].sum())
        colors = {sub.color for cell in solution.cells or () for sub in cell.subcells}
        used = sorted({int(surface.colors[color].partition(":")[0]) - 1 for color in colors})
        return Choice(tuple(used), surface, solution, covered / self.whole), least


class _Master:
    """A model that chooses color regions of some set-ups, so that they cover enough."""

    def __init__(
        self,
        asked: _Asked,
        set_ups: Collection[int],
        extra: int,
        number: int | None = None,
    ) -> None:
        """A model that is not built before it is asked.

        Args:
            asked: the regions.
            set_ups: those that may be used.
            extra: what a change-over costs beyond the lift-off that it takes, in thousandths.
            number: of set-ups to be used; None for any.
        """
        self._asked, self._set_ups, self._number = asked, set_ups, number
        self._extra = extra
        self._model: cp_model.CpModel | None = None
        self.least = 0
        """No choice costs less, in thousandths: segments, and ``extra`` for each set-up."""
        self.tried: set[frozenset[int]] = set()

    def _build(self) -> cp_model.CpModel:
        asked, model = self._asked, cp_model.CpModel()
        self._numbers = sorted(asked.regions_of(set(self._set_ups)))
        self._regions = [model.new_bool_var("") for _ in self._numbers]
        self._segments = model.new_int_var(0, len(self._numbers) + len(asked.areas), "")
        model.add(self._segments >= sum(self._regions))
        used = {number: model.new_bool_var("") for number in self._set_ups}
        own: dict[int, list[cp_model.IntVar]] = {number: [] for number in self._set_ups}
        of_vertex: list[list[int]] = [[] for _ in asked.areas]
        for place, (number, literal) in enumerate(zip(self._numbers, self._regions, strict=True)):
            region = asked.regions[number]
            model.add_implication(literal, used[region.set_up])
            own[region.set_up].append(literal)
            for vertex in region.vertices:
                of_vertex[vertex].append(place)
        for number, literals in own.items():
            model.add_bool_or([~used[number], *literals])  # what is set up paints something
        asked.cover_enough(model, self._regions, of_vertex)
        if self._number is not None:
            model.add(sum(used.values()) == self._number)
        model.minimize(_UNIT * self._segments + self._extra * sum(used.values()))
        return model

    def next_choice(self) -> frozenset[int]:
        """The regions that look cheapest.

        Raises:
            OutOfTime: no choice was found in time.
        """
        self._model = self._model or self._build()
        solver = self._asked.run(self._model)
        # A whole number, told in floating point, which has room for it.
        self.least = max(self.least, ceil(solver.best_objective_bound - 0.01))
        pairs = zip(self._numbers, self._regions, strict=True)
        return frozenset(number for number, literal in pairs if solver.value(literal))

    def learn(self, chosen: frozenset[int], least: int) -> None:
        """With these regions, and others that lie within them, there are so many segments.

        A region lies within another one if that has all of its vertices and all of its edges: a
        segment of the one could be a segment of the other.
        """
        assert self._model is not None
        asked = self._asked
        self.tried.add(chosen)
        known = [asked.regions[one] for one in chosen]
        others = [
            literal
            for number, literal in zip(self._numbers, self._regions, strict=True)
            if not any(_within(asked.surfaces, asked.regions[number], other) for other in known)
        ]
        nothing_else = self._model.new_bool_var("")
        self._model.add_bool_or([nothing_else, *others])
        self._model.add(self._segments >= least).only_enforce_if(nothing_else)


def _within(surfaces: Sequence[LabelledSurface], one: Region, other: Region) -> bool:
    """Whether the other region has all vertices and edges of the one."""
    if one is other:
        return True
    if not one.vertices <= other.vertices:
        return False
    return not any(
        other.color in crack.colors
        and {crack.i, crack.j} <= one.vertices
        and one.color not in surfaces[one.set_up].cracked(crack.i, crack.j)
        for crack in surfaces[other.set_up].cracks
    )


def _hardest(places: Iterable[tuple[int, ...]]) -> list[tuple[int, ...]]:
    """Those that have to be covered for all to be: none has all regions of another one."""
    kept: list[tuple[int, tuple[int, ...]]] = []
    for place in sorted(set(places), key=len):
        regions = sum(1 << region for region in place)
        if all(regions & other != other for other, _ in kept):
            kept.append((regions, place))
    return [place for _, place in kept]


def _regions_of(number: int, surface: LabelledSurface, deadline: Deadline) -> list[Region]:
    """The color regions of a set-up."""
    found = decomposition_of(surface, deadline=deadline)
    cells: dict[int, list[int]] = {}
    for vertex, cell in enumerate(found.vertex_cell):
        cells.setdefault(cell, []).append(vertex)
    return [
        Region(number, color, frozenset(vertex for cell in own for vertex in cells[cell]))
        for color, own in color_regions(found.instance)
    ]
