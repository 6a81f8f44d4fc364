"""Ways through free space from one configuration to another: straight, or over others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Mask, angles_between
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import DISTANCE, TURN, joint_space
from cellcolor.motion.free_space import FreeSpace

# Bounds in rad are in units of a slide as well (JointSpace.units).
_SHARES = (1.0, 0.4, 0.1)  # of the clearance that the ends of a way keep, the most that they can
FEW, MANY = 250, 2_000
"""Configurations drawn for one move: seconds, or half a minute."""
_ROOM = 0.999  # of the largest steps, for rounding
_COARSE = 0.04  # rad, between samples of a move that is only tried
_DRAWN, _STOPS = 256, 40  # configurations drawn for a map of free ones, and kept in it
_WIDER = 0.7  # rad; around the ends of all retreats they are drawn from
_LIFTED = 4  # heights above each retreat that are in it, a retreat apart
_NEIGHBORS = 100  # of a configuration in a map, that moves lead to
_TESTS, _MOST_TESTS = 4, 1_000  # moves of a map that are tested, for each of its configurations
_SPARE = 0.005  # m, more than the clearance that is kept while a way is looked for
_NEAR = 0.3  # rad; this close to its ends a transfer keeps only the clearance that these keep
_BREAK = 0.2  # s; what a stop on the way costs
_SHOWN = 3  # pairs of bodies that are named


@dataclass(frozen=True)
class Transfer:
    """A motion without contact, its first and last configuration included.

    Attributes:
        joints: (k, joints) rad or m, unwound.
        gap: the configuration after which the way was not planned; None if all was planned.
        blocked: what is in the way there, a clause.
    """

    joints: Array
    gap: int | None = None
    blocked: str = ""


class Ways:
    """Finds ways between configurations, for one scene.

    Attributes:
        levels: where the arm keeps its clearance, and less and less of it.
    """

    def __init__(
        self,
        prepared: PreparedScene,
        motion: Motion,
        velocities: Array,
        home: Array | None,
        seed: int,
        deadline: Deadline,
    ) -> None:
        """``velocities`` (joints,) in rad/s or m/s; ``seed`` is that of drawn configurations."""
        self._prepared, self._motion, self._velocities = prepared, motion, velocities
        self._home, self._seed, self._deadline = home, seed, deadline
        self.levels = [FreeSpace(prepared, motion.clearance_m, share) for share in _SHARES]
        self.space, self._clear = joint_space(prepared), self.levels[0]
        self._wide = FreeSpace(prepared, motion.clearance_m + _SPARE)
        self._stops: list[Array] = []

    def pass_near(self, ends: Sequence[tuple[Array, int]]) -> None:
        """Ways may lead over places near these from now on: configurations and their branches."""
        self._stops = self._free_stops([end for end, _ in ends])
        self._stops += [high for end in ends for high in self._higher(*end)]

    def share(self, start: Array, end: Array) -> float:
        """What share of the samples of a straight move is not free."""
        count = max(1, int(np.ceil(self.space.largest(end - start) / _COARSE)))
        share = np.linspace(0.0, 1.0, count + 1)[:, None]
        return float(1.0 - self._clear(start + share * (end - start)).mean())

    def level(self, joints: Array) -> int:
        """Which share of the clearance (``_SHARES``) is kept; their number for none."""
        each = (level for level, free in enumerate(self.levels) if free.clear(joints[None])[0])
        return next(each, len(_SHARES))

    def between(self, start: Array, end: Array, drawn: int) -> Transfer:
        """Straight for the joints, or over free configurations, or not at all.

        Args:
            start, end: (joints,) both inside the limits.
            drawn: configurations, to be led over where the known stops do not do.
        """
        levels = self.level(start), self.level(end)
        if max(levels) == len(_SHARES):
            where = (start, end)[int(np.argmax(levels))]
            return Transfer(np.array([start, end]), 0, self._bodies(where[None]))
        near = self.levels[max(levels)]
        for over in (self._clear, near) if max(levels) else (self._clear,):
            free = self._ramped(over, near, start, end)
            roomy = self._wide if over is self._clear else over
            for more in (0, drawn):
                stops = [*self._stops, *self._drawn([start, end], more, roomy)]
                found = self._over_stops(start, end, stops, free)
                if found is not None:
                    return Transfer(found)
        straight = self._dense(np.array([start, end]))
        return Transfer(np.array([start, end]), 0, self._bodies(straight[~self._clear(straight)]))

    def _bodies(self, configurations: Array) -> str:
        """Which bodies are in each other's way in the middle one of some configurations."""
        if not len(configurations):
            return "no way was found round what is near"
        found = self._clear.touched(configurations[len(configurations) // 2])
        return ", ".join(found[:_SHOWN]) or "a joint limit"

    def _ramped(
        self, over: FreeSpace, near: FreeSpace, start: Array, end: Array
    ) -> Callable[[Array], Mask]:
        """Which configurations (k, joints) are free, those near the ends with less room.

        With room to spare, a way that was tested at few configurations is free between them too.
        """

        def free(configurations: Array) -> Mask:
            found = over(configurations)
            off = np.minimum(
                self.space.largest(configurations - start),
                self.space.largest(configurations - end),
            )
            doubtful = np.flatnonzero(~found & (off < _NEAR))
            found[doubtful] = near(configurations[doubtful])
            return found

        return free

    def _higher(self, end: Array, branch: int) -> Array:
        """Free configurations (k, joints) straight above another one, as the tool points."""
        poses = forward(self._prepared.robot, end[None])
        heights = self._motion.retract_m * np.arange(1, _LIFTED + 1)
        points = poses.tip - heights[:, None] * poses.tool_axis
        found = self._prepared.arm.follow(
            points, np.tile(poses.tool_axis, (_LIFTED, 1)), np.full(_LIFTED, branch, dtype=np.intp)
        )
        found = found[~np.isnan(found[:, 0])]
        found = end + self.space.unwrap(np.concatenate([end[None], found]) - end)[1:]
        return np.asarray(found[self._clear(found)])

    def _free_stops(self, ends: Sequence[Array]) -> list[Array]:
        """Free configurations that ways may lead over: home, and some about the strokes' ends."""
        stops = [] if self._home is None else [self._home]
        return stops + self._drawn([*ends, *stops], _DRAWN, self._wide)[:_STOPS]

    def _drawn(self, around: Sequence[Array], count: int, free: FreeSpace) -> list[Array]:
        """The free ones of some configurations drawn around others."""
        space, places = self.space, np.array(around)
        low = np.maximum(places.min(axis=0) - _WIDER * space.units, space.lower)
        high = np.minimum(places.max(axis=0) + _WIDER * space.units, space.upper)
        drawn = np.random.default_rng(self._seed).uniform(low, high, (count, len(low)))
        return list(drawn[free(drawn)])

    def _over_stops(
        self, start: Array, end: Array, stops: Sequence[Array], free: Callable[[Array], Mask]
    ) -> Array | None:
        """The quickest way over stops whose straight moves are free, sampled; None without one."""
        nodes = np.array([start, end, *stops])
        seconds = (np.abs(nodes[:, None] - nodes[None]) / self._velocities).max(axis=2)
        tested: dict[tuple[int, int], Array] = {}

        def is_free(one: int, other: int) -> bool:
            count = max(2, int(np.ceil(self.space.largest(nodes[other] - nodes[one]) / _COARSE)))
            share = np.linspace(0.0, 1.0, count + 1)[:, None]
            if not free(nodes[one] + share * (nodes[other] - nodes[one])).all():
                return False
            tested[one, other] = self._dense(nodes[[one, other]])
            return bool(free(tested[one, other]).all())

        way = quickest_way(seconds + _BREAK, is_free, self._deadline)
        if way is None:
            return None
        return np.concatenate([nodes[:1], *(tested[move][1:] for move in pairwise(way))])

    def _dense(self, corners: Array) -> Array:
        """Samples (k, joints) of straight ways for the joints through corners (c, joints).

        From one to the next the tip and every slide move at most 1 mm, and the tool's axis and
        every other joint turn by at most 1 degree.
        """
        parts = [corners[:1]]
        most = np.where(self.space.slides, DISTANCE, TURN) * _ROOM
        for start, end in pairwise(corners):
            count = max(1, int(np.ceil((np.abs(end - start) / most).max())))
            while True:
                share = np.linspace(0.0, 1.0, count + 1)[:, None]
                way = start + share * (end - start)
                poses = forward(self._prepared.robot, way)
                moved = np.linalg.norm(np.diff(poses.tip, axis=0), axis=1) / DISTANCE
                turned = angles_between(poses.tool_axis[:-1], poses.tool_axis[1:]) / TURN
                excess = float(np.maximum(moved, turned).max())
                if excess <= 1.0:
                    break
                count = int(np.ceil(count * excess / _ROOM))
            parts.append(way[1:])
        return np.concatenate(parts)


def quickest_way(
    seconds: Array, is_free: Callable[[int, int], bool], deadline: Deadline
) -> list[int] | None:
    """The quickest way from the first node to the second, by its nodes; None if none is found.

    Moves are tested only where they are on the quickest way that is left (Bohlin and Kavraki,
    Path planning using lazy PRM, 2000). Beside those of the two ends, only moves to the nearest
    nodes count.

    Args:
        seconds: (n, n) how long each move takes, above 0.
        is_free: whether there is a move from one node to another; asked once of each.
    """
    kept = seconds.argsort(axis=1).argsort(axis=1) <= _NEIGHBORS
    kept[:2], kept[:, :2] = True, True
    graph = csr_array(np.where(kept | kept.T, seconds, 0.0))
    known: set[tuple[int, int]] = set()
    for _ in range(min(_TESTS * len(seconds), _MOST_TESTS)):
        deadline.check()
        lengths, before = dijkstra(graph, indices=0, return_predecessors=True)
        if not np.isfinite(lengths[1]):
            return None
        way = [1]
        while way[-1]:
            way.append(int(before[way[-1]]))
        way.reverse()
        untested = next((move for move in pairwise(way) if move not in known), None)
        if untested is None:
            return way
        if is_free(*untested):
            known.add(untested)
        else:
            one, other = untested
            graph[one, other] = graph[other, one] = np.inf
    return None
