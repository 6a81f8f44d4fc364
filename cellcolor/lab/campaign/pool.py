"""A campaign: thousands of random instances on a pool of processes."""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import resource_tracker
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

__all__ = ["Outcome", "Wrong", "outcomes_of_campaign"]

SHRINK_SECONDS = 60.0
"""Seconds that are spent on making one disagreement small."""


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


def outcomes_of_campaign(count: int, seed: int, time_limit: float, jobs: int) -> Iterator[Outcome]:
    """What came of each of ``count`` random instances, in the order in which they are done.

    Args:
        count: how many; the first ones are the same whatever the count.
        seed: of everything random.
        time_limit: seconds for each solve.
        jobs: processes; with 1 everything happens in this one. More are started from the main
            thread only.
    """
    work = partial(examine, seed, time_limit)
    if jobs == 1:
        yield from map(work, range(count))
        return
    # Not forked: the parent may run threads, and OR-Tools has some of its own.
    context = multiprocessing.get_context("spawn")
    # Ctrl-C goes to the whole process group; only the parent is to act on it, from the start. New
    # processes inherit that the signal is blocked, and here it waits for the end of the block.
    resource_tracker.ensure_running()  # would lift the block when the first process starts
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        pool = context.Pool(jobs)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    with pool:
        yield from pool.imap_unordered(work, range(count), chunksize=4)


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
