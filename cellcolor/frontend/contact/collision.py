"""Collisions of many configurations at once: of the arm with itself and with a half space.

Shapes are capsules, flat-ended cylinders and solids with flat faces
(:class:`~cellcolor.frontend.arm.body.Body`), given in the world by the ends of their axes.
Capsules are tested in numpy. A cylinder lies between two capsules, one around it and one inside
it; fcl decides only where these two disagree. For a solid, fcl decides where the capsule around it
meets another body and :func:`gap_between` finds no plane between that body and the solid's box.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses, turned
from cellcolor.frontend.arm.polyhedron import Polyhedron
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.fcl_bodies import Placed, bodies_touch, body_poses

_ROUNDING = 1e-6  # m; of boxes around solids
_DEPTH = 0.00065  # m; a tool of 20 mm radius may move by 10 mm, the upper arm by 17


@dataclass(frozen=True)
class HalfSpace:
    """All points p of the world with ``normal @ p`` below an offset.

    Attributes:
        normal: (3,) a unit vector, out of the half space.
        offset_m: of the plane along the normal, from the world's origin, m.
    """

    normal: tuple[float, float, float]
    offset_m: float

    @classmethod
    def through(cls, point: Array, normal: Array) -> HalfSpace:
        """The half space whose plane passes through a point (3,), with a normal of any length."""
        x, y, z = (normal / np.linalg.norm(normal)).tolist()
        return cls((x, y, z), float(np.array([x, y, z]) @ point))

    def along(self, vectors: Array) -> Array:
        """How far points or vectors (..., 3) go along the normal, (...), m."""
        return np.asarray(vectors @ np.array(self.normal))


def body_ends(robot: Robot, poses: Poses) -> Array:
    """Both ends of every body's axis in the world, (bodies, 2, n, 3), m."""
    ends = np.empty((len(robot.bodies), 2, len(poses.tip), 3))
    for index, body in enumerate(robot.bodies):
        rotation, origin = poses.body_rotation[:, body.joint], poses.body_origin[:, body.joint]
        ends[index, 0] = origin + turned(rotation, body.start)
        ends[index, 1] = origin + turned(rotation, body.end)
    return ends


def hits_itself(robot: Robot, ends: Array, poses: Poses | None = None) -> Mask:
    """Whether any tested pair of bodies overlaps, (n,).

    Args:
        ends: of the bodies, see :func:`body_ends`.
        poses: of the joints; robots without solids do not need them.
    """
    hit = np.zeros(ends.shape[2], dtype=bool)
    if not robot.tested_pairs:
        return hit
    bodies, (one, other) = robot.bodies, np.array(robot.tested_pairs).T
    radii = np.array([body.radius for body in bodies])
    reach = radii[one] + radii[other]
    # Bounding spheres first.
    centers = ends.mean(axis=1)
    halves = np.array([body.length for body in bodies]) / 2
    between = (centers[one] - centers[other]).reshape(-1, 3)
    farthest = reach + halves[one] + halves[other]
    pairs, at = np.nonzero(_norm(between).reshape(len(one), -1) <= farthest[:, None])
    axes = (ends[bodies_of[pairs], end, at] for bodies_of in (one, other) for end in (0, 1))
    close = segment_distance(*axes) <= reach[pairs]
    pairs, at = pairs[close], at[close]
    capsules = np.array([not (body.flat or body.solid) for body in bodies])
    decided = (capsules[one] & capsules[other])[pairs]
    hit[at[decided]] = True
    for number in np.unique(pairs[~decided]).tolist():
        i, j = robot.tested_pairs[number]
        first, second = bodies[i], bodies[j]
        rows = at[pairs == number]
        rows = rows[~hit[rows]]
        if first.solid is not None or second.solid is not None:
            assert poses is not None  # callers whose bodies have solids pass them
            rows = rows[gap_between(robot, (i, j), ends, poses, rows) <= _ROUNDING]
            hit[rows] = _overlap(robot, (i, j), ends, poses, rows)
            continue
        (a0, a1, ra), (b0, b1, rb) = (
            _inside(body, ends[k][:, rows]) for k, body in ((i, first), (j, second))
        )
        sure = np.asarray(segment_distance(a0, a1, b0, b1) <= ra + rb)
        hit[rows[sure]] = True
        rest = rows[~sure]
        hit[rest] = _overlap(robot, (i, j), ends, poses, rest)
    return hit


def _overlap(
    robot: Robot, pair: tuple[int, int], ends: Array, poses: Poses | None, rows: NDArray[np.intp]
) -> Mask:
    """Whether two bodies touch in some of the configurations, (rows,), by fcl."""
    chosen = None if poses is None or not robot.has_solids else poses.take(rows)
    first, second = (robot.bodies[index] for index in pair)
    at_first, at_second = (
        body_poses(robot.bodies[index], ends[index][:, rows], chosen) for index in pair
    )
    return bodies_touch(first, at_first, second, at_second)


def hits_ground(
    robot: Robot,
    ends: Array,
    ground: HalfSpace,
    exempt: tuple[str, ...],
    poses: Poses | None = None,
) -> Mask:
    """Whether any body, except those of the exempt links, reaches into the ground, (n,).

    Robots without solids do not need the ``poses`` of the joints.
    """
    hit = np.zeros(ends.shape[2], dtype=bool)
    for body, (start, end) in zip(robot.bodies, ends, strict=True):
        if body.link not in exempt:
            below = np.full(len(start), body.radius)
            if body.flat:
                upright = ground.along(end - start) / body.length
                below *= np.sqrt(np.maximum(1 - upright**2, 0.0))
            lower = np.minimum(ground.along(start), ground.along(end))
            low = lower - below < ground.offset_m
            if body.solid is not None:
                assert poses is not None
                low &= ~hit
                rows = np.flatnonzero(low)
                at = (poses.body_rotation[rows, body.joint], poses.body_origin[rows, body.joint])
                low[rows] = lowest_points(body.solid, at, ground) - body.skin < ground.offset_m
            hit |= low
    return hit


def lowest_points(solid: Polyhedron, placed: Placed, plane: HalfSpace) -> Array:
    """How far the lowest point of a solid is along the normal of a half space, (n,), m."""
    turns, origins = placed
    up = np.asarray(plane.normal) @ turns
    lowest = (up @ solid.outline.T).min(axis=1, initial=np.inf)
    return np.asarray(lowest + plane.along(origins))


def segment_distance(p0: Array, p1: Array, q0: Array, q1: Array) -> Array:
    """Distance (n,) between the segments p0-p1 and q0-q1, each (n, 3); points are allowed.

    After Ericson, Real-Time Collision Detection, 2005, section 5.1.9.
    """
    d1, d2, r = p1 - p0, q1 - q0, p0 - q0
    a, e = _dot(d1, d1), _dot(d2, d2)
    b, c, f = _dot(d1, d2), _dot(d1, r), _dot(d2, r)
    a_safe, e_safe = np.where(a > 0, a, 1.0), np.where(e > 0, e, 1.0)
    denominator = a * e - b * b
    parallel = denominator <= 1e-12 * a * e
    s = np.where(parallel, 0.0, (b * f - c * e) / np.where(parallel, 1.0, denominator))
    s = np.clip(s, 0.0, 1.0)
    t = (b * s + f) / e_safe
    # Where t leaves the second segment, or that is a point, take the best s for the end.
    s = np.where((t < 0) | (e == 0), np.clip(-c / a_safe, 0, 1), s)
    s = np.where(t > 1, np.clip((b - c) / a_safe, 0, 1), s)
    t = np.clip(t, 0.0, 1.0)
    return _norm(r + s[:, None] * d1 - t[:, None] * d2)


def _inside(body: Body, ends: Array) -> tuple[Array, Array, float]:
    """Ends and radius of the largest capsule along the axis that lies inside the body."""
    start, end = ends
    if not body.flat:
        return start, end, body.radius
    radius = min(body.radius, body.length / 2)
    inset = (end - start) * (radius / body.length)
    return start + inset, end - inset, radius


def _dot(a: Array, b: Array) -> Array:
    product: Array = np.einsum("ij,ij->i", a, b)
    return product


def _norm(a: Array) -> Array:
    norms: Array = np.sqrt(_dot(a, a))
    return norms


def longest_steps(radii: Array) -> Array:
    """How far bodies of these radii may move between two tested points of a link, m.

    A ball of radius r that moves by s sweeps a space that its first and last position do not cover
    completely. The gap is r - sqrt(r^2 - s^2 / 4) deep: at most 0.65 mm.
    """
    depth = np.minimum(_DEPTH, radii)
    return np.asarray(2 * np.sqrt(depth * (2 * radii - depth)))


def tracked_points(robot: Robot, ends: Array, poses: Poses) -> Array:
    """Points of all bodies that can move, in the world, (points, n, 3), m.

    No point of a body's axis moves farther than one of its ends, and none of a solid farther than
    a corner of the box around it: its displacement is a mean of theirs.
    """
    points = []
    for body, both in zip(robot.bodies, ends, strict=True):
        if body.joint == 0:
            continue
        if body.solid is None:
            points.append(both)
            continue
        corners = turned(poses.body_rotation[:, body.joint], body.solid.corners.T)
        place = corners.transpose(2, 0, 1) + poses.body_origin[:, body.joint]
        points.append(place)
    return np.concatenate([np.empty((0, *ends.shape[2:])), *points])


def tracked_steps(robot: Robot, margin: float, between: float) -> Array:
    """How far each of the tracked points may move between two tests, (points,), m.

    A solid may have sharp edges. A stationary object reaches into it by at most half a step less
    the margin in which nothing may be: 0.65 mm, as for other bodies (:func:`longest_steps`). For
    two solids that both move it is a whole step less their margin: 1.3 mm.

    Args:
        margin: the smallest margin to stationary objects, m.
        between: the margin between links, m.
    """
    steps: list[float] = []
    for body in robot.bodies:
        if body.joint == 0:
            continue
        if body.solid is None:
            steps += longest_steps(np.array([body.radius])).tolist() * 2
        else:
            steps += [2 * _DEPTH + min(2 * margin, between)] * 8
    return np.array(steps)


def gap_between(
    robot: Robot, pair: tuple[int, int], ends: Array, poses: Poses, rows: NDArray[np.intp]
) -> Array:
    """Lower bounds (rows,) of the distance between two bodies, m; at most 0 where they may touch.

    A solid lies in a box around it. The bound is the widest gap between two bodies along any of
    several lines: between the middles, and along the edges of the boxes (after Gottschalk,
    Lin and Manocha, OBBTree, 1996, who take nine more).

    Args:
        ends: of all bodies' axes, see :func:`~cellcolor.frontend.contact.collision.body_ends`.
        poses: of the joints.
        rows: of the configurations that are tested.
    """
    bodies = [robot.bodies[index] for index in pair]
    sides = [
        _middle_and_edges(robot.bodies[index], ends[index][:, rows], poses, rows) for index in pair
    ]
    between = sides[1][0] - sides[0][0]
    solid = [edges for body, (_, edges) in zip(bodies, sides, strict=True) if body.solid]
    lines = np.concatenate([between[:, None], *solid], axis=1)
    lengths = np.sqrt(np.einsum("nlx,nlx->nl", lines, lines))
    lines /= np.where(lengths > 0, lengths, 1.0)[:, :, None]
    gaps = np.abs(np.einsum("nlx,nx->nl", lines, between))
    for body, (_, edges) in zip(bodies, sides, strict=True):
        along = np.abs(np.einsum("nlx,nkx->nlk", lines, edges))
        gaps -= along.sum(axis=2)
        if body.solid is not None:
            gaps -= body.skin
        elif body.flat:
            upright = 2 * along[:, :, 0] / body.length
            gaps -= body.radius * np.sqrt(np.maximum(1 - upright**2, 0.0))
        else:
            gaps -= body.radius
    return np.asarray(gaps.max(axis=1))


def _middle_and_edges(
    body: Body, ends: Array, poses: Poses, rows: NDArray[np.intp]
) -> tuple[Array, Array]:
    """Middle (n, 3) and halved edges (n, 3 or 1, 3) of a solid's box or another body's axis."""
    if body.solid is None:
        return ends.mean(axis=0), (ends[1:] - ends[:1]).swapaxes(0, 1) / 2
    corners, rotation = body.solid.corners, poses.body_rotation[rows, body.joint]
    middle = turned(rotation, corners.mean(axis=0)) + poses.body_origin[rows, body.joint]
    # The first corner's neighbors along the edges of the box.
    return middle, turned(rotation, (corners[[1, 2, 4]] - corners[0]).T / 2).swapaxes(1, 2)
