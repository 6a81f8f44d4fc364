"""Where a closed walk on a segment turns a joint by full circles, and walls that forbid it.

The angles of a segment's color are single-valued but for full circles. From the part of one mesh
vertex to that of the next one they go on without a jump; all the way round a hole, or round a
place that no color of the segment reaches, they may come back turned by a full circle. Along a
tree of such steps they are single-valued. So a tree is grown from a vertex, nearest parts first, as
far as the joints stay inside their limits; where two parts beside each other were reached with
different turns there is a wall. What the tree has reached stays connected.
"""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import product

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped
from cellcolor.motion.small_triangles import CornerStates, SmallTriangles

__all__ = ["Parts", "Walls", "parts_of", "walls_of"]

_ROOTS = 12  # vertices that trees are grown from, one after the other
_MARGIN = 0.02  # rad; what samples between corners of small triangles may reach beyond these
_PER_JOINT = 3  # turns of one joint that are tried at a root


@dataclass(frozen=True)
class Parts:
    """A segment as parts about mesh vertices, and the steps between them.

    Attributes:
        places: (p, 3) the vertex of each part, m.
        areas: (p,) m^2.
        lowest, highest: (p, joints) angles inside each part, unwound from its vertex, rad.
        steps: (s, 2) parts that one can step between.
        turns: (s, joints) by how many full circles angles that start as the inverse kinematics has
            them at the first vertex of a step are turned against those at the second.
        edge: (s,) the number of the mesh edge that is crossed.
        lengths: (s,) of the side that is crossed, m.
    """

    places: Array
    areas: Array
    lowest: Array
    highest: Array
    steps: Index
    turns: Index
    edge: Index
    lengths: Array


@dataclass(frozen=True)
class Walls:
    """Walls of one segment.

    Attributes:
        edges: mesh edges that no path may cross.
        whole: whether the segment is still connected; if not, its limits allow no single path.
        joint: a joint that winds, or else does not fit into its limits.
    """

    edges: tuple[tuple[int, int], ...]
    whole: bool
    joint: int


def parts_of(
    small: SmallTriangles, states: CornerStates, segment: int, left_out: Index, closed: Mask
) -> Parts:
    """The parts of a segment.

    Args:
        small: the small triangles of the mesh.
        states: what the arm does at their corners.
        segment: the segment.
        left_out: numbers of small triangles that no path enters.
        closed: (k,) mesh edges that no path crosses, cracks and walls.
    """
    kept = small.segment == segment
    kept[left_out] = False
    own = np.flatnonzero(kept)
    # Small triangles of one vertex that have a side in common: the middle one, or half a mesh edge.
    even = np.arange(0, len(kept), 2)
    pairs = [np.column_stack([even, even + 1])]
    by_half = own[np.lexsort((small.corners[own, 0], small.side[own]))]
    same = (small.side[by_half[1:]] == small.side[by_half[:-1]]) & (
        small.corners[by_half[1:], 0] == small.corners[by_half[:-1], 0]
    )
    pairs.append(np.column_stack([by_half[:-1], by_half[1:]])[same])
    together = np.concatenate(pairs)
    together = together[kept[together].all(axis=1)]
    label = grouped(len(kept), together)
    _, part = np.unique(label[own], return_inverse=True)
    part_of = np.full(len(kept), -1, dtype=np.int64)
    part_of[own] = part
    count = int(part.max(initial=-1)) + 1
    places = np.zeros((count, 3))
    places[part] = small.points[small.corners[own, 0]]
    joints = states.joints[own]
    lowest = np.full((count, joints.shape[2]), np.inf)
    highest = np.full((count, joints.shape[2]), -np.inf)
    np.minimum.at(lowest, part, joints.min(axis=1))
    np.maximum.at(highest, part, joints.max(axis=1))
    # Across a mesh edge: the side from the middle of the edge to the centroid.
    first = 2 * np.arange(len(kept) // 2)
    after = first - first % 6 + (first % 6 + 2) % 6 + 1
    open_ = kept[first] & kept[after] & ~closed[small.side[first]]
    first, after = first[open_], after[open_]
    at_middle = states.joints[first, 1] - states.joints[after, 2]
    middle, centroid = small.corners[first, 1], small.corners[first, 2]
    return Parts(
        places,
        np.bincount(part, small.areas[own], count).astype(np.float64),
        lowest,
        highest,
        np.column_stack([part_of[first], part_of[after]]),
        states.space.periods(at_middle).astype(np.int64),
        small.side[first],
        np.linalg.norm(small.points[middle] - small.points[centroid], axis=1),
    )


def walls_of(parts: Parts, mesh: TriangleMesh, space: JointSpace, deadline: Deadline) -> Walls:
    """Walls between which the joints of a segment stay inside their limits.

    Of all trees that are grown, one that reaches the largest area is taken, and of these the one
    with the shortest walls. What it does not reach is a part of the segment by itself.

    Args:
        parts: of the segment.
        mesh: the mesh.
        space: of the joints.
        deadline: when to give up.

    Raises:
        OutOfTime: the deadline came first.
    """
    grower = _Grower(parts, space, deadline)
    one, other = parts.steps.T
    left = np.ones(len(parts.places), dtype=bool)
    walls = np.zeros(len(parts.steps), dtype=bool)
    group = np.zeros(len(parts.places), dtype=np.int64)
    while left.any():
        tree = grower.best(left)
        group[tree.reached] = group.max() + 1
        walls |= tree.reached[one] & tree.reached[other] & grower.torn(tree).any(axis=1)
        left &= ~tree.reached
    walls |= group[one] != group[other]
    rows = np.unique(parts.edge[walls])
    connected = int(grouped(len(parts.places), parts.steps).max(initial=-1)) + 1
    pairs = tuple([(int(a), int(b)) for a, b in mesh.edges[rows]])
    return Walls(pairs, int(group.max(initial=0)) <= connected, grower.joint)


@dataclass(frozen=True)
class _Tree:
    """Which parts a tree reaches (p,), and the turns (p, joints) there."""

    reached: Mask
    turns: Index


class _Grower:
    """Grows trees of parts.

    Attributes:
        joint: one that a closed walk turns by a full circle; otherwise that which moves farthest.
    """

    def __init__(self, parts: Parts, space: JointSpace, deadline: Deadline) -> None:
        self._parts, self._space, self._deadline = parts, space, deadline
        self._beside: list[list[tuple[int, float, Index]]] = [[] for _ in parts.places]
        ends = parts.places[parts.steps]
        lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).tolist()
        steps = zip(parts.steps.tolist(), lengths, parts.turns, strict=True)
        for (one, other), length, turns in steps:
            self._beside[one].append((other, length, turns))
            self._beside[other].append((one, length, -turns))
        everywhere = np.ones(len(parts.places), dtype=bool)
        joints = parts.lowest.shape[1]
        self._free = self._grown(everywhere, 0, np.zeros(joints, dtype=np.int64), None)
        lowest = (parts.lowest + space.period * self._free.turns)[self._free.reached].min(axis=0)
        highest = (parts.highest + space.period * self._free.turns)[self._free.reached].max(axis=0)
        seen = self._free.reached[parts.steps[:, 0]]
        winds = np.asarray(self.torn(self._free)[seen].any(axis=0))
        self.joint = int(np.argmax(winds) if winds.any() else np.argmax(highest - lowest))
        # A joint that does not wind, and fits as a whole, needs no more than one start.
        spans = zip(lowest, highest, *space.limits, space.period, strict=True)
        whole = [_fitting(*span) for span in spans]
        self._whole = [
            None if wind or not turns else turns[0]
            for wind, turns in zip(winds, whole, strict=True)
        ]

    def torn(self, tree: _Tree) -> Mask:
        """Steps (s, joints) over which the turns of a tree do not go on."""
        one, other = self._parts.steps.T
        return np.asarray(tree.turns[one] + self._parts.turns != tree.turns[other])

    def best(self, left: Mask) -> _Tree:
        """The tree that reaches most of what is left, and of these one with the shortest walls."""
        parts = self._parts
        one, other = parts.steps.T
        best: tuple[float, float] | None = None
        found = _Tree(np.zeros(len(left), dtype=bool), np.zeros_like(self._free.turns))
        for root in _spread(parts.places, np.flatnonzero(left)):
            for margin in (_MARGIN, 0.0):
                off = margin * self._space.units
                limits = self._space.lower + off, self._space.upper - off
                for start in self._starts(root, limits):
                    self._deadline.check()
                    tree = self._grown(left, root, start, limits)
                    both = tree.reached[one] & tree.reached[other]
                    walls = parts.lengths[both & self.torn(tree).any(axis=1)].sum()
                    area = round(float(parts.areas[tree.reached].sum()), 12)
                    if best is None or (-area, float(walls)) < best:
                        best, found = (-area, float(walls)), tree
        if best is None:  # nowhere a start inside the limits: a part by itself
            found.reached[int(np.argmax(left))] = True
        return found

    def _starts(self, root: int, limits: tuple[Array, Array]) -> list[Index]:
        """Turns (joints,) of a root that are inside the limits."""
        parts, choices = self._parts, []
        ends = parts.lowest[root], parts.highest[root]
        spans = zip(*ends, *limits, self._space.period, strict=True)
        for joint, span in enumerate(spans):
            whole = self._whole[joint]
            if whole is not None and self._free.reached[root]:
                choices.append([whole + int(self._free.turns[root, joint])])
            else:
                choices.append(_fitting(*span)[:_PER_JOINT])
        return [np.array(turns, dtype=np.int64) for turns in product(*choices)]

    def _grown(
        self, allowed: Mask, root: int, start: Index, limits: tuple[Array, Array] | None
    ) -> _Tree:
        """A tree of the shortest ways from a root, among allowed parts and inside limits."""
        parts, period = self._parts, self._space.period
        turns = np.zeros(parts.lowest.shape, dtype=np.int64)
        reached = np.zeros(len(parts.places), dtype=bool)
        queue, count = [(0.0, 0, root, start)], 0
        while queue:
            far, _, part, own = heappop(queue)
            if reached[part]:
                continue
            reached[part], turns[part] = True, own
            for other, length, more in self._beside[part]:
                if reached[other] or not allowed[other]:
                    continue
                there = own + more
                if limits is not None:
                    inside = parts.lowest[other] + period * there >= limits[0]
                    inside &= parts.highest[other] + period * there <= limits[1]
                    if not inside.all():
                        continue
                count += 1
                heappush(queue, (far + length, count, other, there))
        return _Tree(reached, turns)


def _fitting(lowest: float, highest: float, lower: float, upper: float, period: float) -> list[int]:
    """The periods that bring a range of positions inside limits, the middle ones first."""
    if not (np.isfinite(lower) and np.isfinite(upper)):
        return [0]
    if not period:
        return [0] if lower <= lowest and highest <= upper else []
    first, last = np.ceil((lower - lowest) / period), np.floor((upper - highest) / period)
    turns = range(int(first), int(last) + 1)
    middle = (lower + upper - lowest - highest) / 2
    return sorted(turns, key=lambda turn: abs(period * turn - middle))


def _spread(places: Array, members: Index) -> list[int]:
    """Some of the members, each as far as can be from those before it."""
    chosen = [int(members[0])]
    away = np.linalg.norm(places[members] - places[chosen[0]], axis=1)
    while len(chosen) < min(_ROOTS, len(members)):
        chosen.append(int(members[int(np.argmax(away))]))
        away = np.minimum(away, np.linalg.norm(places[members] - places[chosen[-1]], axis=1))
    return chosen
