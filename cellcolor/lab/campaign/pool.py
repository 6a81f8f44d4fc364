"""A campaign: thousands of random instances, some of them in each process, and their summary."""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeVar

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.campaign.agreement import (
    Finding,
    MeshFinding,
    attempt,
    compare_on_mesh,
    compare_solvers,
)
from cellcolor.lab.campaign.shrink import shrink_instance, shrink_surface
from cellcolor.lab.families import SMALL
from cellcolor.lab.workers import Task, Workers, as_they_end
from cellcolor.processes import Ended, Limits

KINDS = tuple(SMALL)
"""What a campaign takes its instances from, in turn."""


@dataclass(frozen=True, slots=True)
class Case:
    """One instance of a campaign, made from the campaign's seed and its number in it.

    The kind is one of ``KINDS``, the surface the mesh behind it, None for abstract graphs.
    """

    seed: int
    number: int
    kind: str
    instance: Instance
    surface: LabelledSurface | None


def draw_case(seed: int, number: int) -> Case:
    """Instance ``number`` of the campaign with a seed, of a size that every solver can bear."""
    kind = KINDS[number % len(KINDS)]
    made = SMALL[kind](random.Random(f"campaign {seed} {number}").randrange(2**31))
    if isinstance(made, Instance):
        return Case(seed, number, kind, made, None)
    return Case(seed, number, kind, decompose(made), made)


SHRINK_SECONDS = 60.0
"""Seconds that are spent on making one disagreement small."""

_TOGETHER = 25
"""Instances that are looked at in one process."""

_START_UP = 60.0
"""Seconds for the start of a process, the drawing of its instances, and a busy machine."""

_SOLVES = 10
"""Solves and lists of schemes on one instance, or a few more."""


@dataclass(frozen=True, slots=True)
class Wrong:
    """A disagreement, made small: who says what of it, and its file."""

    message: str
    document: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one instance.

    Attributes:
        darts: the most live darts that one of its cells has.
        finding: what the solvers agree on, None when they do not.
        mesh: what a search over the vertices says, None without one.
        wrong: the disagreements.
    """

    number: int
    kind: str
    cells: int
    darts: int
    finding: Finding | None
    mesh: MeshFinding | None
    wrong: tuple[Wrong, ...]
    seconds: float


def outcomes_of_campaign(
    count: int, seed: int, time_limit: float, workers: Workers
) -> Iterator[Outcome]:
    """What came of each of ``count`` random instances, in the order in which they are done.

    Several are looked at in one process, since its start takes longer than most of them. If it
    breaks down or has to be killed, each of its instances gets a process of its own, and what
    breaks down there is a disagreement. The first instances are the same whatever the count.
    ``time_limit`` is in seconds for each solve.
    """
    together = max(1, min(_TOGETHER, count // workers.slots))
    alone: list[int] = []
    chunks = (range(i, min(i + together, count)) for i in range(0, count, together))
    for numbers, ended in as_they_end(workers, _tasks(chunks, seed, time_limit)):
        if ended.end == "done":
            yield from ended.value
        else:
            alone += numbers
    singles = (range(i, i + 1) for i in sorted(alone))
    for numbers, ended in as_they_end(workers, _tasks(singles, seed, time_limit)):
        if ended.end == "done":
            yield from ended.value
        else:
            yield _lost(draw_case(seed, numbers[0]), ended)


def _tasks(chunks: Iterable[range], seed: int, time_limit: float) -> Iterator[tuple[range, Task]]:
    for numbers in chunks:
        seconds = _START_UP + len(numbers) * (_SOLVES * time_limit + 2 * SHRINK_SECONDS)
        task = Task(_examine_some, (seed, time_limit, tuple(numbers)), Limits(seconds))
        yield numbers, task


def _examine_some(seed: int, time_limit: float, numbers: tuple[int, ...]) -> list[Outcome]:
    return [examine(seed, time_limit, number) for number in numbers]


def _lost(case: Case, ended: Ended) -> Outcome:
    """The outcome of an instance that no process came back from."""
    message = f"no solver may end its process: {ended.end}, {ended.error}"
    wrong = Wrong(message, replace(case.instance, meta=_origin(case, message)).to_json())
    sizes = len(case.instance.cells), case.instance.most_live_darts
    return Outcome(case.number, case.kind, *sizes, None, None, (wrong,), ended.seconds)


def examine(seed: int, time_limit: float, number: int) -> Outcome:
    """Make one instance of a campaign, and hold the solvers to each other on it."""
    started = time.monotonic()
    case = draw_case(seed, number)
    wrong: list[Wrong] = []
    mesh: MeshFinding | None = None

    def on_mesh(surface: LabelledSurface) -> MeshFinding | None:
        instance = decompose(surface)
        return compare_on_mesh(surface, instance, time_limit) if instance.cells else None

    on_graph = partial(compare_solvers, time_limit=time_limit)
    finding, message = attempt(partial(on_graph, case.instance))
    if message is not None:
        wrong.append(_smallest(case, case.instance, on_graph, shrink_instance))
    if case.surface is not None:
        mesh, message = attempt(partial(on_mesh, case.surface))
        if message is not None:
            wrong.append(_smallest(case, case.surface, on_mesh, shrink_surface))
    return Outcome(
        number=number,
        kind=case.kind,
        cells=len(case.instance.cells),
        darts=case.instance.most_live_darts,
        finding=finding,
        mesh=mesh,
        wrong=tuple(wrong),
        seconds=time.monotonic() - started,
    )


_Subject = TypeVar("_Subject", Instance, LabelledSurface)


def _smallest(
    case: Case,
    subject: _Subject,
    check: Callable[[_Subject], object],
    shrink: Callable[[_Subject, Callable[[_Subject], bool], float], _Subject],
) -> Wrong:
    """A disagreement on an instance or a surface, made small."""

    def message(candidate: _Subject) -> str | None:
        return attempt(partial(check, candidate))[1]

    small = shrink(subject, lambda candidate: message(candidate) is not None, SHRINK_SECONDS)
    said = message(small) or "did not happen again"
    return Wrong(said, replace(small, meta=_origin(case, said)).to_json())


def _origin(case: Case, message: str) -> dict[str, Any]:
    origin = {"seed": case.seed, "number": case.number, "kind": case.kind}
    return {"campaign": origin, "disagreement": message}


_BINS = {1: "1", 2: "2", 4: "3-4", 6: "5-6", 9: "7-9", 16: "10-16", 99: "17-99", 999: "100-999"}
"""The ranges of values by their greatest."""


@dataclass(slots=True)
class Tally:
    """Counts, of one family or of all together."""

    instances: int = 0
    proved: int = 0  # of these, with one minimum that every solver proved
    scheme_sets: int = 0  # whose sets of optimal schemes are the same
    always_cut: int = 0  # of these, with a cutting path in every optimum
    meshes: int = 0  # compared with a search over the vertices of the mesh
    meshes_alike: int = 0  # of these, with as many segments in both
    disagreements: int = 0
    seconds: float = 0.0  # of all processes together

    def add(self, outcome: Outcome) -> None:
        """Count one more."""
        finding, mesh = outcome.finding, outcome.mesh
        self.instances += 1
        self.proved += finding is not None and finding.minimum is not None
        self.scheme_sets += finding is not None and finding.schemes is not None
        self.always_cut += finding is not None and finding.always_cut is True
        self.meshes += mesh is not None
        self.meshes_alike += mesh is not None and mesh.segments == mesh.by_vertices
        self.disagreements += len(outcome.wrong)
        self.seconds += outcome.seconds


@dataclass(slots=True)
class Summary:
    """What a campaign has looked at so far, altogether and for each family."""

    total: Tally = field(default_factory=Tally)
    kinds: dict[str, Tally] = field(default_factory=dict)
    _outcomes: list[Outcome] = field(default_factory=list)

    def add(self, outcome: Outcome) -> None:
        """Count one more."""
        self.total.add(outcome)
        self.kinds.setdefault(outcome.kind, Tally()).add(outcome)
        self._outcomes.append(outcome)

    def histograms(self) -> dict[str, Sequence[tuple[str, int]]]:
        """How hard the instances were: per measure, instances in each range of values."""
        found = [outcome.finding for outcome in self._outcomes if outcome.finding is not None]
        return {
            "cells": _binned(outcome.cells for outcome in self._outcomes),
            "most live darts of a cell": _binned(outcome.darts for outcome in self._outcomes),
            "fewest segments": _binned(finding.minimum for finding in found),
            "optimal schemes": _binned(finding.schemes for finding in found),
        }


def _binned(values: Iterable[int | None]) -> Sequence[tuple[str, int]]:
    beyond = "1000 and more"
    counts = Counter(
        next((name for most, name in _BINS.items() if value <= most), beyond)
        for value in values
        if value is not None
    )
    return [(name, counts[name]) for name in (*_BINS.values(), beyond) if counts[name]]
