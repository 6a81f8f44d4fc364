"""Along which mesh edges the arm stays in a branch, without a jump and valid.

What is linked has to be valid between the vertices as well. Every link is tested at points so close
that no body moves far from one to the next. An edge with an end at the border of the branch's
domain, where limits, contacts and thresholds are near, is tested at points that are close on the
surface as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask, numbered
from cellcolor.configurations.matching import stays_within
from cellcolor.deadline import Deadline
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.smooth import Measure, Probe, follow_edges
from cellcolor.frontend.reach.validity_tests import Verdicts
from cellcolor.memory import batches, chunks

_ROUNDS = 20  # each at least halves a step that is too long; what is left then is a jump

Test = Callable[[Array, Array, NDArray[np.intp]], tuple[Mask, Array]]
"""Points (k, 3), unit tool directions (k, 3) and the rows (k,) of edges that they are on: are the
configurations there valid (k,), and where are the ends of the bodies (ends, k, 3)?"""


def at_domain_border(edges: Index, valid: Mask) -> Mask:
    """Which edges have an end with a neighbor that a branch does not reach, (k, branches).

    Args:
        edges: (k, 2) all mesh edges.
        valid: (n, branches).
    """
    i, j = edges.T
    beside = np.zeros_like(valid)
    np.logical_or.at(beside, i, ~valid[j])
    np.logical_or.at(beside, j, ~valid[i])
    border: Mask = beside[i] | beside[j]
    return border


def strides(first: Iterable[Array], second: Iterable[Array], longest: Array) -> Array:
    """The largest movement (k,) of a body from ends (ends, k, 3) to others, 1 if just allowed.

    No other point of a body's axis moves farther between the two: its displacement is a mean of
    those of the ends.
    """
    squares: Array = np.zeros(1)
    for here, there, allowed in zip(first, second, longest, strict=True):
        moved = there - here
        squares = np.maximum(squares, np.einsum("ij,ij->i", moved, moved) / allowed**2)
    return np.sqrt(squares)


def remains_valid(
    surface: Surface,
    edges: Index,
    branches: NDArray[np.intp],
    pieces: Index,
    ends: Array,
    longest: Array,
    test: Test,
) -> Mask:
    """Whether each branch is valid at points on its mesh edge, (k,).

    Args:
        edges: (k, 2) vertex indices.
        branches: (k,) one of each edge.
        pieces: (k,) the least number of equal parts that each edge is divided into. A part on which
            a body moves farther than it may is cut again.
        ends: (ends, n, branches, 3) of the bodies at the vertices, m.
        longest: (ends,) how far each may move between two points, m.
        test: see :data:`Test`.
    """
    result = np.ones(len(edges), dtype=bool)
    i, j = edges.T
    at_i, at_j = (end[i, branches] for end in ends), (end[j, branches] for end in ends)
    pieces = np.maximum(pieces, np.ceil(strides(at_i, at_j, longest)).astype(int))
    cut = np.flatnonzero(pieces > 1)
    for batch in batches(pieces[cut] + 1):
        # Parts of edges: row, from where to where, what they are cut into, the bodies there.
        rows = cut[batch]
        near, far = (ends[:, vertex[rows], branches[rows]] for vertex in (i, j))
        open_ = [(0, rows, np.zeros(len(rows)), np.ones(len(rows)), pieces[rows], near, far)]
        while open_:
            rounds, rows, low, high, count, near, far = open_.pop()
            if rounds == _ROUNDS:
                result[rows] = False
                continue
            part, number = numbered(count + 1)
            inner = (number > 0) & (number < count[part])
            row, way = rows[part], low[part] + (high - low)[part] * number / count[part]
            places = np.empty((len(near), len(row), 3))
            places[:, number == 0], places[:, number == count[part]] = near, far
            at = row[inner]
            points = along_edges(surface, edges[at], way[inner])
            valid, places[:, inner] = test(*points, at)
            result[at[~valid]] = False
            stride = strides(places[:, :-1], places[:, 1:], longest)
            here = np.flatnonzero((number[1:] > 0) & (stride > 1) & result[row[1:]])
            rows, low, high = row[here], way[here], way[here + 1]
            near, far = places[:, here], places[:, here + 1]
            count = np.ceil(stride[here]).astype(int)
            open_ += [
                (rounds + 1, rows[p], low[p], high[p], count[p], near[:, p], far[:, p])
                for p in batches(count + 1)
            ]
    return result


def link(
    surface: Surface,
    edges: Index,
    verdicts: Verdicts,
    measure: Measure,
    limits: tuple[Array, Array] | None,
    probe: Probe,
) -> Mask:
    """Whether the two configurations of a branch on an edge's ends are continuous, (k, branches).

    False where one of the ends has no valid configuration of that branch. Otherwise the branch is
    followed along the edge, see :mod:`cellcolor.frontend.reach.smooth`.

    Args:
        edges: (k, 2) vertex indices.
        limits: lower and upper (joints,) in rad or m, which the motion has to keep.
        probe: see :data:`~cellcolor.frontend.reach.smooth.Probe`; called with points in between.
    """
    i, j = edges.T
    linked: Mask = verdicts.valid[i] & verdicts.valid[j]
    rows, branches = np.nonzero(linked)
    start, end = (verdicts.configurations[side[rows], branches] for side in (i, j))
    at_start, at_end = (verdicts.determinants[side[rows], branches] for side in (i, j))
    ends, determinants = (start, end), (at_start, at_end)
    motions = follow_edges(surface, edges[rows], branches, ends, determinants, measure, probe)
    smooth = motions.smooth
    if limits is not None:
        moved = motions.lowest, motions.highest
        smooth = smooth & stays_within(limits, start, *moved, measure.periods)
    linked[rows, branches] = smooth
    return linked


def continuous_along(
    prepared: PreparedScene, edges: Index, verdicts: Verdicts, deadline: Deadline
) -> Mask:
    """Whether each branch moves along mesh edges (k, 2) without a jump and within the joint limits,
    (k, branches)."""
    robot = prepared.robot
    limits = (robot.lower, robot.upper) if prepared.setup.constraints.collision else None
    linked = np.zeros((len(edges), verdicts.valid.shape[1]), dtype=bool)
    probe = partial(prepared.arm.probe, deadline=deadline)
    for part in chunks(len(edges), linked.shape[1]):
        deadline.check()
        linked[part] = link(
            prepared.surface, edges[part], verdicts, prepared.arm.measure, limits, probe
        )
    return linked


def valid_along(
    prepared: PreparedScene,
    verdicts: Verdicts,
    continuous: Mask,
    deadline: Deadline,
    known: tuple[Mask, Mask] | None = None,
) -> Mask:
    """Which of the continuous links (edges, branches) are valid between the vertices as well.

    All of them, if the setup does not ask for it (``validity_spacing_m``).

    Args:
        known: the result of another scene on this surface, and what is valid at the vertices there.
            A link that was valid is tested again only where its points differ.
    """
    spacing = prepared.setup.continuity.validity_spacing_m
    if spacing is None:
        return continuous
    surface, linked = prepared.surface, continuous.copy()
    edges = surface.mesh.edges
    near_border, asked = at_domain_border(edges, verdicts.valid), continuous
    if known is not None:
        # Which points of an edge are tested depends on what is valid at the neighbors of its ends.
        before, valid_before = known
        asked = continuous & (~before | (near_border != at_domain_border(edges, valid_before)))
    rows_asked = np.flatnonzero(asked.any(axis=1))
    for part in chunks(len(rows_asked) * prepared.setup.constraints.collision):
        deadline.check()
        rows = rows_asked[part]
        linked[rows] &= prepared.tip.free_along(surface, edges[rows])[:, None]
    counts = np.maximum(np.ceil(surface.lengths(edges) / spacing).astype(int), 2)
    rows, branches = np.nonzero(linked & asked)
    pieces = np.where(near_border[rows, branches], counts[rows], 1)

    def test(points: Array, directions: Array, at: Index) -> tuple[Mask, Array]:
        found = prepared.judge(prepared.arm.follow(points, directions, branches[at]), deadline)
        return found.valid, found.tracked

    longest = prepared.judge.tracked_steps
    linked[rows, branches] = remains_valid(
        surface, edges[rows], branches, pieces, verdicts.tracked, longest, test
    )
    return linked
