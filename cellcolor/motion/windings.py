"""Walls that keep the joints of a segment inside their limits where it winds them.

Idea. Inverse kinematics has a joint's angle only up to full circles. Along a closed walk on a
segment, around a hole or a place that no color of the segment reaches, an angle may come back
turned by full circles, as that of the first joint does around the robot's base. A path that goes
around often enough leaves any limits. Along a tree the angles are single-valued. So a tree is grown
over the segment as far as the joints stay inside their limits, and no path may step between
neighbors that the tree reached with different turns: there is a wall. The tree crosses no wall, so
what it has reached stays connected.

Standard terms. Parts and steps are a gain graph (or voltage graph) with gains in Z^joints, the
turns along a tree are a potential, and walls are the steps whose gain does not agree with it; what
is left is balanced. Trees of shortest paths are Dijkstra's, their roots a farthest-point sample.

Steps of the algorithm.

1. :func:`parts_of` divides the segment into parts about mesh vertices, with the range of the angles
   in each, and finds the steps between them and by how much these turn the joints.
2. One tree without limits tells which joints wind. Any other joint that fits into its limits as a
   whole has the same turns in all trees.
3. Trees inside the limits are grown from several roots, with every choice of turns there. The one
   that reaches the largest area is taken, of equal ones the one with the shortest walls.
4. The rest is done in the same way; each tree becomes a stroke of its own.
5. There are walls where the turns of a tree disagree, and between trees.

Example. Parts A, B, C, D lie around the base, with the first joint at 0, 90, 180 and -90
degrees. The step from C to D has 1 turn: from 180 degrees the joint goes on to 270. With limits of
200 degrees each way the tree from A has all four with 0 turns, and the one wall is between C and D.
With limits of 100 degrees it does not reach C; C is a tree by itself, with walls to B and D.

Complexity. A tree of p parts and s steps takes O((p + s) log s) time. At most 12 roots times 2
margins times 3 to the number of joints of which step 2 does not fix the turns are grown for each
tree that is taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import product

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped
from cellcolor.motion.small_triangles import CornerStates, SmallTriangles

_ROOTS = 12  # vertices that trees are grown from, one after the other
_MARGIN = 0.02  # rad; what samples between corners of small triangles may reach beyond these
_PER_JOINT = 3  # turns of one joint that are tried at a root

_Limits = tuple[Array, Array]  # lower and upper, (joints,)


@dataclass(frozen=True)
class PartSteps:
    """Steps between the parts of a segment, each across one side of small triangles.

    Attributes:
        ends: (s, 2) the two parts.
        turns: (s, joints) full circles between the angles that go on from the vertex of the first
            part and those that inverse kinematics has at the vertex of the second.
        edge: (s,) the number of the mesh edge that is followed.
        lengths: (s,) of the side that is crossed, m.
    """

    ends: Index
    turns: Index
    edge: Index
    lengths: Array


@dataclass(frozen=True)
class Parts:
    """A segment as parts about mesh vertices, and the steps between them.

    Attributes:
        places: (p, 3) the vertex of each part, m.
        areas: (p,) m^2.
        lowest, highest: (p, joints) angles inside each part, unwound from its vertex, rad.
        steps: between the parts.
    """

    places: Array
    areas: Array
    lowest: Array
    highest: Array
    steps: PartSteps


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
    part_of = _part_of(small, kept)
    part, joints = part_of[kept], states.joints[kept]
    count = int(part.max(initial=-1)) + 1
    places = np.zeros((count, 3))
    places[part] = small.points[small.corners[kept, 0]]
    lowest = np.full((count, joints.shape[2]), np.inf)
    highest = np.full((count, joints.shape[2]), -np.inf)
    np.minimum.at(lowest, part, joints.min(axis=1))
    np.maximum.at(highest, part, joints.max(axis=1))
    areas = np.bincount(part, small.areas[kept], count).astype(np.float64)
    return Parts(places, areas, lowest, highest, _steps_between(small, states, part_of, closed))


def _part_of(small: SmallTriangles, kept: Mask) -> Index:
    """The part (6 m,) of each small triangle that is kept, -1 for the others.

    Two of one vertex are in one part if they have a side in common: that to the centroid, or half a
    mesh edge.
    """
    own = np.flatnonzero(kept)
    to_centroid = np.arange(len(kept)).reshape(-1, 2)
    vertex, side = small.corners[:, 0], small.side
    sorted_ = own[np.lexsort((vertex[own], side[own]))]
    half_edge = np.column_stack([sorted_[:-1], sorted_[1:]])
    half_edge = half_edge[(np.diff(side[sorted_]) == 0) & (np.diff(vertex[sorted_]) == 0)]
    pairs = np.concatenate([to_centroid, half_edge])
    group = grouped(len(kept), pairs[kept[pairs].all(axis=1)])
    part_of = np.full(len(kept), -1, dtype=np.int64)
    part_of[own] = np.unique(group[own], return_inverse=True)[1]
    return part_of


def _steps_between(
    small: SmallTriangles, states: CornerStates, part_of: Index, closed: Mask
) -> PartSteps:
    """A step for each side between the middle of a mesh edge and a centroid, if it may be crossed.

    On one side of it is a small triangle (vertex, middle, centroid), on the other the small
    triangle (next vertex, centroid, middle).
    """
    numbers = np.arange(len(part_of)).reshape(-1, 3, 2)
    here, there = numbers[:, :, 0].ravel(), np.roll(numbers[:, :, 1], -1, axis=1).ravel()
    crossed = (part_of[here] >= 0) & (part_of[there] >= 0) & ~closed[small.side[here]]
    here, there = here[crossed], there[crossed]
    at_middle = states.joints[here, 1] - states.joints[there, 2]
    _, middle, centroid = small.points[small.corners[here]].swapaxes(0, 1)
    return PartSteps(
        np.column_stack([part_of[here], part_of[there]]),
        states.space.periods(at_middle).astype(np.int64),
        small.side[here],
        np.linalg.norm(middle - centroid, axis=1),
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
    walls = np.zeros(len(parts.steps.ends), dtype=bool)
    tree_of = np.zeros(len(parts.places), dtype=np.int64)  # 0 for parts that no tree has reached
    while not tree_of.all():
        tree = grower.best(tree_of == 0)
        tree_of[tree.reached] = tree_of.max() + 1
        walls |= grower.graph.disagreeing(tree).any(axis=1)
    one, other = tree_of[parts.steps.ends].T
    walls |= one != other
    edges = mesh.edges[np.unique(parts.steps.edge[walls])]
    connected = int(grouped(len(parts.places), parts.steps.ends).max(initial=-1)) + 1
    whole = int(tree_of.max(initial=0)) <= connected
    return Walls(tuple((int(a), int(b)) for a, b in edges), whole, grower.joint)


@dataclass(frozen=True)
class _Tree:
    """Which parts a tree reaches (p,), and the turns (p, joints) there."""

    reached: Mask
    turns: Index


class _GainGraph:
    """The parts and steps of a segment, for trees to be grown on."""

    def __init__(self, parts: Parts, period: Array) -> None:
        """Lists the neighbors of each part: part, distance of the vertices, turns of the step."""
        self._parts, self._period = parts, period
        self._neighbors: list[list[tuple[int, float, Index]]] = [[] for _ in parts.places]
        here, there = parts.places[parts.steps.ends].swapaxes(0, 1)
        lengths = np.linalg.norm(here - there, axis=1).tolist()
        steps = zip(parts.steps.ends.tolist(), lengths, parts.steps.turns, strict=True)
        for (one, other), length, turns in steps:
            self._neighbors[one].append((other, length, turns))
            self._neighbors[other].append((one, length, -turns))

    def tree(self, root: int, start: Index, allowed: Mask, limits: _Limits | None = None) -> _Tree:
        """The tree of shortest paths from a root, as far as allowed parts stay inside limits.

        Args:
            root: a part.
            start: (joints,) the turns there.
            allowed: (p,) the parts that may be reached.
            limits: of the joints, none without it. The root is not held against them.
        """
        turns = np.zeros(self._parts.lowest.shape, dtype=np.int64)
        reached = np.zeros(len(allowed), dtype=bool)
        # The running number keeps turns from being compared, and paths of equal length in order.
        queue, number = [(0.0, 0, root, start)], 0
        while queue:
            far, _, part, own = heappop(queue)
            if reached[part]:
                continue
            reached[part], turns[part] = True, own
            for other, length, more in self._neighbors[part]:
                if reached[other] or not allowed[other]:
                    continue
                there = own + more
                if limits is None or self._inside(other, there, limits):
                    number += 1
                    heappush(queue, (far + length, number, other, there))
        return _Tree(reached, turns)

    def _inside(self, part: int, turns: Index, limits: _Limits) -> bool:
        moved, (lower, upper) = self._period * turns, limits
        inside = self._parts.lowest[part] + moved >= lower
        inside &= self._parts.highest[part] + moved <= upper
        return bool(inside.all())

    def disagreeing(self, tree: _Tree) -> Mask:
        """Over which steps inside a tree its turns do not go on, (s, joints)."""
        one, other = self._parts.steps.ends.T
        inside = tree.reached[one] & tree.reached[other]
        goes_on = tree.turns[one] + self._parts.steps.turns == tree.turns[other]
        return np.asarray(inside[:, None] & ~goes_on)

    def cost(self, tree: _Tree) -> tuple[float, float]:
        """What makes a tree better if it is less: minus its area in m^2, then its walls in m."""
        area = round(float(self._parts.areas[tree.reached].sum()), 12)
        walls = self._parts.steps.lengths[self.disagreeing(tree).any(axis=1)]
        return -area, float(walls.sum())


class _Grower:
    """Grows trees of one segment inside the limits of the joints.

    Attributes:
        graph: what they are grown on.
        joint: one that a closed walk turns by a full circle; otherwise that which moves farthest.
    """

    def __init__(self, parts: Parts, space: JointSpace, deadline: Deadline) -> None:
        self._parts, self._space, self._deadline = parts, space, deadline
        self.graph = _GainGraph(parts, space.period)
        everywhere = np.ones(len(parts.places), dtype=bool)
        self._free = self.graph.tree(0, np.zeros(len(space.period), dtype=np.int64), everywhere)
        moved, reached = space.period * self._free.turns, self._free.reached
        lowest = (parts.lowest + moved)[reached].min(axis=0)
        highest = (parts.highest + moved)[reached].max(axis=0)
        winds = np.asarray(self.graph.disagreeing(self._free).any(axis=0))
        self.joint = int(np.argmax(winds) if winds.any() else np.argmax(highest - lowest))
        # For each joint by how much to turn that whole tree; None where it winds or does not fit.
        fitting = _fitting(lowest, highest, space.limits, space.period)
        self._fixed: list[int | None] = [
            None if wind or not turns else turns[0]
            for wind, turns in zip(winds, fitting, strict=True)
        ]

    def best(self, left: Mask) -> _Tree:
        """The tree that reaches most of what is left, and of these one with the shortest walls.

        If no part has turns inside the limits, it is the first one alone.
        """
        alone = np.zeros(len(left), dtype=bool)
        alone[int(np.argmax(left))] = True
        nothing = _Tree(alone, np.zeros_like(self._free.turns))
        return min(self._trees(left), key=self.graph.cost, default=nothing)

    def _trees(self, left: Mask) -> Iterator[_Tree]:
        for root in _spread(self._parts.places, np.flatnonzero(left)):
            for margin in (_MARGIN, 0.0):
                off = margin * self._space.units
                limits = self._space.lower + off, self._space.upper - off
                for start in self._starts(root, limits):
                    self._deadline.check()
                    yield self.graph.tree(root, start, left, limits)

    def _starts(self, root: int, limits: _Limits) -> list[Index]:
        """Turns (joints,) of a root that are inside the limits."""
        ends = self._parts.lowest[root], self._parts.highest[root]
        choices = [turns[:_PER_JOINT] for turns in _fitting(*ends, limits, self._space.period)]
        if self._free.reached[root]:
            for joint, fixed in enumerate(self._fixed):
                if fixed is not None:
                    choices[joint] = [fixed + int(self._free.turns[root, joint])]
        return [np.array(turns, dtype=np.int64) for turns in product(*choices)]


def _fitting(lowest: Array, highest: Array, limits: _Limits, period: Array) -> list[list[int]]:
    """For each joint the turns that bring a range of positions inside limits, middle ones first."""
    spans = zip(lowest, highest, *limits, period, strict=True)
    return [_fitting_turns(*span) for span in spans]


def _fitting_turns(
    lowest: float, highest: float, lower: float, upper: float, period: float
) -> list[int]:
    if not (np.isfinite(lower) and np.isfinite(upper)):
        return [0]
    if not period:
        return [0] if lower <= lowest and highest <= upper else []
    first, last = np.ceil((lower - lowest) / period), np.floor((upper - highest) / period)
    middle = (lower + upper - lowest - highest) / 2
    return sorted(range(int(first), int(last) + 1), key=lambda turn: abs(period * turn - middle))


def _spread(places: Array, members: Index) -> list[int]:
    """Some of the members, each as far as can be from those before it."""
    chosen = [int(members[0])]
    away = np.linalg.norm(places[members] - places[chosen[0]], axis=1)
    while len(chosen) < min(_ROOTS, len(members)):
        chosen.append(int(members[int(np.argmax(away))]))
        away = np.minimum(away, np.linalg.norm(places[members] - places[chosen[-1]], axis=1))
    return chosen
