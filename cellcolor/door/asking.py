"""``cellcolor.tradeoff`` and ``explain``: what fewer lift-offs cover, and what costs one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.extras import extras_for
from cellcolor.door.subject import (
    Solvable,
    Subject,
    open_subject,
    scene_or_file,
)
from cellcolor.errors import InputError
from cellcolor.questions.front import Front
from cellcolor.questions.places import Place, chosen
from cellcolor.questions.places import left_alone as without
from cellcolor.questions.tradeoff import front_of
from cellcolor.solvers.interface import Options

if TYPE_CHECKING:
    from cellcolor.arrays import Array
    from cellcolor.frontend import Scene
    from cellcolor.questions.explanation import Explanation

__all__ = ["explain", "tradeoff"]


def tradeoff(
    source: Solvable,
    *,
    weights: Sequence[float] | Array | None = None,
    required: Place | None = None,
    left_alone: Place | None = None,
    time_limit: TimeLimit = None,
    workers: int | None = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Front:
    """For each number of lift-offs the largest share of area that can be covered, with proof.

    Args:
        source: a scene, a labelled surface or an instance: its file, its shipped name, the value.
        weights: of each vertex (n,), as a factor of its area: quality, urgency; None for 1.
        required: vertices that have to be covered: a mask (n,) or a
            :class:`~cellcolor.questions.places.WorldBox`.
        left_alone: vertices that must not be covered, the same kinds; nothing is asked of them.
        time_limit: seconds for all of it, None for as long as it takes.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: of everything random.
        progress: told what is being done.

    Returns:
        The front. Shares are of the area that can be covered and is not left alone.

    Raises:
        InputError: the source cannot be used, or has no surface for weights and places to be on; a
            mask is of another mesh, or a weight is negative or no number.
        OutOfTime: the time limit came before any division was known.
    """
    deadline = Deadline.of(time_limit)
    subject = open_subject(source, deadline, progress)
    if left_alone is not None:
        mask = chosen(subject.surface, left_alone, "left_alone")
        subject = Subject(None, given_surface=without(subject.surface, mask))
    instance = subject.graph(deadline)
    options = Options(deadline=deadline, workers=workers, seed=seed)
    cells: frozenset[int] = frozenset()
    if required is not None:
        mask = chosen(subject.surface, required, "required")
        cells = frozenset(_cells(subject)[mask].tolist()) - {OUTSIDE}
    per_cell = None if weights is None else _weights(subject, instance, weights)
    return front_of(instance, options, weights=per_cell, required=cells, progress=progress)


def explain(
    scene: str | PathLike[str] | Scene,
    *,
    at: Sequence[float] | None = None,
    time_limit: TimeLimit = None,
    workers: int | None = None,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> Explanation:
    """What costs a lift-off: the minimum with each limit, obstacle and test relaxed, with proof.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        at: (3,) a point in the world, m; what each branch does at the vertex nearest to it is told
            as well.
        time_limit: seconds for all of it, None for as long as it takes.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: of everything random.
        progress: told what is being tried.

    Returns:
        Rows, ranked. Shares are of the whole surface, since what can be reached changes.

    Raises:
        InputError: the scene cannot be used, nothing of it is reached, or the point is none.
        OutOfTime: the time limit came before the scene itself was solved.
    """
    deadline = Deadline.of(time_limit)
    scene = scene_or_file(scene)
    point = None
    if at is not None:
        point = np.asarray(at, dtype=float)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(None, "at", "must be three numbers x, y, z in m")
    with extras_for("the front end"):
        from cellcolor.frontend.prepared import prepare
        from cellcolor.questions.explaining import explained

    options = Options(deadline=deadline, workers=workers, seed=seed)
    return explained(prepare(scene, deadline), options, point, progress)


def _cells(subject: Subject) -> np.ndarray:
    """The cell of each vertex, ``OUTSIDE`` where it has none."""
    return np.array(subject.decomposition.vertex_cell, dtype=np.int64)


def _weights(subject: Subject, instance: Instance, given: Sequence[float] | Array) -> list[float]:
    """What each cell weighs, of the weights of its vertices by their areas."""
    own = np.asarray(given, dtype=float)
    areas = subject.surface.vertex_areas
    if own.shape != areas.shape:
        message = f"must be one for each of {len(areas)} vertices: are they of another mesh?"
        raise InputError(None, "weights", message)
    bad = np.flatnonzero(~((own >= 0) & np.isfinite(own)))
    if len(bad):
        text = f"must be a number from 0 on, is {own[bad[0]]:g}"
        raise InputError(None, f"weights[{bad[0]}]", text)
    cell = _cells(subject)
    inside = cell != OUTSIDE
    found = np.bincount(cell[inside], (own * areas)[inside], len(instance.cells))
    return [float(weight) for weight in found]
