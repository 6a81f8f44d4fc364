"""A campaign: thousands of random instances, some of them in each process."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.campaign.agreement import (
    Finding,
    MeshFinding,
    compare_on_mesh,
    compare_solvers,
    complaint,
)
from cellcolor.lab.campaign.cases import Case, draw_case
from cellcolor.lab.campaign.shrink import shrink_instance, shrink_surface
from cellcolor.lab.executors.alone import Ended, Limits
from cellcolor.lab.executors.work import Task, Workers, as_they_end

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
    """A disagreement, made small.

    Attributes:
        message: who says what, of the small one.
        document: the text of its file, an instance or a labelled surface.
    """

    message: str
    document: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one instance.

    Attributes:
        number: within the campaign.
        kind: the family it is from.
        cells: how many it has.
        darts: the most live darts that one of its cells has.
        finding: what the solvers agree on, None when they do not.
        mesh: what a search over the vertices says, None without one.
        wrong: the disagreements.
        seconds: for all of it.
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
    breaks down there is a disagreement.

    Args:
        count: how many; the first ones are the same whatever the count.
        seed: for all random choices.
        time_limit: seconds for each solve.
        workers: who looks at them.
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
    instance, surface = case.instance, case.surface
    wrong: list[Wrong] = []
    finding: Finding | None = None
    mesh: MeshFinding | None = None

    def on_graph() -> None:
        nonlocal finding
        finding = compare_solvers(instance, time_limit)

    if complaint(on_graph) is not None:
        wrong.append(_smallest_instance(case, time_limit))
    if surface is not None:

        def on_mesh(mesh_surface: LabelledSurface = surface) -> None:
            nonlocal mesh
            mesh = compare_on_mesh(mesh_surface, instance, time_limit)

        if complaint(on_mesh) is not None:
            wrong.append(_smallest_surface(case, surface, time_limit))
    return Outcome(
        number,
        case.kind,
        len(instance.cells),
        instance.most_live_darts,
        finding,
        mesh,
        tuple(wrong),
        time.monotonic() - started,
    )


def _smallest_instance(case: Case, time_limit: float) -> Wrong:
    def check(instance: Instance) -> str | None:
        return complaint(lambda: compare_solvers(instance, time_limit))

    small = shrink_instance(case.instance, lambda i: check(i) is not None, SHRINK_SECONDS)
    message = check(small) or "did not happen again"
    return Wrong(message, replace(small, meta=_origin(case, message)).to_json())


def _smallest_surface(case: Case, surface: LabelledSurface, time_limit: float) -> Wrong:
    def check(candidate: LabelledSurface) -> str | None:
        instance = decompose(candidate)
        if not instance.cells:
            return None
        return complaint(lambda: compare_on_mesh(candidate, instance, time_limit))

    small = shrink_surface(surface, lambda s: check(s) is not None, SHRINK_SECONDS)
    message = check(small) or "did not happen again"
    return Wrong(message, replace(small, meta=_origin(case, message)).to_json())


def _origin(case: Case, message: str) -> dict[str, Any]:
    origin = {"seed": case.seed, "number": case.number, "kind": case.kind}
    return {"campaign": origin, "disagreement": message}
