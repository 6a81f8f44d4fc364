"""Which set-ups to use: few that cover enough, and among these the ones with the fewest segments.

A set-up is the same surface as another placement, or another arm, labels it. The colors of several
set-ups stand side by side on one labelled surface; no color of one leads on into a color of
another, so the ordinary solver proves its minimum. Which set-ups these are is settled in turns
(logic-based Benders decomposition, docs/setups.md). A master model chooses set-ups and color
regions that cover enough; every segment lies in one region of one set-up, so at least so many are
needed. The surface with the colors of these regions alone is solved, which is quick. What it needs
in truth the master learns, for these regions and all that lie within them, and chooses others,
until none of those could be better.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from ortools.sat.python import cp_model

from cellcolor.arrays import Mask
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.solution import Solution
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.questions.tradeoff import few_that_cover
from cellcolor.solvers import checked
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.interface import PORTFOLIO, Options
from cellcolor.solvers.interruptible import make_cp_solver, solve_interruptibly

_WHOLE = 2**40
"""What all vertices weigh together as integers, for CP-SAT: a share is told to 1e-12."""
_PRICE_UNIT = 1000
"""Prices are told to a thousandth of a lift-off."""
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Choice:
    """Set-ups that cover enough, and how.

    Attributes:
        set_ups: their numbers, ascending.
        surface: colors of set-ups side by side, without what is left out.
        solution: of that surface, which the checker has passed.
        covered_share: of the area that any set-up reaches, 0 to 1.
        fewest_set_ups: no fewer set-ups cover enough.
        at_least_segments: with as many set-ups, no division has fewer segments.
        proved: whether no other choice is better, whatever the division of the surface.
    """

    set_ups: tuple[int, ...]
    surface: LabelledSurface
    solution: Solution
    covered_share: float
    fewest_set_ups: int = 1
    at_least_segments: int = 1
    proved: bool = False


@dataclass(frozen=True, eq=False)
class _Region:
    """A color region of a set-up: one color, connected over mesh edges that are not cracks."""

    set_up: int
    color: int
    vertices: frozenset[int]


def side_by_side(
    surfaces: Sequence[LabelledSurface], regions: Collection[_Region]
) -> LabelledSurface:
    """One surface with the colors of some regions; before a color's name is its set-up's number.

    Args:
        surfaces: of all set-ups, on one mesh.
        regions: those that may be painted.
    """
    first = surfaces[0]
    names: list[str] = []
    colors: list[list[int]] = [[] for _ in first.vertices]
    cracks: dict[tuple[int, int], list[int]] = {}
    given_up: set[int] = set()
    inside: dict[tuple[int, int], set[int]] = {}
    for region in regions:
        inside.setdefault((region.set_up, region.color), set()).update(region.vertices)
    for number, (set_up, color) in enumerate(sorted(inside)):
        own, vertices = surfaces[set_up], inside[set_up, color]
        names.append(f"{set_up + 1}: {own.colors[color]}")
        for vertex in vertices:
            colors[vertex].append(number)
        for crack in own.cracks:
            if color in crack.colors and {crack.i, crack.j} <= vertices:
                cracks.setdefault((crack.i, crack.j), []).append(number)
        given_up |= set(own.given_up)
    return LabelledSurface(
        first.name,
        tuple(names),
        first.vertices,
        first.faces,
        tuple(map(tuple, colors)),
        tuple(Crack(i, j, tuple(own)) for (i, j), own in cracks.items()),
        given_up=tuple(vertex for vertex in sorted(given_up) if not colors[vertex]),
    )


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
        change_over: what a change from one set-up to the next costs, in lift-offs, 1 or more; None
            for the fewest set-ups first, whatever that costs in lift-offs.
        options: deadline, workers and seed; the search space is ``paper``.
        progress: told what is being done.

    Raises:
        InputError: nothing is reached.
        OutOfTime: the deadline came before there was any choice.
    """
    report = progress or (lambda _: None)
    asked = _Asked(surfaces, cover, options)
    report("the fewest set-ups")
    master = _Master(asked, 1.0 if change_over is None else change_over)
    fewest = master.fewest_set_ups()
    if change_over is None:
        master.insist_on(fewest)
    best: Choice | None = None
    tried: set[frozenset[int]] = set()
    try:
        while best is None or master.least < master.cost(best) - _SAME:
            chosen = master.next_choice()
            report(f"choice {len(tried) + 1}, at least {master.least:g} segments")
            if chosen in tried or not asked.everything:
                # Its regions alone are not enough, or not what has to be covered: all of the same
                # set-ups.
                chosen = asked.regions_of({asked.regions[one].set_up for one in chosen})
                if chosen in tried:  # no solver knows better
                    break
            tried.add(chosen)
            solved, least = asked.solved(chosen)
            master.learn(chosen, least)
            if solved is not None and (best is None or master.cost(solved) < master.cost(best)):
                best = solved
    except OutOfTime:
        if best is None:
            raise
    if best is None:
        raise OutOfTime
    proved = master.least >= master.cost(best) - _SAME
    return replace(
        best,
        fewest_set_ups=fewest,
        at_least_segments=(best.solution.segments or 0) if proved else master.least_segments(best),
        proved=proved,
    )


class _Asked:
    """The regions of all set-ups, and what some of them need."""

    def __init__(self, surfaces: Sequence[LabelledSurface], cover: float, options: Options) -> None:
        self.surfaces, self.options = surfaces, options
        self.areas = surfaces[0].vertex_areas
        reached: Mask = np.zeros(len(self.areas), dtype=bool)
        self.regions: list[_Region] = []
        for number, surface in enumerate(surfaces):
            options.deadline.check()
            reached |= [bool(own) for own in surface.vertex_colors]
            self.regions += _regions_of(number, surface, options.deadline)
        self.whole = float(self.areas[reached].sum())
        if not self.whole:
            raise InputError(None, None, "nothing is reached in any of the set-ups")
        self.cover, self.everything = cover, cover >= 1

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
            point, least = few_that_cover(found.instance, share, options, weights.tolist())
            surface = surface.without_vertices(np.isin(cells, point.left_out))
            instance = decomposition_of(surface, deadline=deadline).instance
            solution = checked.solve(instance, options)
        if solution.segments is None:
            return None, least
        covered = float(self.areas[[bool(own) for own in surface.vertex_colors]].sum())
        colors = {sub.color for cell in solution.cells or () for sub in cell.subcells}
        used = sorted({int(surface.colors[color].partition(":")[0]) - 1 for color in colors})
        return Choice(tuple(used), surface, solution, covered / self.whole), least


class _Master:
    """The model that chooses set-ups and color regions that cover enough."""

    def __init__(self, asked: _Asked, price: float) -> None:
        """``price`` is that of a change-over, in lift-offs."""
        self._asked, self._price = asked, price
        self._model = model = cp_model.CpModel()
        self._used = [model.new_bool_var("") for _ in asked.surfaces]
        self._regions = [model.new_bool_var("") for _ in asked.regions]
        self._segments = model.new_int_var(0, len(asked.regions) + len(asked.areas), "")
        model.add(self._segments >= sum(self._regions))
        own: list[list[cp_model.IntVar]] = [[] for _ in asked.surfaces]
        of_vertex: list[list[int]] = [[] for _ in asked.areas]
        for number, (literal, region) in enumerate(zip(self._regions, asked.regions, strict=True)):
            model.add_implication(literal, self._used[region.set_up])
            own[region.set_up].append(literal)
            for vertex in region.vertices:
                of_vertex[vertex].append(number)
        for used, literals in zip(self._used, own, strict=True):
            model.add_bool_or([~used, *literals])  # what is set up paints something
        # Vertices in the same regions are one place with one weight.
        places: Counter[tuple[int, ...]] = Counter()
        for regions, area in zip(of_vertex, asked.areas.tolist(), strict=True):
            if regions:
                places[tuple(regions)] += area
        if asked.everything:
            # A place is covered where another place is that has none but some of its regions.
            hardest = _hardest(places)
            for place in hardest:
                model.add_bool_or([self._regions[region] for region in place])
            # This follows, and prunes where there are many set-ups.
            set_ups = (tuple({asked.regions[region].set_up for region in p}) for p in hardest)
            for numbers in _hardest(set_ups):
                model.add_bool_or([self._used[number] for number in numbers])
        else:
            covered, total = [], 0
            for place, area in places.items():
                weight, one = round(area / asked.whole * _WHOLE), model.new_bool_var("")
                model.add_bool_or([~one, *(self._regions[region] for region in place)])
                covered.append(weight * one)
                total += weight
            model.add(sum(covered) >= round(asked.cover * total))
        self.least = 0.0
        """No choice costs less, in segments and in prices of more than one for change-overs."""

    def cost(self, choice: Choice) -> float:
        """Segments, and what change-overs cost beyond one each."""
        return (choice.solution.segments or 0) + (self._price - 1) * len(choice.set_ups)

    def least_segments(self, choice: Choice) -> int:
        """With as many set-ups no division has fewer."""
        extra = (self._price - 1) * len(choice.set_ups)
        return max(1, int(np.ceil(self.least - extra - _SAME)))

    def fewest_set_ups(self) -> int:
        """No fewer cover enough.

        Raises:
            OutOfTime: that was not proved in time.
        """
        self._model.minimize(sum(self._used))
        solver = self._run()
        if solver.best_objective_bound < solver.objective_value - 0.5:
            raise OutOfTime
        self._model.minimize(
            _PRICE_UNIT * self._segments + round((self._price - 1) * _PRICE_UNIT) * sum(self._used)
        )
        return round(solver.objective_value)

    def insist_on(self, number: int) -> None:
        """Choose so many set-ups from now on."""
        self._model.add(sum(self._used) == number)

    def next_choice(self) -> frozenset[int]:
        """The regions that look cheapest.

        Raises:
            OutOfTime: no choice was found in time.
        """
        solver = self._run()
        self.least = max(self.least, solver.best_objective_bound / _PRICE_UNIT)
        return frozenset(
            number for number, literal in enumerate(self._regions) if solver.value(literal)
        )

    def learn(self, chosen: Collection[int], least: int) -> None:
        """With these regions, and others that lie within them, there are so many segments.

        A region lies within another one if that has all of its vertices and all of its edges: a
        segment of the one could be a segment of the other.
        """
        asked = self._asked
        known = [asked.regions[one] for one in chosen]
        others = [
            literal
            for literal, region in zip(self._regions, asked.regions, strict=True)
            if not any(_within(asked.surfaces, region, other) for other in known)
        ]
        nothing_else = self._model.new_bool_var("")
        self._model.add_bool_or([nothing_else, *others])
        self._model.add(self._segments >= least).only_enforce_if(nothing_else)

    def _run(self) -> cp_model.CpSolver:
        """The solver with a choice."""
        asked = self._asked
        options = asked.options
        solver = make_cp_solver(options.deadline, options.workers or PORTFOLIO, options.seed)
        # By measure, with 200 set-ups of which all have to be covered: 15 s instead of minutes.
        solver.parameters.linearization_level = 0 if asked.everything else 2
        status, interrupt = solve_interruptibly(solver, self._model)
        if interrupt is not None:
            raise interrupt
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            raise OutOfTime
        return solver


def _within(surfaces: Sequence[LabelledSurface], one: _Region, other: _Region) -> bool:
    """Whether a region has all vertices and edges of another one."""
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


def _regions_of(number: int, surface: LabelledSurface, deadline: Deadline) -> list[_Region]:
    """The color regions of a set-up."""
    found = decomposition_of(surface, deadline=deadline)
    cells: dict[int, list[int]] = {}
    for vertex, cell in enumerate(found.vertex_cell):
        cells.setdefault(cell, []).append(vertex)
    return [
        _Region(number, color, frozenset(vertex for cell in own for vertex in cells[cell]))
        for color, own in color_regions(found.instance)
    ]
