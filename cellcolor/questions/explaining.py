"""``cellcolor.explain``: which limit, obstacle or test costs a lift-off.

Each thing that a scene asks for is relaxed alone, and the scene solved without it, with proof. More
reach can need more lift-offs, so number and area are told together. Of what saves a lift-off the
least amount that does is looked for by bisection. Where no single thing does, sets of two and three
are tried: the smallest that do are minimal correction sets, as in the analysis of constraints that
contradict each other (Liffiton and Sakallah, 2008).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import labelled
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.relaxing import Relaxation, relaxations_of, without
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import Judged, Stages, judged, judged_again, with_finer_borders
from cellcolor.questions.explanation import BranchHere, Explanation, RelaxedMinimum
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options

_HALVINGS = 4  # so an amount is known to a sixteenth of itself or better
_SMALLEST = 512  # a share of the greatest amount that less is not asked about
_LARGEST_SET = 3

Progress = Callable[[str], None]


def explained(
    prepared: PreparedScene,
    options: Options,
    at: Array | None = None,
    progress: Progress | None = None,
) -> Explanation:
    """What each thing that a scene asks for costs.

    Args:
        prepared: the scene.
        options: deadline, workers and seed of each solve.
        at: (3,) a point in the world, m; what each branch does at the vertex nearest to it is told
            as well.
        progress: told what is being tried.

    Raises:
        InputError: the scene cannot be built.
        OutOfTime: the deadline came before the scene itself was solved.
    """
    report = progress or (lambda _: None)
    report("the scene as it is")
    asked = _Asked(prepared, options)
    base = asked.base
    here = () if at is None else _reasons_at(*asked.built, at)
    alone: dict[Relaxation, RelaxedMinimum] = {}
    amounts: list[RelaxedMinimum] = []
    sets: list[RelaxedMinimum] = []
    complete = True
    try:
        for one in relaxations_of(prepared):
            report(f"without {one.name}")
            alone[one] = asked.without([one])
            if not alone[one].same_as(base):
                for part in one.parts(prepared):
                    report(f"without {part.name}")
                    alone[part] = asked.without([part])
        saving = [one for one, row in alone.items() if _saves(row, base)]
        for one in saving:
            if one.unit is not None:
                report(f"how much of {one.name}")
                found = asked.least_amount(one)
                amounts += [] if found is None else [found]
        if not saving and (base.lift_offs or 0) > 0:
            sets = asked.smallest_sets(relaxations_of(prepared), report)
    except OutOfTime:
        complete = False
    rows = sorted(alone.values(), key=_rank)
    return Explanation(
        prepared.scene.name, base, tuple(rows), tuple(amounts), tuple(sets), here, complete
    )


def _saves(row: RelaxedMinimum, base: RelaxedMinimum) -> bool:
    """Whether it needs fewer lift-offs than are proved to be needed without it."""
    return row.segments is not None and row.segments < base.at_least


def _rank(row: RelaxedMinimum) -> tuple[float, float]:
    return (np.inf if row.segments is None else row.segments, -row.covered_share)


class _Asked:
    """A scene whose stages are known, asked for its minimum without some things."""

    def __init__(self, prepared: PreparedScene, options: Options) -> None:
        self._prepared, self._options = prepared, options
        self._coarse: Judged = judged(prepared, self._clock)
        self.built = with_finer_borders(prepared, self._clock, self._coarse)
        self.base = self._solved(*self.built, ())

    @property
    def _clock(self) -> StageClock:
        return StageClock(self._options.deadline, None)

    def without(self, what: Sequence[Relaxation], note: str = "") -> RelaxedMinimum:
        """The scene without these things; a row without a number where it cannot be built then.

        Raises:
            OutOfTime: the deadline came first.
        """
        names, keys = _in_words(what)
        prepared, known = without(self._prepared, what), self._coarse.stages
        in_place = prepared.scene.tolerance is None
        try:
            if known.named and in_place and all(one.reasons is not None for one in what):
                found = judged_again(prepared, self._coarse, _reasons_of(what), self._clock)
                if _same(found.stages, known):
                    return replace(self.base, relaxed=names, keys=keys, note=note)
            else:
                found = judged(prepared, self._clock)
            return self._solved(*with_finer_borders(prepared, self._clock, found), what, note)
        except InputError as error:
            return RelaxedMinimum(names, keys, None, 1, 0.0, False, f"it cannot be built: {error}")

    def _solved(
        self,
        prepared: PreparedScene,
        stages: Stages,
        what: Sequence[Relaxation],
        note: str = "",
    ) -> RelaxedMinimum:
        names, keys = _in_words(what)
        surface, _ = labelled(prepared, stages, {})
        deadline = self._options.deadline
        instance = decomposition_of(surface, deadline=deadline).instance
        areas = surface.vertex_areas
        has_color = np.array([bool(own) for own in surface.vertex_colors])
        share = float(areas[has_color].sum() / areas.sum())
        if instance.nothing_to_cover:
            return RelaxedMinimum(names, keys, 0, 0, share, True, note or "nothing is reached")
        try:
            solution = checked.solve(instance, self._options)
        except OutOfTime:
            if not what:
                raise
            return RelaxedMinimum(names, keys, None, 1, share, False, note)
        return RelaxedMinimum(
            names,
            keys,
            solution.segments,
            solution.surface_lower_bound,
            share,
            solution.proved_for_surface,
            note,
        )

    def least_amount(self, one: Relaxation) -> RelaxedMinimum | None:
        """The least amount found that saves a lift-off.

        None where even the greatest amount worth asking about does not do.
        """
        tried: dict[float, RelaxedMinimum] = {}

        def enough(amount: float) -> bool:
            row = self.without([one.by(amount)])
            tried[amount] = replace(row, relaxed=(one.said_of(amount),))
            return _saves(row, self.base)

        high = one.most
        if not enough(high):
            return None
        while high > one.most / _SMALLEST and enough(high / 2):
            high /= 2
        low = high / 2 if high > one.most / _SMALLEST else 0.0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (low, middle) if enough(middle) else (middle, high)
        numbers = [tried[amount].segments or 0 for amount in sorted(tried)]
        falling = all(after <= before for before, after in pairwise(numbers))
        note = f"not enough: {one.said_of(low)}" if low else ""
        if not falling:
            note += "; " * bool(note) + "the number does not fall steadily with the amount"
        return replace(tried[high], note=note)

    def smallest_sets(self, things: Sequence[Relaxation], report: Progress) -> list[RelaxedMinimum]:
        """All smallest sets of two or three things that save a lift-off, if there are any.

        Only things that hold a candidate or a link back, once nothing else does, can be in one.
        """
        named = [one for one in things if one.reasons is not None]
        if not self._coarse.stages.named:
            return []
        free = self._freed(named)
        useful = []
        for one in named:
            report(f"whether {one.name} holds anything back")
            if not _same(self._freed([other for other in named if other != one]), free):
                useful.append(one)
        for size in range(2, _LARGEST_SET + 1):
            found = []
            for chosen in combinations(useful, size):
                report(f"without {' and '.join(one.name for one in chosen)}")
                row = self.without(chosen)
                found += [row] if _saves(row, self.base) else []
            if found:
                return sorted(found, key=_rank)
        return []

    def _freed(self, what: Sequence[Relaxation]) -> Stages:
        """The stages on the same surface without things that need not be asked about anew."""
        prepared = without(self._prepared, what)
        return judged_again(prepared, self._coarse, _reasons_of(what), self._clock).stages


def _reasons_of(what: Sequence[Relaxation]) -> frozenset[str]:
    return frozenset[str]().union(*(one.reasons or () for one in what))


def _in_words(what: Sequence[Relaxation]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return tuple(one.name for one in what), tuple(one.key for one in what)


def _same(first: Stages, second: Stages) -> bool:
    """Whether the same candidates are valid and the same links, hence the same colors."""
    return np.array_equal(first.candidates.valid, second.candidates.valid) and np.array_equal(
        first.links.linked, second.links.linked
    )


def _reasons_at(prepared: PreparedScene, stages: Stages, point: Array) -> tuple[BranchHere, ...]:
    """What each branch does at the vertex nearest to a point (3,), and where its color ends.

    Args:
        prepared: the scene.
        stages: of its surface.
        point: in the world, m.
    """
    vertices, coloring = prepared.surface.vertices, stages.cleaned.coloring
    away = np.linalg.norm(vertices - point, axis=1)
    here = int(np.argmin(away))
    from_here = np.linalg.norm(vertices - vertices[here], axis=1)
    rows = []
    for branch, name in enumerate(stages.branches):
        own = coloring.node_color[:, branch]
        if own[here] < 0:
            fails = _failing(prepared, stages, here, branch)
            rows.append(BranchHere(name, None, fails))
            continue
        color = coloring.names[own[here]]
        other = np.flatnonzero(own != own[here])
        if not len(other):
            rows.append(BranchHere(name, color, ()))
            continue
        nearest = int(other[np.argmin(from_here[other])])
        by = _failing(prepared, stages, nearest, branch)
        rows.append(BranchHere(name, color, (), float(from_here[nearest]), by))
    return tuple(rows)


def _failing(prepared: PreparedScene, stages: Stages, vertex: int, branch: int) -> tuple[str, ...]:
    """All tests that a candidate fails."""
    joints = stages.candidates.configurations[vertex, branch]
    if np.isnan(joints).any():
        return ("no solution",)
    failed = prepared.judge.all_failures(joints[None])
    return tuple(name for name, hit in failed.items() if hit[0])
