"""From one stroke to the next: off the surface, through free space, and back to the surface."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import joint_space
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.home import home_of
from cellcolor.motion.samples import DISTANCE, TURN, angles_between
from cellcolor.motion.sampling_planner import sampled_way
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.turns import Visit, chosen_turns

# Bounds in rad are in units of a slide as well (JointSpace.units).
_FASTER = 0.3  # rad; from one sample of a retreat to the next a branch that jumps moves farther
_TILTS = (30.0, 60.0)  # degrees off the normal, of retreats where that along it is blocked
_AROUND = 6  # of each tilt
_SHARES = (1.0, 0.4, 0.1)  # of the clearance that a retreat's end keeps, the most that it can
_STARTS = 24  # of a closed stroke that are tried where the arm cannot leave
_TRIMMED = 0.5  # spacings that an open stroke may lose at an end for that
_RETRACED = 10.0, 0.15  # spacings, or of a stroke's length, that it may go back over for that
_COARSE = 0.04  # rad, between samples of a move that is only tried
_FINE = 0.01  # rad, the same where that let a hit through
_DRAWN, _STOPS = 256, 40  # configurations drawn for a map of free ones, and kept in it
_WIDER = 0.7  # rad; around the ends of all retreats they are drawn from
_LIFTED = 4  # heights above each retreat that are in it, a retreat apart
_TESTS = 150  # moves of that map that are tested for one transfer
_FEW_ROUNDS, _MANY_ROUNDS = 600, 6_000  # of the sampling planner: seconds, or half a minute
_SPARE = 0.005  # m, more than the clearance that is kept while a way is looked for
_NEAR = 0.3  # rad; this close to its ends a transfer keeps only the clearance that these keep
_BREAK = 0.2  # s; what a stop on the way costs
_BLOCKED = 10.0  # s; added to the time of a move for which no simple way is known
_DEEP = 60.0  # s; and by so much, times the share of it that is not free
_LONGER = 10.0  # times the time of a straight move that is blocked; so few turns are preferred
_ROOM = 0.999  # of the largest steps, for rounding
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
        self._prepared, self._seed, self._deadline = prepared, seed, deadline
        self._motion, self._velocities = motion, velocities
        self._leaving = FreeSpace(prepared, 0.0, leaving=True)
        self._levels = [FreeSpace(prepared, motion.clearance_m, share) for share in _SHARES]
        self._clear = self._levels[0]
        self._wide = FreeSpace(prepared, motion.clearance_m + _SPARE)
        self.home, self._space = home_of(prepared, motion), joint_space(prepared)
        self._shares: dict[bytes, float] = {}
        self._stops: list[Array] = []

    def between_strokes(self, strokes: Sequence[Stroke]) -> tuple[list[Stroke], list[Transfer]]:
        """The strokes with ends and turns fixed, and all motions without contact.

        These are the way to the first stroke, those between strokes, and the way from the last
        one. Without a home position the first begins, and the last ends, where the tool is
        retracted.

        Args:
            strokes: in their order.

        Raises:
            OutOfTime: the deadline came first.
        """
        left = [self._left(stroke) for stroke in strokes]
        strokes = [stroke for stroke, _, _ in left]
        onto, off = [way for _, way, _ in left], [way for _, _, way in left]
        space, home = self._space, self.home
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
        ends = [
            (way[-1], stroke.branch)
            for ways in (onto, off)
            for way, stroke in zip(ways, turned, strict=True)
        ]
        self._stops = self._free_stops([end for end, _ in ends])
        self._stops += [high for end in ends for high in self._higher(*end)]
        if home is None:
            return turned, [
                Transfer(onto[0][::-1]),
                *(self._joined(*ways) for ways in zip(off[:-1], onto[1:], strict=True)),
                Transfer(off[-1]),
            ]
        ways = zip([home[None], *off], [*onto, home[None]], strict=True)
        return turned, [self._joined(*pair) for pair in ways]

    def _left(self, stroke: Stroke) -> tuple[Stroke, Array, Array]:
        """A stroke that begins and ends where the arm can leave it, and both retreats.

        A closed one begins where a straight joint move leads home as well, if it does anywhere, so
        that there is a way to every other stroke. An open one loses a little at the end, or goes
        back over itself as far as to a place that the arm can leave; if there is none, it stays as
        it is.
        """
        if stroke.is_closed(self._space):
            apart = np.linspace(0, len(stroke) - 1, _STARTS, endpoint=False).astype(int)
            left: list[tuple[float, Stroke, Array]] = []
            for at in sorted(set(apart.tolist()), key=lambda at: min(at, len(stroke) - at)):
                begun = stroke.begun_at(at, self._space)
                onto = self._retreat(begun, 0)
                if len(onto) > 1:
                    left.append((self._from_home(onto[-1]), begun, onto))
                    if not left[-1][0]:
                        break
            if left:
                _, begun, onto = min(left, key=lambda one: one[0])
                wound = self._space.period * self._space.periods(begun.joints[-1] - onto[0])
                return begun, onto, onto + wound
        onto = self._retreat(stroke, 0)
        if len(onto) == 1:
            stroke, onto = self._ended_elsewhere(stroke.reversed())
            stroke = stroke.reversed()
        off = self._retreat(stroke, -1)
        if len(off) == 1:
            stroke, off = self._ended_elsewhere(stroke)
        return stroke, onto, off

    def _ended_elsewhere(self, stroke: Stroke) -> tuple[Stroke, Array]:
        """A stroke with an end that the arm can leave, and the retreat from it."""
        spacing = self._motion.spacing_m
        steps = np.linalg.norm(np.diff(stroke.points[::-1], axis=0), axis=1)
        back = np.concatenate([[0.0], np.cumsum(steps)])  # from the end on
        most = max(_RETRACED[0] * spacing, _RETRACED[1] * back[-1])
        for far in np.arange(0.25, most / spacing, 0.5) * spacing:
            if far >= back[-1]:
                break
            self._deadline.check()
            at = len(stroke) - 1 - int(np.searchsorted(back, far))
            off = self._retreat(stroke, at)
            if len(off) == 1 or at < 1:
                continue
            if far <= _TRIMMED * spacing:
                return stroke.part(0, at + 1), off
            again = slice(len(stroke) - 2, at - 1 if at else None, -1)
            return stroke.followed_by(again), off
        return stroke, stroke.joints[-1:]

    def _retreat(self, stroke: Stroke, at: int) -> Array:
        """Off the surface from a sample of a stroke, at most as high as the setup says.

        Along the normal if that leads to where the arm keeps its clearance, otherwise in the
        direction in which it comes to keep most of it. Direction of the tool and branch stay the
        same. There may be no way off, and then it has no length.

        Returns:
            (k, joints) from the contact on, unwound.
        """
        joints, normal = stroke.joints[at], stroke.normals[at]
        found = []
        for direction in _directions(normal):
            way = self._off(joints, normal, direction, stroke.branch)
            if len(way) == 1:
                continue
            level = self._level(way[-1])
            if level == 0:
                return way
            found.append((level, -len(way), way))
        return min(found, key=lambda one: one[:2])[2] if found else joints[None]

    def _off(self, joints: Array, normal: Array, direction: Array, branch: int) -> Array:
        """One retreat (k, joints), cut where it is as high as it can be."""
        height = self._motion.retract_m
        tip = forward(self._prepared.robot, joints[None]).tip[0]
        count = int(np.ceil(height / (DISTANCE * _ROOM)))
        points = tip + np.linspace(0.0, height, count + 1)[1:, None] * direction
        axes, branches = np.tile(-normal, (count, 1)), np.full(count, branch, dtype=np.intp)
        found = self._prepared.arm.follow(points, axes, branches)
        solved = ~np.isnan(found[:, 0])
        found = found[: count if solved.all() else int(np.argmin(solved))]
        way = joints + self._space.unwrap(np.concatenate([joints[None], found]) - joints)
        steady = self._space.largest(np.diff(way, axis=0)) <= _FASTER
        fine = np.append(steady & self._leaving.clear(way[1:]), False)
        return self._cut(way[: int(np.argmin(fine)) + 1])

    def _cut(self, way: Array) -> Array:
        """A way off as far as it keeps most of the clearance."""
        for free in self._levels:
            clear = np.flatnonzero(free.clear(way[1:]))
            if len(clear):
                return np.asarray(way[: clear[-1] + 2])
        return way[:1]

    def _level(self, joints: Array) -> int:
        """Which share of the clearance (``_SHARES``) is kept; their number for none."""
        each = (level for level, free in enumerate(self._levels) if free.clear(joints[None])[0])
        return next(each, len(_SHARES))

    def _high(self, way: Array) -> Array:
        """A retreat, cut where it leaves the limits, and there where it is still clear."""
        inside = np.append(self._clear.inside(way), False)
        if inside[:-1].all():
            return way
        return self._cut(way[: max(1, int(np.argmin(inside)))])

    def _joined(self, off: Array, onto: Array) -> Transfer:
        """Along one retreat, freely to the end of another one, and back along that."""
        if len(off) == 1 and len(onto) == 1:
            off = np.concatenate([off, off])  # so that there is a sample without contact
        between = self._between(off[-1], onto[-1])
        joints = np.concatenate([off[:-1], between.joints, onto[:-1][::-1]])
        gap = None if between.gap is None else len(off) - 1 + between.gap
        return Transfer(joints, gap, between.blocked)

    def _blocked(self, start: Array, end: Array) -> float:
        """What share of the samples of a straight move is not free."""
        key = start.tobytes() + end.tobytes()
        if key not in self._shares:
            self._deadline.check()
            self._shares[key] = self._share(start, end)
        return self._shares[key]

    def _from_home(self, end: Array) -> float:
        """What share of a straight move between home and a configuration is not free."""
        if self.home is None:
            return 0.0
        near = end - self._space.period * self._space.periods(end - self.home)
        return self._blocked(self.home, near)

    def _detour(self, start: Array, end: Array) -> float:
        """How much longer than a straight move the way will probably be, s; 0 if that is free."""
        share = self._blocked(start, end)
        if share == 0.0:
            return 0.0
        if self.home is not None:
            legs = (start, self.home), (self.home, end)
            if all(self._blocked(*leg) == 0.0 for leg in legs):
                return sum(self._seconds(*leg) for leg in legs) - self._seconds(start, end)
        return _BLOCKED + _DEEP * share + _LONGER * self._seconds(start, end)

    def _seconds(self, start: Array, end: Array) -> float:
        return float((np.abs(end - start) / self._velocities).max())

    def _share(self, start: Array, end: Array) -> float:
        count = max(1, int(np.ceil(self._space.largest(end - start) / _COARSE)))
        share = np.linspace(0.0, 1.0, count + 1)[:, None]
        return float(1.0 - self._clear(start + share * (end - start)).mean())

    def _between(self, start: Array, end: Array) -> Transfer:
        """Straight for the joints, or over free configurations, or as sampled, or not at all."""
        levels = self._level(start), self._level(end)
        if max(levels) == len(_SHARES):
            where = (start, end)[int(np.argmax(levels))]
            return Transfer(np.array([start, end]), 0, self._bodies(where[None]))
        near = self._levels[max(levels)]
        for over in (self._clear, near) if max(levels) else (self._clear,):
            free = self._ramped(over, near, start, end)
            found = self._over_stops(start, end, free)
            if found is not None:
                return Transfer(found)
            roomy = self._ramped(self._wide, near, start, end) if over is self._clear else free
            last = over is near
            for tested, step, rounds in (
                (roomy, _COARSE, _FEW_ROUNDS),
                (free, _FINE, _MANY_ROUNDS if last else _FEW_ROUNDS),
            ):
                corners = sampled_way(
                    start, end, self._space, tested, step, rounds, self._seed, self._deadline
                )
                self._deadline.check()
                if corners is not None and free(way := self._dense(corners)).all():
                    self._stops += list(corners[1:-1])
                    return Transfer(way)
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
                self._space.largest(configurations - start),
                self._space.largest(configurations - end),
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
        found = end + self._space.unwrap(np.concatenate([end[None], found]) - end)[1:]
        return np.asarray(found[self._clear(found)])

    def _free_stops(self, ends: Sequence[Array]) -> list[Array]:
        """Free configurations that ways may lead over: home, and some about the strokes' ends."""
        stops = [] if self.home is None else [self.home]
        around = np.array([*ends, *stops])
        low = np.maximum(around.min(axis=0) - _WIDER * self._space.units, self._space.lower)
        high = np.minimum(around.max(axis=0) + _WIDER * self._space.units, self._space.upper)
        drawn = np.random.default_rng(self._seed).uniform(low, high, (_DRAWN, len(low)))
        return stops + list(drawn[self._wide(drawn)][:_STOPS])

    def _over_stops(self, start: Array, end: Array, free: Callable[[Array], Mask]) -> Array | None:
        """The quickest way over stops whose straight moves are free, sampled; None without one.

        Moves are tested only where they are on the quickest way that is left (Bohlin and Kavraki,
        Path planning using lazy PRM, 2000).
        """
        nodes = np.array([start, end, *self._stops])
        seconds = (np.abs(nodes[:, None] - nodes[None]) / self._velocities).max(axis=2)
        seconds += _BREAK * ~np.eye(len(nodes), dtype=bool)
        tested: dict[tuple[int, int], Array] = {}
        for _ in range(_TESTS):
            self._deadline.check()
            lengths, before = dijkstra(seconds, indices=0, return_predecessors=True)
            if not np.isfinite(lengths[1]):
                return None
            way = [1]
            while way[-1]:
                way.append(int(before[way[-1]]))
            moves = list(pairwise(way[::-1]))
            untested = next((move for move in moves if move not in tested), None)
            if untested is None:
                return np.concatenate([nodes[:1], *(tested[move][1:] for move in moves)])
            one, other = untested
            count = max(2, int(np.ceil(self._space.largest(nodes[other] - nodes[one]) / _COARSE)))
            share = np.linspace(0.0, 1.0, count + 1)[:, None]
            is_free = bool(free(nodes[one] + share * (nodes[other] - nodes[one])).all())
            if is_free:
                tested[untested] = self._dense(nodes[[one, other]])
                is_free = bool(free(tested[untested]).all())
            if not is_free:
                tested.pop(untested, None)
                seconds[one, other] = seconds[other, one] = 0.0  # no edge, in scipy's words
        return None

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


def _directions(normal: Array) -> Iterator[Array]:
    """The normal (3,), then unit vectors tilted off it, around it."""
    yield normal
    across = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    across /= np.linalg.norm(across)
    other = np.cross(normal, across)
    for tilt in np.radians(_TILTS):
        for turn in 2 * np.pi * np.arange(_AROUND) / _AROUND:
            aside = np.cos(turn) * across + np.sin(turn) * other
            yield np.cos(tilt) * normal + np.sin(tilt) * aside
