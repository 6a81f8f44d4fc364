"""An arm whose solutions have no names: continuity distinguishes them and arranges them in sheets.

From here on a sheet serves as a branch: later stages see no difference.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.between import Test
from cellcolor.frontend.reach.sheets import Linking, Sheets, edges_at_once, sheets_of
from cellcolor.frontend.reach.tracking import Solutions, Tracker
from cellcolor.frontend.reach.validity import NO_SOLUTION, Candidates


@dataclass(frozen=True)
class Nameless:
    """Solutions without names, arranged by continuity.

    Attributes:
        prepared: the scene.
        tracker: follows solutions along mesh edges.
        sheets: which solution each sheet has, and where it is continuous.
        solutions: (n, sheets) of all vertices.
        candidates: the same as branches have it, a sheet each.
        tracked: (points, n * sheets, 3) of the bodies at the vertices, m; NaN without a solution.
    """

    prepared: PreparedScene
    tracker: Tracker
    sheets: Sheets
    solutions: Solutions
    candidates: Candidates
    tracked: Array

    def test_on(self, edges: Index, sheets: Index) -> Test:
        """A test of sheets (k,) on mesh edges (k, 2), for :mod:`cellcolor.frontend.reach.between`.

        It finds a configuration on the way by following the sheet from the nearer end.
        """
        surface = self.prepared.surface

        def test(points: Array, _: Array, at: Index) -> tuple[Mask, Array]:
            ends = edges[at]
            away = np.linalg.norm(surface.vertices[ends] - points[:, None], axis=2)
            ends = np.where((away[:, 0] <= away[:, 1])[:, None], ends, ends[:, ::-1])
            way = away.min(axis=1) / away.sum(axis=1)
            start = self.solutions.take(ends[:, 0], sheets[at])
            joints, _motions = self.tracker.walk(surface, ends, start, way)
            verdicts = self.prepared.judge(joints)
            return np.asarray(verdicts.reasons == VALID), verdicts.tracked

        return test


def arranged_in_sheets(
    prepared: PreparedScene, candidates: Candidates, tracked: Array, deadline: Deadline
) -> Nameless:
    """Link solutions along mesh edges, and make sheets of them.

    Args:
        candidates: (n, s) all solutions, each vertex's in an order of its own.
        tracked: (points, n * s, 3) of the bodies at the vertices, m.

    Raises:
        InputError: linked solutions are two of one vertex, or there are too many sheets.
        OutOfTime: the deadline came first.
    """
    surface, robot, tracker = prepared.surface, prepared.robot, prepared.arm.tracker(deadline)
    edges, nodes = surface.edges(), candidates.valid
    limits = (robot.lower, robot.upper) if prepared.setup.constraints.collision else None
    solutions = tracker.described(candidates.configurations)
    linking = Linking(surface, nodes, solutions, tracker, limits)
    links = [np.empty((0, 3), dtype=np.int64)]
    together = edges_at_once(nodes.shape[1], robot.joints)
    for first in range(0, len(edges), together):
        deadline.check()
        found = linking.links(edges[first : first + together])
        links.append(found + np.array([first, 0, 0]))
    sheets = sheets_of(surface, np.concatenate(links), nodes, solutions)
    by_sheet = Candidates(
        sheets.arranged(candidates.configurations, np.nan),
        sheets.arranged(candidates.reasons, NO_SOLUTION),
        sheets.arranged(candidates.determinants, np.nan),
        candidates.reason_names,
    )
    arranged = Solutions(
        by_sheet.configurations,
        sheets.arranged(solutions.determinants, np.nan),
        sheets.arranged(solutions.apart, np.inf),
        sheets.arranged(solutions.good, False),
    )
    bodies = tracked.reshape(len(tracked), *nodes.shape, 3).transpose(1, 2, 0, 3)
    moved = sheets.arranged(bodies, np.nan).transpose(2, 0, 1, 3)
    moved = moved.reshape(len(tracked), by_sheet.reasons.size, 3)
    return Nameless(prepared, tracker, sheets, arranged, by_sheet, moved)
