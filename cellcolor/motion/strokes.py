"""Strokes: continuous motions in contact, as long as possible without lifting."""

from __future__ import annotations

from bisect import bisect
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.following import Followed, Samples

_SAME = 1e-9  # m; ends of a path that are nearer are one point


@dataclass(frozen=True)
class Parting:
    """Why a stroke is separate from another one of its segment.

    Attributes:
        reason: as of :class:`~cellcolor.data.trajectory.ExtraLiftOff`.
        text: in a sentence.
        place: (3,) where, m.
    """

    reason: str
    text: str
    place: Array


@dataclass(frozen=True)
class Stroke:
    """Samples in contact, one after the other.

    Attributes:
        segment: of the painting.
        branch: of the arm.
        points, normals: (k, 3) as of the samples.
        joints: (k, joints) rad or m, unwound; whole turns of all of them together are chosen
            later.
        parting: why it is separate from an earlier stroke of its segment; None for the first.
        leads: (m, joints) before its first sample and after its last one, without contact, in the
            order in which they are driven; None for a stroke without leads.
    """

    segment: int
    branch: int
    points: Array
    normals: Array
    joints: Array
    parting: Parting | None = None
    leads: tuple[Array, Array] | None = None

    @property
    def whole(self) -> Array:
        """(k, joints) with both leads."""
        before, after = self.leads or (self.joints[:0], self.joints[:0])
        return np.concatenate([before, self.joints, after])

    def __len__(self) -> int:
        return len(self.points)

    @property
    def length(self) -> float:
        """Of the way in contact, m."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def is_closed(self, space: JointSpace) -> bool:
        """Whether it ends where it begins, in the same configuration but for whole turns."""
        apart = float(np.linalg.norm(self.points[0] - self.points[-1]))
        off = self.joints[-1] - self.joints[0]
        turned = np.abs(off - space.period * space.periods(off)).max()
        return apart < _SAME and bool(turned < _SAME / 1e-3)

    def _taken(self, rows: slice | Index) -> Stroke:
        points, normals, joints = self.points[rows], self.normals[rows], self.joints[rows]
        return replace(self, points=points, normals=normals, joints=joints)

    def part(self, first: int, end: int) -> Stroke:
        """The samples from the first one to the one before the end."""
        return self._taken(slice(first, end))

    def reversed(self) -> Stroke:
        """The same stroke in reverse."""
        return self._taken(slice(None, None, -1))

    def followed_by(self, rows: slice) -> Stroke:
        """The stroke, and then some of its samples once more."""
        own = np.arange(len(self))
        return self._taken(np.concatenate([own, own[rows]]))

    def begun_at(self, sample: int, space: JointSpace) -> Stroke:
        """A closed stroke that begins and ends at another of its samples."""
        if sample == 0:
            return self
        # What is passed after the old end goes on from there, by whole turns farther if it winds.
        wound = space.period * space.periods(self.joints[-1] - self.joints[0])
        begun = self._taken(np.r_[sample : len(self), 1 : sample + 1])
        begun.joints[len(self) - sample :] += wound
        return begun

    def turned(self, turns: Index, space: JointSpace) -> Stroke:
        """The stroke with every joint (joints,) turned by a number of periods."""
        off = space.period * turns
        leads = None if self.leads is None else (self.leads[0] + off, self.leads[1] + off)
        return replace(self, joints=self.joints + off, leads=leads)


def trimmed(
    segment: int,
    branch: int,
    samples: Samples,
    followed: Followed,
    shortest: float,
    names: tuple[str, ...],
    space: JointSpace,
) -> list[Stroke]:
    """The pieces of a path whose samples are all valid and continuous.

    Args:
        shortest: shorter pieces are left out, m.
    """
    good = followed.reasons == VALID
    if not good.any():
        return []
    # A new stretch begins at a good sample that is the first, or after a bad one or a tear.
    begins = good & np.insert(~good[:-1] | followed.torn, 0, True)
    ends = good & np.append(~good[1:] | followed.torn, True)
    found: list[Stroke] = []
    for first, last in zip(np.flatnonzero(begins), np.flatnonzero(ends), strict=True):
        rows = slice(int(first), int(last) + 1)
        joints = space.unwrap(followed.joints[rows])
        points, normals = samples.points[rows], samples.normals[rows]
        stroke = Stroke(segment, branch, points, normals, joints)
        if len(points) < 2 or (stroke.length < shortest and len(points) < len(samples)):
            continue
        if found:
            at = int(first) - 1
            cause = (
                "the branch jumps" if good[at] else f"samples fail: {names[followed.reasons[at]]}"
            )
            text = f"the path was cut where {cause}"
            stroke = replace(stroke, parting=Parting("trimmed", text, samples.points[at]))
        found.append(stroke)
    return found


def cut_where_full(stroke: Stroke, space: JointSpace, joint_names: tuple[str, ...]) -> list[Stroke]:
    """Parts of a stroke that each fit into the joint limits; the stroke itself if it does.

    Each goes as far as it can. Between two parts the tool is lifted off, and joints come back by
    whole turns.
    """
    parts: list[Stroke] = []
    first = 0
    while first < len(stroke) - 1:
        counts = range(1, len(stroke) - first + 1)
        fitting = bisect(counts, 0, key=lambda n: not space.fits(stroke.joints[first : first + n]))
        part = stroke.part(first, first + max(fitting, 1))
        if parts:
            part = replace(part, parting=_full(stroke, parts[-1], first, space, joint_names))
        parts.append(part)
        first += len(part) - 1
        if len(part) < 2:  # not even one step fits, which the tests of samples leave no room for
            break
    return parts


def _full(
    stroke: Stroke, before: Stroke, sample: int, space: JointSpace, names: tuple[str, ...]
) -> Parting:
    """Why a stroke was cut at a sample that the part before it still has."""
    joints = np.concatenate([before.joints, stroke.joints[sample : sample + 2]])
    joint = next((number for number, own in enumerate(space.turns(joints)) if not len(own)), 0)
    text = f"{names[joint]} would run out of its limits"
    return Parting("winding", text, stroke.points[sample])
