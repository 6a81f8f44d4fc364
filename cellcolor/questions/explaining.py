"""``cellcolor.explain``: which limit, obstacle or test costs a lift-off.

Each thing that a scene asks for is relaxed alone, and the scene is solved without it, with proof.
More reach can need more lift-offs, so number and area are told together. For a thing that saves a
lift-off, bisection looks for the least amount that does. Where no single thing does, sets of two
and three are tried: the smallest that do are minimal correction sets, as in the analysis of
constraints that contradict each other (Liffiton and Sakallah, 2008).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import numpy as np

from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult, StageClock, build_prepared
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.relaxing import (
    TOOL_LENGTH,
    Relaxation,
    built_asking_less,
    built_asking_more,
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


@dataclass(frozen=True, eq=False)
class _Known:
    """A solved scene: its build, and the result."""

    built: BuildResult
    row: RelaxedMinimum


class _Asked:
    """A scene whose stages are known, asked for its minimum without some things.

    A relaxed scene is seldom built from scratch (``_solved``). If its things are tests only, it is
    judged from a known scene, with only the tests that differ (``_again``); and if the same
    candidates and links are valid there, it need not be solved either. Known are the scene as it
    is, and the scenes without one thing in which more was valid (``_freer``).
    """

    def __init__(self, prepared: PreparedScene, options: Options) -> None:
        self._prepared, self._options = prepared, options
        self._known = self._solved(build_prepared(prepared, self._clock), ())
        self.base, self.things = self._known.row, relaxations_of(prepared)
        self._quick = prepared.arm.named and prepared.scene.tolerance is None
        # The scene without each thing that was tried alone, where more is valid then.
        self._freer: dict[Relaxation, _Known] = {}

    @property
    def _clock(self) -> StageClock:
        return StageClock(self._options.deadline, None)

    def without(self, what: Sequence[Relaxation]) -> RelaxedMinimum:
        """The scene without these things; a row without a number where it cannot be built then.

        Raises:
            OutOfTime: the deadline came first.
        """
        known, rest = self._nearest(what)
        found = self._relaxed(what, known, rest)
        if self._quick and len(what) == 1 and found.built is not known.built:
            (one,) = what
            if one in self.things and one.reasons is not None:
                self._freer[one] = found
        return found.row

    def _relaxed(
        self, what: Sequence[Relaxation], known: _Known, rest: Sequence[Relaxation]
    ) -> _Known:
        """The scene without these things, from a stricter one that still asks for ``rest``."""
        try:
            if not self._quick or any(one.reasons is None for one in what):
                relaxed = without(self._prepared, what)
                return self._solved(build_prepared(relaxed, self._clock), what)
            return self._again(built_asking_less, known, what, _reasons_of(rest))
        except InputError as error:
            note = f"it cannot be built: {error}"
            row = RelaxedMinimum(*_in_words(what), None, 1, 0.0, 0.0, False, note)
            return replace(known, row=row)

    def _nearest(self, what: Sequence[Relaxation]) -> tuple[_Known, list[Relaxation]]:
        """The known scene to judge from, and those of these things that it still asks for.

        It is the scene without the one thing that frees most, or the scene as it is.
        """
        freer = [one for one in what if one in self._freer]
        if not freer:
            return self._known, list(what)
        first = max(freer, key=lambda one: self._freer[one].built.verdicts.valid.sum())
        return self._freer[first], [one for one in what if one != first]

    def _without_some(self, one: Relaxation, amount: float, less: _Known) -> _Known:
        """The scene with a thing weakened by an amount, judged from one where it is less weak."""
        some = one.by(amount)
        if one in self._freer and some.reasons is None:
            found = self._again(built_asking_more, self._freer[one], [some], _reasons_of([one]))
        else:
            found = self._relaxed([some], less, [some])
        return replace(found, row=replace(found.row, relaxed=(one.said_of(amount),)))

    def _again(
        self,
        built_anew: Callable[[PreparedScene, BuildResult, frozenset[str], StageClock], BuildResult],
        known: _Known,
        what: Sequence[Relaxation],
        reasons: frozenset[str],
    ) -> _Known:
        """The scene without some things, judged from a known one that differs in some tests only.

        Args:
            built_anew: builds with more or with fewer tests.
            reasons: the tests in which the two differ.
        """
        relaxed = without(self._prepared, what)
        found = built_anew(relaxed, known.built, reasons, self._clock)
        if not _same(found, known.built):
            return self._solved(found, what)
        names, keys = _in_words(what)
        return replace(known, row=replace(known.row, relaxed=names, keys=keys))

    def _solved(self, built: BuildResult, what: Sequence[Relaxation]) -> _Known:
        surface = built.surface
        deadline = self._options.deadline
        instance = decomposition_of(surface, deadline=deadline).instance
        areas = surface.vertex_areas
        covered = float(areas[surface.colored].sum())
        reached = ~np.isnan(built.configurations[:, :, 0]).all(axis=1)
        shares = covered / max(float(areas[reached].sum()), covered, 1e-12), covered / areas.sum()
        row = RelaxedMinimum(*_in_words(what), None, 0, *shares, True, "nothing is reached")
        if not instance.nothing_to_cover:
            row = replace(row, at_least=1, proved_for_surface=False, note="")
            try:
                found = checked.solve(instance, self._options)
                least, proved = found.surface_lower_bound, found.proved_for_surface
                row = replace(
                    row, segments=found.segments, at_least=least, proved_for_surface=proved
                )
            except OutOfTime:
                if not what:
                    raise
        return _Known(built, row)

    def least_amount(self, one: Relaxation) -> RelaxedMinimum:
        """The row of the least amount that saves a lift-off; if none does, of the greatest."""
        tried: dict[float, RelaxedMinimum] = {}
        too_little = self._known  # the most of it that was not enough; less is not tried again

        def enough(amount: float) -> bool:
            nonlocal too_little
            found = self._without_some(one, amount, too_little)
            tried[amount] = found.row
            if _saves(found.row, self.base):
                return True
            too_little = found
            return False

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
        if not self._quick:
            return []
        named = [one for one in self.things if one.reasons is not None]
        known, rest = self._nearest(named)
        relaxed = without(self._prepared, named)
        free = built_asking_less(relaxed, known.built, _reasons_of(rest), self._clock)
        report("what holds anything back")
        useful = [one for one in named if self._refuses(one, named, free)]
        doubtful = [one for one in named if one not in useful]
        useful += self._cutting(doubtful, named, free)
        useful.sort(key=named.index)
        for size in range(2, _LARGEST_SET + 1):
            found = []
            for chosen in combinations(useful, size):
                report(f"without {' and '.join(one.name for one in chosen)}")
                row = self.without(chosen)
                found += [row] if _saves(row, self.base) else []
            if found:
                return sorted(found, key=_rank)
        return []

    def _refuses(self, one: Relaxation, things: Sequence[Relaxation], free: BuildResult) -> bool:
        """Whether a thing alone refuses a candidate that is valid without any of the things."""
        only = without(self._prepared, [other for other in things if other != one])
        test, valid = only.judge.only(_reasons_of([one])), free.verdicts.valid
        verdicts = test(free.configurations[valid], self._options.deadline)
        return bool((verdicts.reasons != VALID).any())

    def _cutting(
        self, some: Sequence[Relaxation], things: Sequence[Relaxation], free: BuildResult
    ) -> list[Relaxation]:
        """Those of some things that refuse no candidate and cut a link, once nothing else does.

        They are tested together first: if all together cut nothing, none of them does alone.
        """
        if not some:
            return []
        only = without(self._prepared, [other for other in things if other not in some])
        held = built_asking_more(only, free, _reasons_of(some), self._clock)
        if _same(held, free):
            return []
        if len(some) == 1:
            return list(some)
        half = len(some) // 2
        return [x for part in (some[:half], some[half:]) for x in self._cutting(part, things, free)]


def _reasons_of(what: Sequence[Relaxation]) -> frozenset[str]:
    return frozenset[str]().union(*(one.reasons or () for one in what))


def _in_words(what: Sequence[Relaxation]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return tuple(one.name for one in what), tuple(one.key for one in what)


def _same(first: BuildResult, second: BuildResult) -> bool:
    """Whether the same candidates are valid and the same links, hence the same colors."""
    return np.array_equal(first.verdicts.valid, second.verdicts.valid) and np.array_equal(
        first.all_colors.linked, second.all_colors.linked
    )
