"""``cellcolor.explain``: which limit, obstacle or test costs a lift-off.

Each thing that a scene asks for is relaxed alone, and the scene is solved without it, with proof.
More reach can need more lift-offs, so number and area are told together. For a thing that saves a
lift-off, bisection looks for the least amount that does. Where no single thing does, sets of two
and three are tried: the smallest that do are minimal correction sets, as in the analysis of
constraints that contradict each other (Liffiton and Sakallah, 2008).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np

from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult, StageClock, build_prepared
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.relaxing import (
    TOOL_LENGTH,
    Relaxation,
    built_asking_less,
    relaxations_of,
    without,
)
from cellcolor.questions.answers import Explanation, RelaxedMinimum
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options

_LARGEST_SET = 3

Progress = Callable[[str], None]


def explained(
    prepared: PreparedScene,
    options: Options,
    progress: Progress | None = None,
) -> Explanation:
    """What each thing that a scene asks for costs.

    Args:
        options: deadline, workers and seed of each solve.
        progress: told what is being tried.

    Raises:
        InputError: the scene cannot be built.
        OutOfTime: the deadline came before the scene itself was solved.
    """
    report = progress or (lambda _: None)
    report("the scene as it is")
    asked = _Asked(prepared, options)
    base = asked.base
    alone: dict[Relaxation, RelaxedMinimum] = {}
    amounts: list[RelaxedMinimum] = []
    sets: list[RelaxedMinimum] = []
    complete = True
    try:
        for one in asked.things:
            report(f"without {one.name}")
            alone[one] = asked.without([one])
            if not alone[one].same_as(base):
                for part in one.parts:
                    report(f"without {part.name}")
                    alone[part] = asked.without([part])
        saving = [one for one, row in alone.items() if _saves(row, base)]
        for one in (*saving, TOOL_LENGTH):
            if one.most:
                report(f"how much of {one.name}")
                found = asked.least_amount(one)
                amounts += [found] if _saves(found, base) or one == TOOL_LENGTH else []
        if not saving and (base.lift_offs or 0) > 0:
            sets = asked.smallest_sets(report)
    except OutOfTime:
        complete = False
    rows = sorted(alone.values(), key=_rank)
    return Explanation(
        prepared.scene.name, base, tuple(rows), tuple(amounts), tuple(sets), complete
    )


def _saves(row: RelaxedMinimum, base: RelaxedMinimum) -> bool:
    """Whether it needs fewer lift-offs than are proved to be needed without it."""
    return row.segments is not None and row.segments < base.at_least


def _rank(row: RelaxedMinimum) -> tuple[float, float]:
    return (np.inf if row.segments is None else row.segments, -row.surface_share)


class _Asked:
    """A scene that was built and solved, asked for its minimum without some things.

    Where these are tests only, what they refused is tested again, and nothing else. If nothing more
    is valid then, the scene need not be solved either.
    """

    def __init__(self, prepared: PreparedScene, options: Options) -> None:
        self._prepared, self._options = prepared, options
        self._built = build_prepared(prepared, self._clock)
        self.base, self.things = self._solved(self._built, ()), relaxations_of(prepared)
        self._named = prepared.arm.named and prepared.scene.tolerance is None

    @property
    def _clock(self) -> StageClock:
        return StageClock(self._options.deadline, None)

    def without(self, what: Sequence[Relaxation]) -> RelaxedMinimum:
        """The scene without these things; a row without a number where it cannot be built then.

        Raises:
            OutOfTime: the deadline came first.
        """
        names, keys = _in_words(what)
        try:
            if not self._named or any(one.reasons is None for one in what):
                relaxed = without(self._prepared, what)
                return self._solved(build_prepared(relaxed, self._clock), what)
            built = self._asking_less(what)
        except InputError as error:
            note = f"it cannot be built: {error}"
            return RelaxedMinimum(names, keys, None, 1, 0.0, 0.0, False, note)
        if _same(built, self._built):
            return replace(self.base, relaxed=names, keys=keys)
        return self._solved(built, what)

    def _asking_less(self, what: Sequence[Relaxation]) -> BuildResult:
        """The build without some tests."""
        reasons = frozenset[str]().union(*(one.reasons or () for one in what))
        relaxed = without(self._prepared, what)
        return built_asking_less(relaxed, self._built, reasons, self._clock)

    def _solved(self, built: BuildResult, what: Sequence[Relaxation]) -> RelaxedMinimum:
        surface = built.surface
        deadline = self._options.deadline
        instance = decomposition_of(surface, deadline=deadline).instance
        areas = surface.vertex_areas
        covered = float(areas[surface.colored].sum())
        reached = ~np.isnan(built.configurations[:, :, 0]).all(axis=1)
        shares = covered / max(float(areas[reached].sum()), covered, 1e-12), covered / areas.sum()
        row = RelaxedMinimum(*_in_words(what), None, 0, *shares, True, "nothing is reached")
        if instance.nothing_to_cover:
            return row
        row = replace(row, at_least=1, proved_for_surface=False, note="")
        try:
            found = checked.solve(instance, self._options)
        except OutOfTime:
            if not what:
                raise
            return row
        least, proved = found.surface_lower_bound, found.proved_for_surface
        return replace(row, segments=found.segments, at_least=least, proved_for_surface=proved)

    def least_amount(self, one: Relaxation) -> RelaxedMinimum:
        """The row of the least amount that saves a lift-off; if none does, of the greatest."""
        tried: dict[float, RelaxedMinimum] = {}

        def enough(amount: float) -> bool:
            row = self.without([one.by(amount)])
            tried[amount] = replace(row, relaxed=(one.said_of(amount),))
            return _saves(row, self.base)

        high = one.most
        if not enough(high):
            return tried[high]
        share, halvings = one.finest
        while high > one.most / share and enough(high / 2):
            high /= 2
        low = high / 2 if high > one.most / share else 0.0
        for _ in range(halvings):
            middle = (low + high) / 2
            low, high = (low, middle) if enough(middle) else (middle, high)
        numbers = [tried[amount].segments or 0 for amount in sorted(tried)]
        falling = all(after <= before for before, after in pairwise(numbers))
        note = f"not enough: {one.said_of(low)}" if low else ""
        if not falling:
            note += "; " * bool(note) + "the number does not fall steadily with the amount"
        return replace(tried[high], note=note)

    def smallest_sets(self, report: Progress) -> list[RelaxedMinimum]:
        """All smallest sets of two or three things that save a lift-off, if there are any.

        Only things that hold a candidate or a link back, once nothing else does, can be in one.
        """
        if not self._named:
            return []
        tests = [one for one in self.things if one.reasons is not None]
        report("what holds anything back")
        free = self._asking_less(tests)
        useful = [
            one
            for one in tests
            if not _same(self._asking_less([other for other in tests if other != one]), free)
        ]
        for size in range(2, _LARGEST_SET + 1):
            found = []
            for chosen in combinations(useful, size):
                report(f"without {' and '.join(one.name for one in chosen)}")
                row = self.without(chosen)
                found += [row] if _saves(row, self.base) else []
            if found:
                return sorted(found, key=_rank)
        return []


def _in_words(what: Sequence[Relaxation]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return tuple(one.name for one in what), tuple(one.key for one in what)


def _same(first: BuildResult, second: BuildResult) -> bool:
    """Whether the same candidates are valid and the same links, hence the same colors."""
    return np.array_equal(first.verdicts.valid, second.verdicts.valid) and np.array_equal(
        first.all_colors.linked, second.all_colors.linked
    )
