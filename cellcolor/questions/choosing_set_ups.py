"""Which set-ups to use: few that cover enough, and among these the ones with the fewest segments.

A set-up is the same surface as another placement, or another arm, labels it. The colors of several
set-ups stand side by side on one labelled surface; no color of one leads on into a color of
another, so the ordinary solver proves its minimum. Which set-ups these are is settled in turns
(logic-based Benders decomposition). A master model chooses set-ups and color regions that cover
enough. Every segment lies in one region of one set-up, so it cannot need fewer segments than the
master has regions. The set-ups that it chose are solved, which says what they need in truth, and it
chooses others, until none of those could be better.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
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


def side_by_side(surfaces: Sequence[LabelledSurface], numbers: Sequence[int]) -> LabelledSurface:
    """One surface with the colors of some set-ups, the first number before a color is its set-up's.

    Args:
        surfaces: of all set-ups, on one mesh.
        numbers: of those that are used, from 0.
    """
    first = surfaces[numbers[0]]
    names: list[str] = []
    colors: list[tuple[int, ...]] = [()] * len(first.vertices)
    cracks: dict[tuple[int, int], list[int]] = {}
    given_up: set[int] = set()
    for number in numbers:
        own, offset = surfaces[number], len(names)
        names += [f"{number + 1}: {name}" for name in own.colors]
        colors = [
            (*before, *(color + offset for color in more))
            for before, more in zip(colors, own.vertex_colors, strict=True)
        ]
        for crack in own.cracks:
            cracks.setdefault((crack.i, crack.j), []).extend(c + offset for c in crack.colors)
        given_up |= set(own.given_up)
    return LabelledSurface(
        first.name,
        tuple(names),
        first.vertices,
        first.faces,
        tuple(colors),
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
    master = _Master(surfaces, cover, options)
    report("the fewest set-ups")
    fewest = master.fewest_set_ups()
    price = 1.0 if change_over is None else change_over
    number = fewest if change_over is None else None
    best: tuple[float, Choice] | None = None
    # Of what was tried, and of what was not, no choice costs less.
    least_tried, least_untried = np.inf, 0.0
    try:
        while (found := master.next_choice(number, price)) is not None:
            least_untried, chosen = found
            if best is not None and least_untried >= best[0] - _SAME:
                break
            report(f"choice {len(master.tried) + 1}")
            solved, least = _solved(surfaces, chosen, master, options)
            master.tried.append(chosen)
            least_tried = min(least_tried, least + (price - 1) * len(chosen))
            if solved is None:
                continue
            cost = (solved.solution.segments or 0) + (price - 1) * len(solved.set_ups)
            if best is None or cost < best[0]:
                best = cost, solved
        if found is None:
            least_untried = np.inf
    except OutOfTime:
        if best is None:
            raise
    if best is None:
        raise OutOfTime
    cost, choice = best
    at_least = min(least_tried, least_untried)
    least = int(np.ceil(at_least - (price - 1) * len(choice.set_ups) - _SAME))
    proved = at_least >= cost - _SAME
    if proved:
        least = choice.solution.segments or 0
    return replace(choice, fewest_set_ups=fewest, at_least_segments=max(1, least), proved=proved)


def _solved(
    surfaces: Sequence[LabelledSurface],
    chosen: tuple[int, ...],
    master: _Master,
    options: Options,
) -> tuple[Choice | None, int]:
    """Some set-ups solved: the best division that covers enough, and what any division needs."""
    surface = side_by_side(surfaces, chosen)
    colored = np.array([bool(own) for own in surface.vertex_colors])
    reached = float(master.areas[colored].sum())
    share = min(1.0, master.needed / reached)
    found = decomposition_of(surface, deadline=options.deadline)
    options = replace(options, deadline=options.deadline.share(0.5))
    if share > 1 - 1e-9:
        solution = checked.solve(found.instance, options)
        least = solution.surface_lower_bound
    else:
        cells = np.array(found.vertex_cell)
        inside = cells != OUTSIDE
        weights = np.bincount(
            cells[inside], master.areas[inside], minlength=len(found.instance.cells)
        )
        point, least = few_that_cover(found.instance, share, options, weights.tolist())
        surface = surface.without_vertices(np.isin(cells, point.left_out))
        instance = decomposition_of(surface, deadline=options.deadline).instance
        solution = checked.solve(instance, options)
    if solution.segments is None:
        return None, least
    covered = float(master.areas[[bool(own) for own in surface.vertex_colors]].sum())
    used = _used(solution, surface, chosen)
    return Choice(used, surface, solution, covered / master.whole), least


def _used(solution: Solution, surface: LabelledSurface, chosen: tuple[int, ...]) -> tuple[int, ...]:
    """The set-ups that a segment is in."""
    colors = {sub.color for cell in solution.cells or () for sub in cell.subcells}
    numbers = {int(surface.colors[color].partition(":")[0]) - 1 for color in colors}
    return tuple(number for number in chosen if number in numbers)


class _Master:
    """The model that chooses set-ups and color regions."""

    def __init__(self, surfaces: Sequence[LabelledSurface], cover: float, options: Options) -> None:
        self._deadline = deadline = options.deadline
        self._workers, self._seed = options.workers or PORTFOLIO, options.seed
        self.areas = surfaces[0].vertex_areas
        reached: Mask = np.zeros(len(self.areas), dtype=bool)
        self._regions: list[tuple[int, frozenset[int]]] = []
        of_vertex: list[list[int]] = [[] for _ in self.areas]
        for number, surface in enumerate(surfaces):
            deadline.check()
            reached |= [bool(own) for own in surface.vertex_colors]
            for vertices in _regions_of(surface, deadline):
                for vertex in vertices:
                    of_vertex[vertex].append(len(self._regions))
                self._regions.append((number, vertices))
        self.whole = float(self.areas[reached].sum())
        if not self.whole:
            raise InputError(None, None, "nothing is reached in any of the set-ups")
        self.needed = cover * self.whole
        # Vertices in the same regions are one place with one weight.
        weights: Counter[tuple[int, ...]] = Counter()
        for regions, area in zip(of_vertex, self.areas.tolist(), strict=True):
            if regions:
                weights[tuple(regions)] += area
        self._everything = cover >= 1
        # Where everything is covered, so is a place that another place's regions all cover.
        self._places = _hardest(weights) if self._everything else list(weights)
        self._weights = [round(weights[place] / self.whole * _WHOLE) for place in self._places]
        self._enough = round(cover * sum(self._weights))
        self.tried: list[tuple[int, ...]] = []
        self._count = len(surfaces)
        self._least = 0  # what every choice that was not tried costs, in thousandths of a lift-off

    def fewest_set_ups(self) -> int:
        """No fewer cover enough.

        Raises:
            OutOfTime: that was not proved in time.
        """
        model, used, _ = self._model()
        model.minimize(sum(used))
        solver = self._run(model)
        assert solver is not None  # all of them cover everything
        if solver.best_objective_bound < solver.objective_value - 0.5:
            raise OutOfTime
        return round(solver.objective_value)

    def next_choice(self, number: int | None, price: float) -> tuple[float, tuple[int, ...]] | None:
        """What every choice that was not tried costs at least, and the one that looks cheapest.

        Args:
            number: of set-ups; None for any.
            price: of a change-over, in lift-offs.

        Returns:
            None if all were tried.

        Raises:
            OutOfTime: no choice was found in time.
        """
        model, used, regions = self._model()
        if number is not None:
            model.add(sum(used) == number)
        for chosen in self.tried:
            others = [literal for at, literal in enumerate(used) if at not in chosen]
            model.add_bool_or([*others, *(~used[at] for at in chosen)])
        extra = round((price - 1) * _PRICE_UNIT)
        cost = _PRICE_UNIT * sum(regions) + extra * sum(used)
        model.add(cost >= self._least)  # what is tried leaves nothing cheaper
        model.minimize(cost)
        solver = self._run(model)
        if solver is None:
            return None
        self._least = max(self._least, int(np.floor(solver.best_objective_bound + _SAME)))
        chosen = tuple(at for at, literal in enumerate(used) if solver.value(literal))
        return solver.best_objective_bound / _PRICE_UNIT, chosen

    def _model(
        self,
    ) -> tuple[cp_model.CpModel, list[cp_model.IntVar], list[cp_model.IntVar]]:
        """Set-ups and regions that cover enough."""
        model = cp_model.CpModel()
        used = [model.new_bool_var("") for _ in range(self._count)]
        regions = [model.new_bool_var("") for _ in self._regions]
        for literal, (number, _) in zip(regions, self._regions, strict=True):
            model.add_implication(literal, used[number])
        for at, literal in enumerate(used):  # what is set up paints something
            own = [r for r, (number, _) in zip(regions, self._regions, strict=True) if number == at]
            model.add_bool_or([~literal, *own])
        covered = []
        for place, weight in zip(self._places, self._weights, strict=True):
            literals = [regions[region] for region in place]
            if self._everything:
                model.add_bool_or(literals)
                continue
            one = model.new_bool_var("")
            model.add_bool_or([~one, *literals])
            covered.append(weight * one)
        if covered:
            model.add(sum(covered) >= self._enough)
        if self._everything:  # follows from the above, and prunes where there are many set-ups
            number_of = [number for number, _ in self._regions]
            for numbers in _hardest(
                tuple({number_of[region] for region in place}) for place in self._places
            ):
                model.add_bool_or([used[number] for number in numbers])
        return model, used, regions

    def _run(self, model: cp_model.CpModel) -> cp_model.CpSolver | None:
        """The solver with a solution; None if there is none."""
        solver = make_cp_solver(self._deadline, self._workers, self._seed)
        # By measure, with 200 set-ups of which all have to be covered: 15 s instead of minutes.
        solver.parameters.linearization_level = 0 if self._everything else 2
        status, interrupt = solve_interruptibly(solver, model)
        if interrupt is not None:
            raise interrupt
        if status == cp_model.INFEASIBLE:
            return None
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            raise OutOfTime
        return solver


def _hardest(places: Iterable[tuple[int, ...]]) -> list[tuple[int, ...]]:
    """Those that have to be covered for all to be: none has all regions of another one."""
    kept: list[tuple[int, tuple[int, ...]]] = []
    for place in sorted(set(places), key=len):
        regions = sum(1 << region for region in place)
        if all(regions & other != other for other, _ in kept):
            kept.append((regions, place))
    return [place for _, place in kept]


def _regions_of(surface: LabelledSurface, deadline: Deadline) -> list[frozenset[int]]:
    """The vertices of each color region."""
    found = decomposition_of(surface, deadline=deadline)
    cells: dict[int, list[int]] = {}
    for vertex, cell in enumerate(found.vertex_cell):
        cells.setdefault(cell, []).append(vertex)
    return [
        frozenset(vertex for cell in own for vertex in cells[cell])
        for _, own in color_regions(found.instance)
    ]
