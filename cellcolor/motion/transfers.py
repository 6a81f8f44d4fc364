"""From one stroke to the next: off the surface, through free space, and back to the surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import joint_space
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.home import check_home, home_of
from cellcolor.motion.samples import DISTANCE, TURN, angles_between
from cellcolor.motion.sampling_planner import sampled_way
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.turns import Visit, chosen_turns

# Bounds in rad are in units of a slide as well (JointSpace.units).
_FASTER = 0.3  # rad; from one sample of a retreat to the next a branch that jumps moves farther
_COARSE = 0.04  # rad, between samples of a move that is only tried
_FEW_ROUNDS, _MANY_ROUNDS = 600, 20_000  # of the sampling planner: seconds, or a minute or two
_FINE = 0.01  # rad, the same where that let a hit through
_SPARE = 0.005  # m, more than the clearance that is kept while a way is looked for
_NEAR = 0.3  # rad; so near its ends it keeps no more than the clearance
_BLOCKED = 10.0  # s; by so much longer a move counts that no simple way is known for
_DEEP = 60.0  # s; and by so much, times the share of it that is not free
_ROOM = 0.999  # of the largest steps, for rounding


@dataclass(frozen=True)
class Transfer:
    """A motion without contact, its first and last configuration included.

    Attributes:
        joints: (k, joints) rad or m, unwound.
        gap: the configuration after which the way was not planned; None if all was planned.
    """

    joints: Array
    gap: int | None


class Transfers:
    """Plans motions between strokes, for one scene."""

    def __init__(
        self,
        prepared: PreparedScene,
        motion: Motion,
        velocities: Array,
        seed: int,
        deadline: Deadline,
    ) -> None:
        """``velocities`` (joints,) in rad/s or m/s; ``seed`` is that of the sampling planner.

        Raises:
            InputError: the home position is not free.
        """
        check_home(prepared, motion)
        self._prepared, self._seed, self._deadline = prepared, seed, deadline
        self._height, self._velocities = motion.retract_m, velocities
        self._leaving = FreeSpace(prepared, 0.0, leaving=True)
        self._clear = FreeSpace(prepared, motion.clearance_m)
        self._wide = FreeSpace(prepared, motion.clearance_m + _SPARE)
        self._home, self._space = home_of(motion), joint_space(prepared)
        self._shares: dict[bytes, float] = {}

    def between_strokes(self, strokes: Sequence[Stroke]) -> tuple[list[Stroke], list[Transfer]]:
        """The strokes with their turns fixed, and all motions without contact.

        These are the way to the first stroke, those between strokes, and the way from the last
        one. Without a home position the first begins, and the last ends, where the tool is
        retracted.

        Args:
            strokes: in their order.

        Raises:
            OutOfTime: the deadline came first.
        """
        onto, off = (
            [self._retreat(one.joints[at], one.normals[at], one.branch) for one in strokes]
            for at in (0, -1)
        )
        space, home = self._space, self._home
        visits = []
        for way_on, stroke, way_off in zip(onto, strokes, off, strict=True):
            span = np.concatenate([way_on, stroke.joints, way_off])
            if not space.fits(span):
                span = stroke.joints
            visits.append(Visit(way_on[-1], way_off[-1], span))
        circles = chosen_turns(visits, home, space, self._velocities, self._detour)
        turned = [stroke.turned(own, space) for stroke, own in zip(strokes, circles, strict=True)]
        onto, off = (
            [self._high(way + space.period * own) for way, own in zip(ways, circles, strict=True)]
            for ways in (onto, off)
        )
        if home is None:
            return turned, [
                Transfer(onto[0][::-1], None),
                *(self._joined(*ways) for ways in zip(off[:-1], onto[1:], strict=True)),
                Transfer(off[-1], None),
            ]
        ways = zip([home[None], *off], [*onto, home[None]], strict=True)
        return turned, [self._joined(*pair) for pair in ways]

    def _retreat(self, joints: Array, normal: Array, branch: int) -> Array:
        """Off the surface along the normal, at most as high as the setup says.

        The branch stays the same. The way ends at the greatest height that is clear of everything,
        with nothing in the way below it; there may be none, and then it has no length.

        Args:
            joints: (joints,) in contact, unwound.
            normal: (3,) the surface's, outward.
            branch: of the configuration.

        Returns:
            (k, joints) from the contact on, unwound.
        """
        tip = forward(self._prepared.robot, joints[None]).tip[0]
        count = int(np.ceil(self._height / (DISTANCE * _ROOM)))
        heights = np.linspace(0.0, self._height, count + 1)[1:]
        points = tip + heights[:, None] * normal
        directions = np.tile(-normal, (count, 1))
        found = self._prepared.arm.follow(points, directions, np.full(count, branch, dtype=np.intp))
        solved = ~np.isnan(found[:, 0])
        found = found[: count if solved.all() else int(np.argmin(solved))]
        way = joints + self._space.unwrap(np.concatenate([joints[None], found]) - joints)
        steady = self._space.largest(np.diff(way, axis=0)) <= _FASTER
        fine = np.append(steady & self._leaving.clear(way[1:]), False)
        way = way[: int(np.argmin(fine)) + 1]
        clear = np.flatnonzero(self._clear.clear(way[1:]))
        return np.asarray(way[: clear[-1] + 2 if len(clear) else 1])

    def _high(self, way: Array) -> Array:
        """A retreat, cut where it leaves the limits, and there where it is still clear."""
        inside = np.append(self._clear.inside(way), False)
        if inside[:-1].all():
            return way
        way = way[: max(1, int(np.argmin(inside)))]
        clear = np.flatnonzero(self._clear(way[1:]))
        return np.asarray(way[: clear[-1] + 2 if len(clear) else 1])

    def _joined(self, off: Array, onto: Array) -> Transfer:
        """Along one retreat, freely to the end of another one, and back along that."""
        if len(off) == 1 and len(onto) == 1:
            off = np.concatenate([off, off])  # so that there is a sample without contact
        between = self._between(off[-1], onto[-1])
        joints = np.concatenate([off[:-1], between.joints, onto[:-1][::-1]])
        return Transfer(joints, None if between.gap is None else len(off) - 1 + between.gap)

    def _blocked(self, start: Array, end: Array) -> float:
        """What share of the samples of a straight move is not free."""
        key = start.tobytes() + end.tobytes()
        if key not in self._shares:
            self._deadline.check()
            self._shares[key] = self._share(start, end)
        return self._shares[key]

    def _detour(self, start: Array, end: Array) -> float:
        """How much longer than a straight move the way will probably be, s; 0 if that is free."""
        share = self._blocked(start, end)
        if share == 0.0:
            return 0.0
        if self._home is not None:
            legs = (start, self._home), (self._home, end)
            if all(self._blocked(*leg) == 0.0 for leg in legs):
                return sum(self._seconds(*leg) for leg in legs) - self._seconds(start, end)
        return _BLOCKED + _DEEP * share

    def _seconds(self, start: Array, end: Array) -> float:
        return float((np.abs(end - start) / self._velocities).max())

    def _share(self, start: Array, end: Array) -> float:
        count = max(1, int(np.ceil(self._space.largest(end - start) / _COARSE)))
        share = np.linspace(0.0, 1.0, count + 1)[:, None]
        return float(1.0 - self._clear(start + share * (end - start)).mean())

    def _between(self, start: Array, end: Array) -> Transfer:
        """Straight for the joints, or over the home position, or as sampled, or not at all."""
        tried = [np.array([start, end])]
        if self._home is not None:
            tried.append(np.array([start, self._home, end]))
        for corners in tried:
            self._deadline.check()
            way = self._dense(corners)
            if self._clear(way).all():
                return Transfer(way, None)
        if self._clear(np.array([start, end])).all():
            roomy = self._roomy(start, end)
            for free, step, rounds in (
                (roomy, _COARSE, _FEW_ROUNDS),
                (self._clear, _FINE, _FEW_ROUNDS),
                (self._clear, _FINE, _MANY_ROUNDS),
            ):
                found = sampled_way(
                    start, end, self._space, free, step, rounds, self._seed, self._deadline
                )
                self._deadline.check()
                if found is None:
                    continue
                way = self._dense(found)
                if self._clear(way).all():
                    return Transfer(way, None)
        return Transfer(np.array([start, end]), 0)

    def _roomy(self, start: Array, end: Array) -> Callable[[Array], Mask]:
        """Free with more room than needed, but near the ends, which need not have it.

        With that a way that was tested at few configurations is free between them as well.
        """

        def free(configurations: Array) -> Mask:
            found = self._wide(configurations)
            off = np.minimum(
                self._space.largest(configurations - start),
                self._space.largest(configurations - end),
            )
            doubtful = np.flatnonzero(~found & (off < _NEAR))
            found[doubtful] = self._clear(configurations[doubtful])
            return found

        return free

    def _dense(self, corners: Array) -> Array:
        """Samples (k, joints) of straight ways for the joints through corners (c, joints).

        From one to the next the tip and every slide move at most 1 mm, and the tool's axis and
        every other joint turn by at most 1 degree.
        """
        parts = [corners[:1]]
        most = np.where(self._space.slides, DISTANCE, TURN) * _ROOM
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
