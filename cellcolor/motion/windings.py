"""Walls on a segment that keep joints inside their limits where the segment winds them.

Idea. Inverse kinematics gives a joint's angle modulo full circles. After a closed walk on a
segment around a hole, or around a place that is out of reach, an angle may have changed by full
circles, as that of the first joint does after a walk around the robot's base. A path that goes
around often enough leaves any limits. Along a tree there are no closed walks, so each angle has one
value. So a tree is grown over the vertices of the segment as far as the joints stay inside their
limits. Neighbors that the tree has reached with different turns get a **wall** between them, which
no path may cross. The tree itself crosses no wall, so all that it has reached stays connected. What
it does not reach gets trees and strokes of its own. The shipped part ``blend`` needs walls: without
them one stroke is cut in two.

Standard terms. Vertices and steps form a gain graph (voltage graph) with gains in Z^joints; the
turns along a tree are a potential; walls are the steps whose gain contradicts it. Trees are
shortest-path trees (Dijkstra); their roots are a farthest-point sample. Of the trees from all roots
with all fitting turns the one that reaches the largest area is taken, then the one with the fewest
walls. A joint that does not wind, and fits on a tree without limits, has the same turns in all.

Example. Vertices A, B, C, D lie around the base, with the first joint at 0, 90, 180 and -90
degrees. The step from C to D has 1 turn: from 180 degrees the joint goes on to 270. With limits of
200 degrees each way the tree from A has all four with 0 turns, and the one wall is between C and D.
With limits of 100 degrees it does not reach C; C is a tree by itself, with walls to B and D.
"""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import product
from typing import NamedTuple

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped
from cellcolor.motion.small_triangles import CornerStates

_ROOTS = 12  # vertices that trees are grown from, one after the other
_MARGIN = 0.02  # rad; how far samples inside a small triangle may exceed the angles at its corners
_PER_JOINT = 3  # how many turns of one joint are tried at a root


class Steps(NamedTuple):
    """The vertices of a segment, and the steps between them.

    Attributes:
        vertex: (p,) of the mesh.
        areas: (p,) m².
        lowest, highest: (p, joints) angles around each vertex, unwound from it, rad or m.
        ends: (s, 2) the two vertices of each step, by their places in ``vertex``.
        turns: (s, joints) full circles to add at the second: the angles continued from the first,
            less those that inverse kinematics gives at the second.
    """

    vertex: Index
    areas: Array
    lowest: Array
    highest: Array
    ends: Index
    turns: Index


def steps_of(states: CornerStates, segment: int, closed: Mask) -> Steps:
    """The steps on a segment, without small triangles that are not valid all over.

    A step leads across each side between the middle of a mesh edge and a centroid. On one side of
    it is the small triangle (vertex, middle, centroid), on the other (next vertex, centroid,
    middle).

    Args:
        closed: (k,) mesh edges that no path crosses.
    """
    small, joints = states.small, states.joints
    kept = (small.segment == segment) & ~states.bad
    vertex, place = np.unique(small.corners[kept, 0], return_inverse=True)
    lowest = np.full((len(vertex), joints.shape[2]), np.inf)
    highest = -lowest
    np.minimum.at(lowest, place, joints[kept].min(axis=1))
    np.maximum.at(highest, place, joints[kept].max(axis=1))
    numbers = np.arange(len(kept)).reshape(-1, 3, 2)
    here, there = numbers[:, :, 0].ravel(), np.roll(numbers[:, :, 1], -1, axis=1).ravel()
    crossed = kept[here] & kept[there] & ~closed[small.side[here]]
    here, there = here[crossed], there[crossed]
    place_of = np.full(len(kept), -1)
    place_of[kept] = place
    turns = states.space.periods(joints[here, 1] - joints[there, 2]).astype(np.int64)
    ends = np.column_stack([place_of[here], place_of[there]])
    areas = np.bincount(place, small.areas[kept], len(vertex)).astype(np.float64)
    return Steps(vertex, areas, lowest, highest, ends, turns)


def walls_of(
    steps: Steps, mesh: TriangleMesh, space: JointSpace, deadline: Deadline
) -> tuple[list[tuple[int, int]], int | None]:
    """Walls between which the joints of a segment stay inside their limits.

    Returns:
        Mesh edges; no path may cross from one end's part to the other end's. And the joint that
        keeps a connected piece of the segment from being one tree; None if none does.

    Raises:
        OutOfTime: the deadline came first.
    """
    grower = _Grower(steps, mesh.points[steps.vertex], space, deadline)
    tree_of = np.zeros(len(steps.vertex), dtype=np.int64)  # 0 for what no tree has reached
    turns = np.zeros(steps.lowest.shape, dtype=np.int64)
    while not tree_of.all():
        reached, own = grower.best(tree_of == 0)
        tree_of[reached], turns[reached] = tree_of.max() + 1, own[reached]
    one, other = steps.ends.T
    parted = (tree_of[one] != tree_of[other]) | _contradicting(steps, turns).any(axis=1)
    walls = np.unique(np.sort(steps.vertex[steps.ends[parted]], axis=1), axis=0)
    pieces = int(grouped(len(tree_of), steps.ends).max(initial=-1)) + 1
    joint = grower.joint if tree_of.max(initial=0) > pieces else None
    return [(int(a), int(b)) for a, b in walls], joint


def _contradicting(steps: Steps, turns: Index) -> Mask:
    """(s, joints) which steps contradict the turns (p, joints) at their ends."""
    one, other = steps.ends.T
    return np.asarray(turns[one] + steps.turns != turns[other])


class _Grower:
    """Grows trees over the steps of one segment.

    Attributes:
        joint: a joint that winds; if none does, the one that moves farthest.
    """

    def __init__(self, steps: Steps, places: Array, space: JointSpace, deadline: Deadline) -> None:
        self._steps, self._places, self._space, self._deadline = steps, places, space, deadline
        # For each vertex its neighbors, how far they are, and the turns there.
        self._neighbors: list[list[tuple[int, float, Index]]] = [[] for _ in places]
        lengths = np.linalg.norm(np.diff(places[steps.ends], axis=1)[:, 0], axis=1).tolist()
        rows = zip(steps.ends.tolist(), lengths, steps.turns, strict=True)
        for (one, other), length, turns in rows:
            self._neighbors[one].append((other, length, turns))
            self._neighbors[other].append((one, length, -turns))
        none, endless = (
            np.zeros(len(space.period), dtype=np.int64),
            np.full(len(space.period), np.inf),
        )
        reached, self._free = self._tree(
            0, none, np.ones(len(places), dtype=bool), -endless, endless
        )
        low, high = (of + space.period * self._free for of in (steps.lowest, steps.highest))
        low, high = low[reached].min(axis=0), high[reached].max(axis=0)
        inside = reached[steps.ends].all(axis=1)
        winds = np.any(_contradicting(steps, self._free)[inside], axis=0).tolist()
        self.joint = int(np.argmax(winds) if any(winds) else np.argmax(high - low))
        fitting = space.turns(np.array([low, high]))
        # For each joint the turns to add to the free tree; None if it winds or does not fit.
        self._fixed = [
            None if wind or not len(own) else int(own[np.abs(own).argmin()])
            for wind, own in zip(winds, fitting, strict=True)
        ]
        self._known = reached

    def _tree(
        self, root: int, start: Index, allowed: Mask, lower: Array, upper: Array
    ) -> tuple[Mask, Index]:
        """What (p,) a shortest-path tree reaches inside limits (joints,), and its turns there."""
        steps, period = self._steps, self._space.period
        turns, reached = np.zeros(steps.lowest.shape, dtype=np.int64), np.zeros(len(allowed), bool)
        # The running number orders ways of equal length, so that arrays are never compared.
        queue, number = [(0.0, 0, root, start)], 0
        while queue:
            far, _, at, own = heappop(queue)
            if reached[at]:
                continue
            reached[at], turns[at] = True, own
            for other, length, more in self._neighbors[at]:
                off = period * (own + more)
                if reached[other] or not allowed[other]:
                    continue
                if (steps.lowest[other] + off >= lower).all() and (
                    steps.highest[other] + off <= upper
                ).all():
                    number += 1
                    heappush(queue, (far + length, number, other, own + more))
        return reached, turns

    def best(self, left: Mask) -> tuple[Mask, Index]:
        """The tree with the largest area in what is left (p,); if none fits, one vertex alone."""
        first = int(np.argmax(left))
        found = [(np.arange(len(left)) == first, np.zeros_like(self._free))]
        for root in _spread(self._places, np.flatnonzero(left)):
            for margin in (_MARGIN * self._space.units, 0.0):
                limits = self._space.lower + margin, self._space.upper - margin
                for start in self._starts(root):
                    self._deadline.check()
                    found.append(self._tree(root, start, left, *limits))

        def cost(tree: tuple[Mask, Index]) -> tuple[float, int]:
            reached, turns = tree
            walls = _contradicting(self._steps, turns)[reached[self._steps.ends].all(axis=1)]
            area = round(float(self._steps.areas[reached].sum()), 12)
            return -area, int(walls.any(axis=1).sum())

        return min(found, key=cost)

    def _starts(self, root: int) -> list[Index]:
        """All choices of turns (joints,) that put a root inside the limits."""
        space, span = self._space, np.array([self._steps.lowest[root], self._steps.highest[root]])
        choices = [own[np.argsort(np.abs(own))][:_PER_JOINT] for own in space.turns(span)]
        if self._known[root]:
            for joint, fixed in enumerate(self._fixed):
                if fixed is not None:
                    choices[joint] = np.array([fixed + self._free[root, joint]])
        return [np.array(turns, dtype=np.int64) for turns in product(*choices)]


def _spread(places: Array, members: Index) -> list[int]:
    """Up to ``_ROOTS`` of the members, each the one farthest from those chosen before it."""
    chosen = [int(members[0])]
    away = np.linalg.norm(places[members] - places[chosen[0]], axis=1)
    while len(chosen) < min(_ROOTS, len(members)):
        chosen.append(int(members[int(np.argmax(away))]))
        away = np.minimum(away, np.linalg.norm(places[members] - places[chosen[-1]], axis=1))
    return chosen
