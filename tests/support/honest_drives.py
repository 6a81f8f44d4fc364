"""Drives that are judged valid, and what they stay honest under.

An honest drive is a trajectory that is judged valid and goes round in two strokes or more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index
from cellcolor.data.trajectory import Trajectory
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene

Random = np.random.Generator
# What docs/judging-trajectories.md lets a drive miss, by how many spacings from a pass, and a tenth
# more, since it is measured at random points.
_MISSED = ((1.5, 0.011), (0.75, 0.033))
_POINTS = 20_000
_ARRAYS = ("times", "joints", "points", "normals", "contact", "segment")


@dataclass(frozen=True)
class Honest:
    """A drive without fault, with its scene and the proved minimum of lift-offs."""

    prepared: PreparedScene
    trajectory: Trajectory
    minimum: int

    def posed(self, joints: Array, **changes: Any) -> Trajectory:
        """The drive with other joints, and the points and normals that belong to them."""
        poses = forward(self.prepared.robot, joints)
        return replace(
            self.trajectory, joints=joints, points=poses.tip, normals=-poses.tool_axis, **changes
        )

    def reached(self, points: Array, normals: Array, near: Array) -> Array:
        """Joints (k, joints) that put the tool on points, those nearest to given ones."""
        found = self.prepared.arm.inverse(points, -normals)
        found = found + 2 * np.pi * np.round((near[:, None] - found) / (2 * np.pi))
        off = np.abs(found - near[:, None]).max(axis=2)
        best = np.argmin(np.where(np.isnan(off), np.inf, off), axis=1)
        return np.asarray(found[np.arange(len(found)), best])

    def stroke(self, random: Random) -> tuple[int, int]:
        """One of the strokes that are longer than 200 samples."""
        long = [(a, b) for a, b in self.trajectory.strokes if b - a > 200]
        return long[int(random.integers(len(long)))]

    def inside(self, random: Random, length: int) -> Index:
        """Neighboring samples in the middle of a stroke."""
        first, after = self.stroke(random)
        begin = int(random.integers(first + 30, after - length - 30))
        return np.arange(begin, begin + length)

    @cached_property
    def covered(self) -> Array:
        """Random points (n, 3) of the surface that are closely covered, as many for equal areas."""
        surface, random = self.prepared.surface, np.random.default_rng(0)
        corners = surface.vertices[surface.faces]
        sides = np.diff(corners, axis=1)
        areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        drawn = corners[random.choice(len(areas), _POINTS, p=areas / areas.sum())]
        weights = random.dirichlet(np.ones(3), _POINTS)
        points = (drawn * weights[:, :, None]).sum(axis=1)
        return np.asarray(points[self.away(self.trajectory, points) <= _MISSED[1][0]])

    def away(self, trajectory: Trajectory, points: Array) -> Array:
        """How far points are from the passes as the crow flies, in spacings.

        The way along the surface, which the judge measures, is no shorter.
        """
        motion = self.prepared.setup.motion
        assert motion is not None
        tips = []
        for first, after in trajectory.strokes:
            at = np.asarray(trajectory.points[first:after])
            length = np.insert(np.cumsum(np.linalg.norm(np.diff(at, axis=0), axis=1)), 0, 0.0)
            along = np.arange(0.0, length[-1] + 0.001, 0.001)
            tips.append(np.stack([np.interp(along, length, column) for column in at.T], axis=1))
        return np.asarray(cKDTree(np.concatenate(tips)).query(points)[0]) / motion.spacing_m

    def misses(self, trajectory: Trajectory) -> bool:
        """Whether a drive leaves out more than one may."""
        away = self.away(trajectory, self.covered)
        return any(float((away > far).mean()) > most for far, most in _MISSED)


def rows_of(trajectory: Trajectory, rows: Index, **changes: Any) -> Trajectory:
    """Some samples in a new order, with what is stated of samples moved along or dropped."""
    new = {int(old): number for number, old in enumerate(rows)}
    taken = {name: getattr(trajectory, name)[rows] for name in _ARRAYS}
    taken |= {
        "unplanned": tuple(new[k] for k in trajectory.unplanned if k in new),
        "extra_lift_offs": tuple(
            replace(e, sample=new[e.sample]) for e in trajectory.extra_lift_offs if e.sample in new
        ),
        "repeated": tuple(
            replace(r, sample=new[r.sample], last_sample=new[r.last_sample])
            for r in trajectory.repeated
            if r.sample in new and r.last_sample in new
        ),
    }
    return replace(trajectory, **(taken | changes))


def dropped_stroke(honest: Honest, number: int) -> Trajectory:
    """One stroke taken out, and the arm brought slowly from before it to after it."""
    first, after = honest.trajectory.strokes[number]
    rows = np.arange(len(honest.trajectory.times))
    rows = np.concatenate([rows[:first], rows[after:]])
    times = honest.trajectory.times[rows].copy()
    step = np.abs(np.diff(honest.trajectory.joints[rows], axis=0)).max(axis=1)
    times[first:] += 10 * step[first - 1] if 0 < first < len(rows) else 0.0
    return rows_of(honest.trajectory, rows, times=times)


def resampled(trajectory: Trajectory, most: float) -> Trajectory:
    """Samples put in between, in proportion to time, until no step lasts longer than ``most``."""
    pieces = np.maximum(np.ceil(np.diff(trajectory.times) / most), 1).astype(int)
    begins = np.concatenate([[0], np.cumsum(pieces)])
    times = np.empty(begins[-1] + 1)
    sample = np.repeat(np.arange(len(pieces)), pieces)
    way = (np.arange(len(sample)) - begins[sample]) / pieces[sample]
    times[:-1] = trajectory.times[sample] + way * pieces[sample] * (
        np.diff(trajectory.times)[sample] / pieces[sample]
    )
    times[-1] = trajectory.times[-1]

    def between(of: Array) -> Array:
        return np.stack([np.interp(times, trajectory.times, column) for column in of.T], axis=1)

    contact = np.append(
        np.where(
            way > 0,
            trajectory.contact[sample] & trajectory.contact[sample + 1],
            trajectory.contact[sample],
        ),
        trajectory.contact[-1],
    )
    segment = np.append(trajectory.segment[sample], trajectory.segment[-1])
    normals = between(trajectory.normals)
    return replace(
        trajectory,
        times=times,
        joints=between(trajectory.joints),
        points=between(trajectory.points),
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        contact=contact,
        segment=np.where(contact, segment, -1),
        unplanned=tuple(int(begins[k]) for k in trajectory.unplanned),
        extra_lift_offs=tuple(
            replace(e, sample=int(begins[e.sample])) for e in trajectory.extra_lift_offs
        ),
        repeated=tuple(
            replace(r, sample=int(begins[r.sample]), last_sample=int(begins[r.last_sample]))
            for r in trajectory.repeated
        ),
    )


# What an honest drive stays honest under.
HONEST: dict[str, Callable[[Honest], Trajectory]] = {
    "as it is": lambda honest: honest.trajectory,
    "half as fast": lambda honest: replace(
        honest.trajectory, times=2 * np.asarray(honest.trajectory.times)
    ),
    "later": lambda honest: replace(
        honest.trajectory, times=np.asarray(honest.trajectory.times) + 1000.0
    ),
    "six decimals": lambda honest: replace(
        honest.trajectory,
        times=np.round(honest.trajectory.times, 9),
        joints=np.round(honest.trajectory.joints, 6),
    ),
}
