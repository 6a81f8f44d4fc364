"""From one stroke to the next: off the surface, through free space, and back to the surface."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.contact.engine import Contacts, poses_along
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import DISTANCE
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.limits import home_of
from cellcolor.motion.order import Visit, chosen_turns
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.ways import FEW, MANY, Transfer, Ways

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
_ALONG = 0.003  # m of the end of a stroke, which say where its lead goes
_ROOM = 0.999  # of the largest steps, for rounding
_LEAVING = 0.0025  # m; for so long the tip of a tool that leaves may be near; the judge has 3 mm
_UP = np.array([0.0, 0.0, 1.0])  # however the ball at the tip is turned
_TIP = Body("tool tip", 1, np.zeros(3), np.zeros(3), 0.0011, False)  # as near; the judge has 1 mm
_DIGITS = 9  # of joints in rad or m, by which moves are told apart


@dataclass(frozen=True)
class _Reachable:
    """A stroke that begins and ends where the arm can leave it, as far as it can anywhere.

    Attributes:
        onto: (k, joints) the retreat from the first sample, which is driven backwards.
        off: (k, joints) the retreat from the last sample.
    """

    stroke: Stroke
    onto: Array
    off: Array


@dataclass(frozen=True)
class _Attempt:
    """Strokes turned by full circles, and the moves without contact before, between and after them.

    Attributes:
        circles: of each stroke, the full circles (joints,) that it is turned by.
        retreats: of each move, those (k, joints) that it begins and ends with.
    """

    circles: Sequence[Index]
    strokes: list[Stroke]
    retreats: list[tuple[Array, Array]]
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
        """``velocities`` (joints,) in rad/s or m/s; ``seed`` is that of drawn configurations.

        Raises:
            InputError: the home position is not free.
        """
        self._prepared, self._deadline = prepared, deadline
        self._motion, self._velocities = motion, velocities
        self._leaving = FreeSpace(prepared, 0.0, leaving=True)
        self._at_object = Contacts([(_TIP, prepared.target, 0.0)])
        self.home = home_of(prepared, motion)
        # The retreat at home has no length; without a home there is nothing to move from.
        self._at_home = np.empty((0, prepared.robot.joints))
        if self.home is not None:
            self._at_home = self.home[None]
        self._ways = Ways(prepared, motion, velocities, self.home, seed, deadline)
        self._space = self._ways.space
        # By both ends (`_key`): what share of a straight move is blocked; moves without a way.
        self._shares: dict[bytes, float] = {}
        self._hopeless: set[bytes] = set()

    def between_strokes(self, strokes: Sequence[Stroke]) -> tuple[list[Stroke], list[Transfer]]:
        """The strokes with their ends and turns chosen, and all motions without contact.

        These are the way to the first stroke, those between strokes, and the way from the last
        one. Without a home position the first begins, and the last ends, where the tool is
        retracted. Turns are chosen again while some move has no way: others may be as quick. The
        moves that are left then are planned once more with more effort.
        """
        reachable = [self._led(self._reachable(stroke)) for stroke in strokes]
        visits = [self._visit(one) for one in reachable]
        tried: list[_Attempt] = []
        for _ in range(_ATTEMPTS):
            circles = chosen_turns(visits, self.home, self._space, self._velocities, self._detour)
            if any(np.array_equal(circles, before.circles) for before in tried):
                break
            tried.append(self._attempt(reachable, circles))
            if not tried[-1].gaps:
                break
            shifts = [self._space.period * own for own in circles]
            begins = [one.start + shift for one, shift in zip(visits, shifts, strict=True)]
            ends = [one.end + shift for one, shift in zip(visits, shifts, strict=True)]
            begins, ends = [*begins, self._at_home.ravel()], [self._at_home.ravel(), *ends]
            self._hopeless |= {self._key(ends[gap], begins[gap]) for gap in tried[-1].gaps}
        best = min(tried, key=lambda one: len(one.gaps))
        transfers = list(best.transfers)
        for gap in best.gaps:
            drawn = max(FEW, MANY // len(best.gaps))
            transfers[gap] = self._joined(*best.retreats[gap], drawn)
        return best.strokes, transfers

    def _visit(self, one: _Reachable) -> Visit:
        """What has to fit into the limits: the retreats too, if full circles can bring them in."""
        span = np.concatenate([one.onto, one.stroke.whole, one.off])
        if not self._space.fits(span):
            span = one.stroke.whole
        return Visit(one.onto[-1], one.off[-1], span)

    def _attempt(self, reachable: Sequence[_Reachable], circles: Sequence[Index]) -> _Attempt:
        """The strokes turned by these full circles, and the moves between them."""
        strokes, onto, off = [], [], []
        for one, own in zip(reachable, circles, strict=True):
            strokes.append(one.stroke.turned(own, self._space))
            onto.append(self._within_limits(one.onto + self._space.period * own))
            off.append(self._within_limits(one.off + self._space.period * own))
        ends = zip([*onto, *off], [*strokes, *strokes], strict=True)
        self._ways.pass_near([(way[-1], stroke.branch) for way, stroke in ends])
        retreats = list(zip([self._at_home, *off], [*onto, self._at_home], strict=True))
        return _Attempt(circles, strokes, retreats, [self._joined(*pair) for pair in retreats])

    def _reachable(self, stroke: Stroke) -> _Reachable:
        """A stroke that begins and ends where the arm can leave it, with both retreats.

        A closed one begins where a straight joint move leads home as well, if it does anywhere, so
        that there is a way to every other stroke. An open one loses a little at the end, or goes
        back over itself as far as to a place that the arm can leave; if there is none, it stays as
        it is.
        """
        if stroke.is_closed(self._space) and (begun := self._begun_elsewhere(stroke)) is not None:
            stroke, onto = begun
            wound = self._space.period * self._space.periods(stroke.joints[-1] - onto[0])
            return _Reachable(stroke, onto, onto + wound)
        onto = self._retreat_at(stroke, 0)
        if len(onto) == 1:
            stroke, onto = self._ended_elsewhere(stroke.reversed())
            stroke = stroke.reversed()
        off = self._retreat_at(stroke, -1)
        if len(off) == 1:
            stroke, off = self._ended_elsewhere(stroke)
        return _Reachable(stroke, onto, off)

    def _led(self, one: _Reachable) -> _Reachable:
        """The same with leads straight on from both ends, as far as the arm is free there.

        An end where it cannot retreat from its lead has none.
        """
        length, stroke = self._motion.lead_m, one.stroke
        if not length or len(stroke) < 2:
            return one
        ways, retreats = [], []
        for at, retreat in ((0, one.onto), (-1, one.off)):
            points = stroke.points if at else stroke.points[::-1]
            far = np.linalg.norm(points - points[-1], axis=1) > _ALONG
            normal, before = stroke.normals[at], int(np.argmax(np.append(far[::-1], True)))
            along = points[-1] - points[max(len(points) - 1 - before, 0)]
            along = unit(along - (along @ normal) * normal)
            way, fine = self._followed(stroke.joints[at], normal, along, stroke.branch, length)
            way = way[: int(np.argmin(fine)) + 1]
            off = self._retreat(way[-1], normal, stroke.branch)
            if len(off) == 1:
                way, off = way[:1], retreat
            # Both are counted on from the same end of the stroke.
            ways.append(way[1:])
            retreats.append(off)
        led = replace(stroke, leads=(ways[0][::-1], ways[1]))
        return _Reachable(led, retreats[0], retreats[1])

    def _begun_elsewhere(self, stroke: Stroke) -> tuple[Stroke, Array] | None:
        """A closed stroke begun where the arm can leave it, and the retreat; None if nowhere.

        Of such places the nearest one from which a straight joint move leads home, else the one
        from which most of that move is free.
        """
        apart = np.linspace(0, len(stroke) - 1, _STARTS, endpoint=False).astype(int)
        found: list[tuple[float, Stroke, Array]] = []
        for at in sorted(set(apart.tolist()), key=lambda at: min(at, len(stroke) - at)):
            begun = stroke.begun_at(at, self._space)
            onto = self._retreat_at(begun, 0)
            if len(onto) > 1:
                found.append((self._blocked_from_home(onto[-1]), begun, onto))
                if not found[-1][0]:
                    break
        return min(found, key=lambda one: one[0])[1:] if found else None

    def _ended_elsewhere(self, stroke: Stroke) -> tuple[Stroke, Array]:
        """An open stroke that ends where the arm can leave it, and the retreat from there.

        It is shortened by as little as will do, or goes back over itself. If nothing helps, it
        stays as it is, and the retreat is its last configuration alone.
        """
        spacing = self._motion.spacing_m
        steps = np.linalg.norm(np.diff(stroke.points[::-1], axis=0), axis=1)
        back = np.concatenate([[0.0], np.cumsum(steps)])  # from the end on
        most = max(_RETRACED[0] * spacing, _RETRACED[1] * back[-1])
        for far in np.arange(0.25, most / spacing, 0.5) * spacing:
            if far >= back[-1]:
                break
            self._deadline.check()
            at = len(stroke) - 1 - int(np.searchsorted(back, far))
            off = self._retreat_at(stroke, at)
            if len(off) == 1 or at < 1:
                continue
            if far <= _TRIMMED * spacing:
                return stroke.part(0, at + 1), off
            again = slice(len(stroke) - 2, at - 1 if at else None, -1)
            return stroke.followed_by(again), off
        return stroke, stroke.joints[-1:]

    def _retreat_at(self, stroke: Stroke, at: int) -> Array:
        """The retreat from a sample of a stroke."""
        return self._retreat(stroke.joints[at], stroke.normals[at], stroke.branch)

    def _retreat(self, joints: Array, normal: Array, branch: int) -> Array:
        """Off the surface from a configuration (joints,), at most as high as the setup says.

        It leads along the normal if the arm keeps its whole clearance at the end, otherwise in the
        direction where it keeps most of it there. The tool's direction and the branch stay the
        same. If there is no way off, the retreat is the contact alone.

        Returns:
            (k, joints) from the contact on, unwound.
        """
        found = []
        for direction in _directions(normal):
            way = self._off(joints, normal, direction, branch)
            if len(way) == 1:
                continue
            level = self._ways.level(way[-1])
            if level == 0:
                return way
            found.append((level, -len(way), way))
        return min(found, key=lambda one: one[:2])[2] if found else joints[None]

    def _off(self, joints: Array, normal: Array, direction: Array, branch: int) -> Array:
        """The retreat (k, joints) in one direction, as far as the arm can follow it."""
        way, fine = self._followed(joints, normal, direction, branch, self._motion.retract_m)
        tips = forward(self._prepared.robot, way[1:]).tip
        fine[:-1] &= ~self._drags(tips)
        return self._cut(way[: int(np.argmin(fine)) + 1])

    def _followed(
        self, joints: Array, normal: Array, direction: Array, branch: int, height: float
    ) -> tuple[Array, Mask]:
        """A straight way (k, joints) of the tip, and which of its steps (k,) are fine.

        The tool's direction and the branch stay the same. The last step leads nowhere.
        """
        tip = forward(self._prepared.robot, joints[None]).tip[0]
        count = int(np.ceil(height / (DISTANCE * _ROOM)))
        points = tip + np.linspace(0.0, height, count + 1)[1:, None] * direction
        axes, branches = np.tile(-normal, (count, 1)), np.full(count, branch, dtype=np.intp)
        found = self._prepared.arm.follow(points, axes, branches)
        solved = ~np.isnan(found[:, 0])
        found = found[: count if solved.all() else int(np.argmin(solved))]
        way = joints + self._space.unwrap(np.concatenate([joints[None], found]) - joints)
        steady = self._space.largest(np.diff(way, axis=0)) <= _FASTER
        return way, np.append(steady & self._leaving.clear(way[1:]), False)

    def _drags(self, tips: Array) -> Mask:
        """Whether the tip (k, 3) is at the object again, or still, after it has left the contact.

        A tilted retreat may lead along a hollow.
        """
        left = np.flatnonzero(DISTANCE * _ROOM * np.arange(1, len(tips) + 1) > _LEAVING)
        drags = np.zeros(len(tips), dtype=bool)
        drags[left] = self._at_object(poses_along(tips[left], np.tile(_UP, (len(left), 1))))
        return drags

    def _cut(self, way: Array) -> Array:
        """A retreat up to its last place with the whole clearance, or else with the most of it."""
        for free in self._ways.levels:
            clear = np.flatnonzero(free.clear(way[1:]))
            if len(clear):
                return np.asarray(way[: clear[-1] + 2])
        return way[:1]

    def _within_limits(self, way: Array) -> Array:
        """A retreat, cut before it leaves the limits, at the last place that is clear there."""
        inside = np.append(self._ways.levels[0].inside(way), False)
        if inside[:-1].all():
            return way
        return self._cut(way[: max(1, int(np.argmin(inside)))])

    def _joined(self, off: Array, onto: Array, drawn: int = FEW) -> Transfer:
        """Along one retreat, freely to the end of another one, and back along that.

        Of the first and the last move without a home only the one retreat.
        """
        if not len(off) or not len(onto):
            return Transfer(np.concatenate([off, onto[::-1]]))
        if len(off) == 1 and len(onto) == 1:
            off = np.concatenate([off, off])  # so that there is a sample without contact
        between = self._ways.between(off[-1], onto[-1], drawn)
        joints = np.concatenate([off[:-1], between.joints, onto[:-1][::-1]])
        gap = None if between.gap is None else len(off) - 1 + between.gap
        return Transfer(joints, gap, between.blocked)

    def _key(self, start: Array, end: Array) -> bytes:
        """Of a move; of two that are full circles apart as a whole it is the same."""
        circles = self._space.period * self._space.periods(start)
        return np.round(np.concatenate([start - circles, end - circles]), _DIGITS).tobytes()

    def _blocked(self, start: Array, end: Array) -> float:
        """What share of the samples of a straight move is not free, computed once."""
        key = self._key(start, end)
        if key not in self._shares:
            self._deadline.check()
            self._shares[key] = self._ways.share(start, end)
        return self._shares[key]

    def _blocked_from_home(self, end: Array) -> float:
        """What share of a straight move between home and a configuration is not free."""
        if self.home is None:
            return 0.0
        near = end - self._space.period * self._space.periods(end - self.home)
        return self._blocked(self.home, near)

    def _detour(self, start: Array, end: Array) -> float:
        """How much longer than a straight move the way will probably take, s; 0 if that is free."""
        if self._key(start, end) in self._hopeless:
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
