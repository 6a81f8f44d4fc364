"""Links: the mesh edges along which the arm stays in a branch, without a jump and valid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.between import at_domain_border, remains_valid
from cellcolor.frontend.reach.continuity import link
from cellcolor.frontend.reach.validity import Candidates
from cellcolor.memory import chunks


@dataclass(frozen=True)
class Links:
    """Which branches lead along which mesh edges.

    Attributes:
        edges: (k, 2) all mesh edges, as vertex indices.
        linked: (k, branches).
        reasons: (k, branches) codes of a test that fails between the vertices, where one is known;
            VALID elsewhere.
    """

    edges: Index
    linked: Mask
    reasons: NDArray[np.uint8]

    @classmethod
    def of(cls, edges: Index, linked: Mask) -> Links:
        """Links, without the reasons of those that are missing."""
        return cls(edges, linked, np.full(linked.shape, VALID, dtype=np.uint8))


def continuous_links(prepared: PreparedScene, candidates: Candidates, deadline: Deadline) -> Links:
    """The links along which a branch moves without a jump and within the joint limits."""
    edges = prepared.surface.edges()
    return Links.of(edges, linked_along(prepared, edges, candidates, deadline))


def linked_along(
    prepared: PreparedScene, edges: Index, candidates: Candidates, deadline: Deadline
) -> Mask:
    """Whether each branch moves along mesh edges (k, 2) without a jump, (k, branches)."""
    robot = prepared.robot
    limits = (robot.lower, robot.upper) if prepared.setup.constraints.collision else None
    linked = np.zeros((len(edges), candidates.valid.shape[1]), dtype=bool)
    probe = partial(prepared.arm.probe, deadline=deadline)
    for part in chunks(len(edges), linked.shape[1]):
        deadline.check()
        linked[part] = link(
            prepared.surface, edges[part], candidates, prepared.arm.measure, limits, probe
        )
    return linked


def valid_links(
    prepared: PreparedScene,
    candidates: Candidates,
    continuous: Links,
    tracked: Array,
    known: tuple[Links, Candidates] | None,
    deadline: Deadline,
    anew: Mask | bool = False,
) -> Links:
    """The links that are valid between the vertices as well.

    Args:
        tracked: (points, n * branches, 3) of the bodies at the vertices, m.
        known: the result and the candidates of another scene on this surface, to be taken over.
        anew: (edges, branches) those of the known ones that are tested again.
    """
    surface, edges = prepared.surface, continuous.edges
    linked = continuous.linked.copy()
    reasons = np.full(linked.shape, VALID, dtype=np.uint8)
    near_border = at_domain_border(edges, candidates.valid)
    new = np.ones(linked.shape, dtype=bool)
    if known is not None:
        # Which points of an edge are tested depends on what is valid at the neighbors of its ends.
        before, its_candidates = known
        new = anew | (near_border != at_domain_border(edges, its_candidates.valid))
        linked &= new | before.linked
        reasons[~new] = before.reasons[~new]
    asked = np.flatnonzero((linked & new).any(axis=1))
    for part in chunks(len(asked) * prepared.setup.constraints.collision):
        deadline.check()
        rows = asked[part]
        linked[rows] &= prepared.workplace.tip.free_along(surface, edges[rows])[:, None]
    spacing = prepared.setup.continuity.validity_spacing_m
    assert spacing is not None  # the caller has checked
    counts = np.maximum(np.ceil(surface.lengths(edges) / spacing).astype(int), 2)
    at_vertices = tracked.reshape(-1, *candidates.valid.shape, 3)
    longest = prepared.judge.tracked_steps
    all_rows, all_branches = np.nonzero(linked & new)

    for part in chunks(len(all_rows)):
        deadline.check()
        rows, branches = all_rows[part], all_branches[part]
        pieces = np.where(near_border[rows, branches], counts[rows], 1)

        def test(
            points: Array, directions: Array, at: Index, own: Index = rows, of: Index = branches
        ) -> tuple[Mask, Array]:
            found = prepared.arm.follow(points, directions, of[at])
            verdicts = prepared.judge(found, deadline)
            valid = np.asarray(verdicts.reasons == VALID)
            failed = at[~valid]
            reasons[own[failed], of[failed]] = verdicts.reasons[~valid]
            return valid, verdicts.tracked

        linked[rows, branches] = remains_valid(
            surface, edges[rows], branches, pieces, at_vertices, longest, test
        )

    return Links(edges, linked, reasons)
