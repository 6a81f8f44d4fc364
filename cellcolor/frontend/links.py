"""Along which mesh edges the arm stays in a branch, without a jump and valid."""

from __future__ import annotations

from functools import partial

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.between import at_domain_border, remains_valid
from cellcolor.frontend.reach.continuity import link
from cellcolor.frontend.reach.validity import Verdicts
from cellcolor.memory import chunks


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
    edges = surface.edges()
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
