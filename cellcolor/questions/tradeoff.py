"""``cellcolor.tradeoff``: for each number of lift-offs the largest share that can be covered.

Every segment lies in one color region, so k segments cover at most what the best k color regions
cover together: a maximum-coverage problem. If the cells that these regions cover, and no others,
can be covered with k segments, this is the most for any division of the surface. Regions may be in
each other's way. Then a CP-SAT model in which cells may be left out finds the most in the search
space ``paper``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.shares import cell_weights
from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.questions.answers import Front, FrontPoint
from cellcolor.solvers import checked
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.interface import Options
from cellcolor.solvers.interruptible import make_cp_solver, solve_interruptibly
from cellcolor.solvers.other_objectives import least_left_out

_WHOLE = 2**40
"""The integer weight of all cells together, for CP-SAT: a share is exact to about 1e-12."""


def front_of(
    instance: Instance,
    options: Options,
    progress: Callable[[str], None] | None = None,
) -> Front:
    """What each number of lift-offs covers at most, up to the fewest that cover everything.

    Args:
        options: deadline, workers and seed; the search space is ``paper``.

    Returns:
        The front. A point that was not proved in time says what is proved.

    Raises:
        OutOfTime: the deadline came before any division of the whole was known.
    """
    report = progress or (lambda _: None)
    report("fewest segments")
    weight = sum(cell_weights(instance)[0])
    asked = _Asked(instance, options)
    if asked.fewest is None:
        if instance.nothing_to_cover:
            return Front(instance, (), weight)
        raise OutOfTime
    points: list[FrontPoint] = []
    bounds: list[tuple[float, bool]] = []
    for segments in range(1, asked.fewest):
        report(f"the most of {segments} segments")
        try:
            point, at_most, holds_for_surface = asked.most_of(segments)
        except OutOfTime:
            break
        bounds.append((at_most, holds_for_surface))
        if point is not None and (not points or point.covered_share > points[-1].covered_share):
            points.append(point)
    if not points or points[-1].covered_share < 1:  # all that has a weight
        points.append(FrontPoint(asked.fewest, 1.0, 1.0, (), asked.whole))
    return Front(instance, tuple(points), weight, tuple(bounds))


def few_that_cover(instance: Instance, share: float, options: Options) -> tuple[FrontPoint, int]:
    """Few segments that cover a share, in less time than a front.

    Only the cells of the best color regions are solved, so there may be fewer.

    Args:
        share: that has to be covered, 0 to 1.

    Returns:
        What was found, and how many segments any division that covers as much has at least.

    Raises:
        OutOfTime: the deadline came before any division of the whole was known.
    """
    asked = _Asked(instance, options)
    if asked.fewest is None:
        raise OutOfTime
    best, least = FrontPoint(asked.fewest, 1.0, 1.0, (), asked.whole), None
    for segments in range(1, asked.whole.surface_lower_bound):
        if segments >= best.segments:
            break
        cells, at_most = asked.most_covered(segments)
        if at_most < share * asked.total:
            continue
        least = segments if least is None else least
        covered, left_out = asked.weight_of(cells) / asked.total, asked.without(cells)
        if covered < share or not left_out:
            continue
        part = asked.solved(instance.without_cells(left_out)[0])
        if part.segments is not None and part.segments < best.segments:
            best = FrontPoint(part.segments, covered, 1.0, left_out, part, False)
    return best, asked.whole.surface_lower_bound if least is None else least


def solved_model(
    model: cp_model.CpModel, deadline: Deadline, workers: int, seed: int, linearization: int = 2
) -> cp_model.CpSolver:
    """The solver with a choice; as for set covers, the bound comes from the linear relaxation.

    Raises:
        OutOfTime: none was found in time.
    """
    solver = make_cp_solver(deadline, workers, seed)
    solver.parameters.linearization_level = linearization
    status, interrupt = solve_interruptibly(solver, model)
    if interrupt is not None:
        raise interrupt
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        raise OutOfTime
    return solver


class _Asked:
    """The question about one graph, what its cells weigh, and a solution of all cells."""

    def __init__(self, instance: Instance, options: Options) -> None:
        self._instance, self._options = instance, options
        weights, _ = cell_weights(instance)
        whole = sum(weights)
        self._weights = [round(weight / whole * _WHOLE) for weight in weights]
        self.total = sum(self._weights)
        self.whole = self.solved(instance)
        self.fewest = self.whole.segments
        self._regions = color_regions(instance)

    def solved(self, instance: Instance) -> Solution:
        """A solution in half of the time that is left."""
        options = replace(self._options, deadline=self._options.deadline.share(0.5))
        return checked.solve(instance, options)

    def without(self, cells: Collection[int]) -> tuple[int, ...]:
        """All other cells, ascending."""
        return tuple(cell for cell in range(len(self._weights)) if cell not in cells)

    def weight_of(self, cells: Iterable[int]) -> int:
        """What some cells weigh."""
        return sum(self._weights[cell] for cell in cells)

    def most_of(self, segments: int) -> tuple[FrontPoint | None, float, bool]:
        """The most that a number of segments can cover.

        Returns:
            The best that was found; the share that no division exceeds; whether that holds for any
            division of the surface.

        Raises:
            OutOfTime: the deadline came before anything was known.
        """
        cells, at_most = self.most_covered(segments)
        if self.whole.surface_lower_bound > segments:
            # Not everything: some cell is left out, and it is left out whole.
            at_most = min(at_most, self.total - min(self._weights))
        found = self._covering(cells, segments)
        holds_for_surface = True
        if found is None or found[0] < at_most:
            paper = least_left_out(self._instance, self._weights, segments, self._options)
            if paper is not None:
                other = self._covering(self.without(paper[0]), segments)
                found = max(filter(None, (found, other)), key=lambda one: one[0], default=None)
                if paper[1] < at_most:
                    at_most, holds_for_surface = paper[1], False
        share = at_most / self.total
        if found is None:
            return None, share, holds_for_surface
        weight, left_out, solution = found
        point = FrontPoint(
            segments, weight / self.total, share, left_out, solution, holds_for_surface
        )
        return point, share, holds_for_surface

    def _covering(
        self, cells: Collection[int], segments: int
    ) -> tuple[int, tuple[int, ...], Solution] | None:
        """A division of some cells into this many segments: weight, left-out cells, and itself."""
        left_out = self.without(cells)
        if not left_out:  # the whole needs more
            return None
        solution = self.solved(self._instance.without_cells(left_out)[0])
        if solution.segments is None or solution.segments > segments:
            return None
        return self.weight_of(cells), left_out, solution

    def most_covered(self, segments: int) -> tuple[Collection[int], int]:
        """The cells that a few color regions cover, of the greatest weight.

        Returns:
            What they cover, all of it, and the weight that no choice exceeds.

        Raises:
            OutOfTime: the deadline came first.
        """
        model = cp_model.CpModel()
        chosen = [model.new_bool_var("") for _ in self._regions]
        covering: list[list[cp_model.IntVar]] = [[] for _ in self._weights]
        for literal, (_, cells) in zip(chosen, self._regions, strict=True):
            for cell in cells:
                covering[cell].append(literal)
        model.add(sum(chosen) <= segments)
        gains = []
        for weight, literals in zip(self._weights, covering, strict=True):
            covered = model.new_bool_var("")
            model.add_bool_or([~covered, *literals])
            gains.append(weight * covered)
        model.maximize(sum(gains))
        solver = solved_model(model, self._options.deadline, workers=1, seed=0)
        found: set[int] = set()
        for literal, (_, cells) in zip(chosen, self._regions, strict=True):
            if solver.value(literal):
                found |= cells
        return found, max(self.weight_of(found), int(solver.best_objective_bound + 0.5))
