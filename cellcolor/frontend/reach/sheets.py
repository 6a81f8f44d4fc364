"""Solutions without names, put into sheets, which then are the branches of the arm.

What a sheet means at vertices, between and off them: ``docs/frontend.md``, "Continuity
without names". In standard terms, solutions are the points of a covering of the part, links are
lifts of mesh edges by continuation (path tracking), and a sheet is a sheet of the covering, or
several pieces of one.

:class:`Followed` links solutions, :func:`sheets_of` puts the components of linked ones into sheets,
largest first, each into the first sheet where it fits (greedy coloring). Solutions that are not
valid fill free places, so that each has a reason somewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.components import components_of, twice
from cellcolor.configurations.matching import CIRCLE, Matching, farthest, stays_within
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.prepared_arm import PreparedArm
from cellcolor.frontend.reach.smooth import Solutions, Tracker
from cellcolor.frontend.reach.validity_tests import Judge
from cellcolor.memory import chunks

MOST_SHEETS = 60
"""A set of branches has to fit into one integer where slivers are cleaned."""


def in_sheets(arm: PreparedArm, surface: Surface, judge: Judge, deadline: Deadline) -> PreparedArm:
    """An arm whose solutions have no names, with sheets over a surface as branches.

    Raises:
        InputError: linked solutions are two of one vertex, or there are too many sheets.
    """
    bare = arm.bare
    found = bare.inverse(surface.vertices, -surface.normals, deadline)
    verdicts = judge(found, deadline)
    nodes = verdicts.valid
    turned, own, robot, along = bare.kinematics, bare.kinematics, bare.robot, surface
    if isinstance(turned, TurnedKinematics):  # followed with the tool on the last axis
        robot, own = turned.straight, turned.own
        tips, directions = turned.straightened(surface.vertices, -surface.normals)
        along = Surface(tips, surface.faces, -directions)
    on, measure = bare.setup.constraints, replace(bare.measure, lever=own.lever)
    tracker = Tracker(robot, measure, bare.conditioning if on.conditioning else None)
    solutions = tracker.described(verdicts.configurations)
    limits = (bare.robot.lower, bare.robot.upper) if on.collision else None
    matching = Followed.of(along, nodes, solutions, tracker, limits)
    pairs, _ = matching.along(surface.mesh.edges, deadline)
    slot = sheets_of(surface, pairs, nodes, solutions)
    vertex, there = np.arange(len(slot))[:, None], slot >= 0
    joints = np.where(there[:, :, None], solutions.joints[vertex, slot], np.nan)
    poses = along.vertices, -along.normals
    sheets = SheetKinematics(
        own, Tracker(robot, measure), poses, joints, nodes[vertex, slot] & there
    )
    kinematics = turned.with_own(sheets) if isinstance(turned, TurnedKinematics) else sheets
    return replace(bare, kinematics=kinematics, own=bare.kinematics)


class SheetKinematics(InverseKinematics):
    """Inverse kinematics whose branches are sheets over a surface.

    The solutions at the vertices are known. Any other pose is reached from the nearest vertex where
    the sheet is valid: the tip goes straight, and the tool's direction turns with it. There is none
    if the motion jumps or meets a singularity on its way, or none of the nearest vertices will do.
    """

    def __init__(
        self,
        own: InverseKinematics,
        tracker: Tracker,
        poses: tuple[Array, Array],
        joints: Array,
        valid: Mask,
    ) -> None:
        """Sheets over vertices.

        Args:
            poses: points (n, 3) in m and unit vectors (n, 3) of the tool at the vertices.
            joints: (n, sheets, joints) in rad, NaN for none.
            valid: (n, sheets) which of them are followed.
        """
        self.own, self._tracker = own, tracker
        self.branches = tuple(f"sheet-{k}" for k in range(1, joints.shape[1] + 1))
        self.reach, self.lever, self.viewpoints = own.reach, own.lever, own.viewpoints
        there = np.isfinite(poses[0] + poses[1]).all(axis=1)  # a rule for the turn may say nothing
        self._points, self._directions = (each[there] for each in poses)
        self._joints, self._valid = joints[there], valid[there]
        self._places = cKDTree(self._place(self._points, self._directions))

    def _place(self, points: Array, directions: Array) -> Array:
        """Poses as points (n, 6), so that both sides of a thin part are far from each other."""
        return np.concatenate([points, max(self.lever, self.reach / 10) * directions], axis=1)

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        count = 1 if branches is not None else len(self.branches)
        if branches is None:
            branches = np.tile(np.arange(count), len(points))
        every = np.repeat(np.arange(len(points)), count)
        found = self._followed(points[every], directions[every], branches)
        return found.reshape(len(points), count, self._joints.shape[2])

    def _followed(self, points: Array, directions: Array, sheets: NDArray[np.intp]) -> Array:
        found = np.full((len(points), self._joints.shape[2]), np.nan)
        asked = np.flatnonzero(np.isfinite(points + directions).all(axis=1))
        if not len(asked) or not len(self._points):
            return found
        places = self._place(points[asked], directions[asked])
        off, near = self._places.query(places, k=np.arange(1, min(_NEAREST, len(self._points)) + 1))
        at_vertex = off[:, 0] <= _SAME_PLACE
        here = asked[at_vertex]
        found[here] = self._joints[near[at_vertex, 0], sheets[here]]
        ready = self._valid[near, sheets[asked][:, None]] & ~at_vertex[:, None]
        rows = np.flatnonzero(ready.any(axis=1))
        start, to = near[rows, np.argmax(ready[rows], axis=1)], asked[rows]
        for part in chunks(len(rows)):
            at, target = start[part], to[part]
            way = Surface(
                np.concatenate([self._points[at], points[target]]),
                np.empty((0, 3), dtype=np.int64),
                -np.concatenate([self._directions[at], directions[target]]),
            )
            ends = np.column_stack([np.arange(len(at)), np.arange(len(at)) + len(at)])
            begin = self._tracker.described(self._joints[at, sheets[target]])
            found[target] = self._tracker.walk(way, ends, begin)[0]
        return found

    def taken(self, directions: Array) -> Array:
        return self.own.taken(directions)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        return self.own.remarks(points, directions)


_NEAREST = 12  # vertices that are tried, one of which has the sheet
_SAME_PLACE = 1e-9  # m


@dataclass(frozen=True)
class Followed(Matching):
    """Links solutions that a continuous motion along a mesh edge joins.

    What is left over at both ends, once clear pairs are matched, is followed along the edge in
    small steps from either end, and linked if both ways agree.
    Solutions of different signs of the task determinant have a singularity between them: the sign
    is their name.

    Attributes:
        solutions: (n, s) of all vertices.
        tracker: follows them, and says what is a jump.
    """

    surface: Surface
    solutions: Solutions
    tracker: Tracker

    @classmethod
    def of(
        cls,
        surface: Surface,
        nodes: Mask,
        solutions: Solutions,
        tracker: Tracker,
        limits: tuple[Array, Array] | None,
    ) -> Followed:
        """The matching of the solutions that are valid, ``nodes`` (n, s), in rad."""
        signs = np.nan_to_num(np.sign(solutions.determinants)).astype(np.int64)
        joints, periods = solutions.joints, np.full(solutions.joints.shape[2], CIRCLE)
        return cls(joints, nodes, signs, periods, limits, surface, solutions, tracker)

    def small(self, edges: Index, step: Array) -> Mask:
        """Which steps need not be looked into."""
        i, j = edges.T
        size, measure = np.abs(self.solutions.determinants), self.tracker.measure
        lengths, turns = self.surface.lengths(edges), self.surface.turns(edges)
        start, end = np.zeros(len(edges)), np.ones(len(edges))
        change = measure.changes(lengths, turns, start, end)[:, None, None]
        return measure.settled(step, change, np.fmin(size[i][:, :, None], size[j][:, None]))

    def settle(self, edges: Index, left: Mask, step: Array, nearest: Array) -> tuple[Index, Array]:  # noqa: ARG002
        """The pairs on which both ways agree."""
        there = self._walked(edges, *np.nonzero(left.any(axis=2)))
        back = self._walked(edges[:, ::-1], *np.nonzero(left.any(axis=1)))[:, [0, 2, 1]]
        agreed = set(map(tuple, back.tolist()))
        both = np.array([tuple(pair) in agreed for pair in there.tolist()], dtype=bool)
        return np.asarray(there[both]), np.full(both.sum(), np.inf)

    def _walked(self, edges: Index, row: Index, slot: Index) -> Index:
        """Where solutions at first ends of rows of edges lead: row, slot, slot there, (l, 3)."""
        start = self.solutions.take(edges[row, 0], slot)
        ends, motions = self.tracker.walk(self.surface, edges[row], start)
        smooth = motions.smooth
        if self.limits is not None:
            moved = motions.lowest, motions.highest
            smooth = smooth & stays_within(self.limits, start.joints, *moved)
        row, slot, ends = row[smooth], slot[smooth], ends[smooth]
        off = farthest(self.joints[edges[row, 1]], ends[:, None])
        arrived = np.argmin(np.where(np.isnan(off), np.inf, off), axis=1)
        return np.column_stack([row, slot, arrived])


def sheets_of(surface: Surface, links: Index, nodes: Mask, solutions: Solutions) -> Index:
    """Which solution of a vertex each sheet has, (n, sheets), -1 for none; largest sheets first.

    Args:
        links: (l, 3), see :meth:`~cellcolor.configurations.matching.Matching.along`.
        nodes: (n, s) which solutions are valid.
        solutions: (n, s) of all vertices.

    Raises:
        InputError: linked solutions are two of one vertex; names the vertex and both. Or there are
            too many sheets.
    """
    component = components_of(nodes, surface.mesh.edges, links)
    repeated = twice(component)
    if len(repeated):
        raise _cuspidal(surface, component, solutions.joints, *repeated[0].tolist())
    slot = _with_the_rest(
        _packed(component, surface.mesh.edges), ~nodes & ~np.isnan(solutions.determinants)
    )
    if slot.shape[1] > MOST_SHEETS:
        message = f"its solutions fall into {slot.shape[1]} sheets, at most {MOST_SHEETS} fit"
        raise InputError(None, "robot.kinematics", message)
    return slot


def _packed(component: Index, edges: Index) -> Index:
    """Sheets (n, sheets) of components (n, s), each put into the first sheet where it fits.

    No two components next to each other are in one sheet: their borders would be lost.
    """
    count = len(component)
    both_ways = np.concatenate([edges, edges[:, ::-1]]).T
    neighbors = coo_array((np.ones(both_ways.shape[1]), both_ways), shape=(count, count)).tocsr()
    sheets: list[Index] = []
    closed: list[Mask] = []  # the vertices of each sheet that are taken, or next to these
    for number in range(int(component.max(initial=-1)) + 1):
        vertices, slots = np.nonzero(component == number)
        at = next((k for k, own in enumerate(closed) if not own[vertices].any()), len(sheets))
        if at == len(sheets):
            sheets.append(np.full(count, -1, dtype=np.int64))
            closed.append(np.zeros(count, dtype=bool))
        sheets[at][vertices] = slots
        closed[at][vertices] = closed[at][neighbors[vertices].indices] = True
    return np.column_stack(sheets) if sheets else np.empty((count, 0), dtype=np.int64)


def _with_the_rest(slot: Index, rest: Mask) -> Index:
    """The sheets (n, sheets) with solutions that are not valid in places that are free."""
    count = int(((slot >= 0).sum(axis=1) + rest.sum(axis=1)).max(initial=1))
    missing = max(count - slot.shape[1], 0)
    filled = np.column_stack([slot, np.full((len(slot), missing), -1)])
    vertex, solution = np.nonzero(rest)
    number = np.arange(len(vertex)) - np.searchsorted(vertex, vertex)
    free = np.argsort(filled >= 0, axis=1, kind="stable")  # free places first
    filled[vertex, free[vertex, number]] = solution
    return filled


def _cuspidal(
    surface: Surface, component: Index, joints: Array, vertex: int, number: int
) -> InputError:
    """The error of a component that has a vertex twice."""
    found = joints[vertex, component[vertex] == number].round(4).tolist()
    place = ", ".join(f"{coordinate:.4f}" for coordinate in surface.vertices[vertex])
    return InputError(
        None,
        f"vertices[{vertex}]",
        f"at ({place}) m one color has {len(found)} configurations, "
        + " and ".join(map(str, found))
        + " rad: on this part the arm gets from one to the other without a singularity (it is "
        "cuspidal), and colors would not cover each point once; a smaller part, another placement "
        "or narrower joint limits can keep them apart",
    )
