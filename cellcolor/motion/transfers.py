"""From one stroke to the next: off the surface, through free space, and back to the surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.home import home_of
from cellcolor.motion.samples import DISTANCE
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.turns import Visit, chosen_turns
from cellcolor.motion.ways import FEW_ROUNDS, MANY_ROUNDS, Transfer, Ways

# Bounds in rad are in units of a slide as well (JointSpace.units).
_FASTER = 0.3  # rad; from one sample of a retreat to the next a branch that jumps moves farther
_TILTS = (30.0, 60.0)  # degrees off the normal, of retreats where that along it is blocked
_AROUND = 6  # of each tilt
_STARTS = 24  # of a closed stroke that are tried where the arm cannot leave
_TRIMMED = 0.5  # spacings that an open stroke may lose at an end for that
_RETRACED = 10.0, 0.15  # spacings, or of a stroke's length, that it may go back over for that
_ATTEMPTS = 5  # of turns of the strokes, while some move is not planned
_HOPELESS = 1000.0  # s; added to the time of such a move
_BLOCKED = 10.0  # s; added to the time of a move for which no simple way is known
_DEEP = 60.0  # s; and by so much, times the share of it that is not free
_LONGER = 10.0  # times the time of a straight move that is blocked; so few turns are preferred
_ROOM = 0.999  # of the largest steps, for rounding


@dataclass(frozen=True)
class _Turned:
    """Strokes with their turns, and the moves without contact before, between and after them.

    Attributes:
        circles: of each stroke, the full circles (joints,) that it is turned by.
        ways: of each move, the retreats (k, joints) that it begins and ends with.
    """

    circles: Sequence[Index]
    strokes: list[Stroke]
    ways: list[tuple[Array, Array]]
    transfers: list[Transfer]

    @property
    def gaps(self) -> list[int]:
        """The numbers of the moves that were not planned."""
        return [at for at, one in enumerate(self.transfers) if one.gap is not None]


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
        self._prepared, self._deadline = prepared, deadline
        self._motion, self._velocities = motion, velocities
        self._leaving = FreeSpace(prepared, 0.0, leaving=True)
        self.home = home_of(prepared, motion)
        self._ways = Ways(prepared, motion, velocities, self.home, seed, deadline)
        self._space = self._ways.space
        self._shares: dict[bytes, float] = {}
        self._hopeless: set[bytes] = set()

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
        tried: list[_Turned] = []
        for _ in range(_ATTEMPTS):
            circles = chosen_turns(visits, home, space, self._velocities, self._detour)
            if any(np.array_equal(circles, before.circles) for before in tried):
                break
            tried.append(self._with_turns(strokes, onto, off, circles))
            gaps = tried[-1].gaps
            if not gaps:
                break
            # Other turns may be as quick, and lead where there is a way.
            ends = np.array([own.end for own in visits]) + space.period * circles
            starts = np.array([own.start for own in visits]) + space.period * circles
            if home is not None:
                starts, ends = np.vstack([starts, home]), np.vstack([home, ends])
            else:
                starts, gaps = starts[1:], [gap - 1 for gap in gaps]
            self._hopeless |= {ends[gap].tobytes() + starts[gap].tobytes() for gap in gaps}
        best = min(tried, key=lambda one: len(one.gaps))
        for gap in best.gaps:
            rounds = max(FEW_ROUNDS, MANY_ROUNDS // len(best.gaps))
            best.transfers[gap] = self._joined(*best.ways[gap], rounds)
        return best.strokes, best.transfers

    def _with_turns(
        self,
        strokes: Sequence[Stroke],
        onto: Sequence[Array],
        off: Sequence[Array],
        circles: Sequence[Index],
    ) -> _Turned:
        """The strokes and their retreats turned by full circles, and the moves between them."""
        space, home = self._space, self.home
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
        self._ways.pass_near(ends)
        if home is not None:
            onto, off = [*onto, home[None]], [home[None], *off]
            ways = list(zip(off, onto, strict=True))
            return _Turned(circles, turned, ways, [self._joined(*pair) for pair in ways])
        ways = list(zip(off[:-1], onto[1:], strict=True))
        between = [self._joined(*pair) for pair in ways]
        whole = [Transfer(onto[0][::-1]), *between, Transfer(off[-1])]
        return _Turned(circles, turned, [(onto[0], off[0]), *ways], whole)

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
            level = self._ways.level(way[-1])
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
        for free in self._ways.levels:
            clear = np.flatnonzero(free.clear(way[1:]))
            if len(clear):
                return np.asarray(way[: clear[-1] + 2])
        return way[:1]

    def _high(self, way: Array) -> Array:
        """A retreat, cut where it leaves the limits, and there where it is still clear."""
        inside = np.append(self._ways.levels[0].inside(way), False)
        if inside[:-1].all():
            return way
        return self._cut(way[: max(1, int(np.argmin(inside)))])

    def _joined(self, off: Array, onto: Array, rounds: int = FEW_ROUNDS) -> Transfer:
        """Along one retreat, freely to the end of another one, and back along that."""
        if len(off) == 1 and len(onto) == 1:
            off = np.concatenate([off, off])  # so that there is a sample without contact
        between = self._ways.between(off[-1], onto[-1], rounds)
        joints = np.concatenate([off[:-1], between.joints, onto[:-1][::-1]])
        gap = None if between.gap is None else len(off) - 1 + between.gap
        return Transfer(joints, gap, between.blocked)

    def _blocked(self, start: Array, end: Array) -> float:
        """What share of the samples of a straight move is not free."""
        key = start.tobytes() + end.tobytes()
        if key not in self._shares:
            self._deadline.check()
            self._shares[key] = self._ways.share(start, end)
        return self._shares[key]

    def _from_home(self, end: Array) -> float:
        """What share of a straight move between home and a configuration is not free."""
        if self.home is None:
            return 0.0
        near = end - self._space.period * self._space.periods(end - self.home)
        return self._blocked(self.home, near)

    def _detour(self, start: Array, end: Array) -> float:
        """How much longer than a straight move the way will probably be, s; 0 if that is free."""
        if start.tobytes() + end.tobytes() in self._hopeless:
            return _HOPELESS
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
