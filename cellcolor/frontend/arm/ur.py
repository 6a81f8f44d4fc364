"""The family of UR-type arms: geometry and closed-form inverse kinematics, all branches at once.

A UR-type arm has three parallel axes (2, 3, 4) across the first, and axes 4-5 and 5-6 that meet
at right angles. With the tool on the axis of joint 6, tip position and tool direction leave that
joint free, and up to eight solutions of the other five: shoulder x elbow x wrist
(Hawkins, Analytic inverse kinematics for the Universal Robots UR-5/UR-10 arms, 2013).

The axes of a calibrated arm are a little off those that the closed form stands on. From the
solutions of the ideal arm Newton's method leads to those of the true one, which keep their names
(:mod:`cellcolor.frontend.arm.calibrated`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.calibrated import CALIBRATION, Axes, NearIdeal, idealized
from cellcolor.frontend.arm.inverse import SixRevolute, pose_at_zero
from cellcolor.frontend.arm.kinematics import angle_about, forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import signs_of
from cellcolor.frontend.setup import RobotFiles

BRANCHES = tuple(
    f"shoulder-{shoulder} elbow-{elbow} wrist-{wrist}"
    for shoulder in ("left", "right")
    for elbow in ("up", "down")
    for wrist in ("unflipped", "flipped")
)
"""Branch names; the index has the shoulder in bit 2, the elbow in bit 1, the wrist in bit 0.

Shoulder left: the upper arm passes to the left of the base as seen when looking out to the wrist.
Elbow up: with the upper arm horizontal and the wrist out in front, the forearm hangs below it.
Wrist unflipped and flipped: canonical angle of joint 5 positive and negative.
"""

_TOLERANCE = 1e-6  # m and rad; a calibrated arm's deviations are far larger
_ROUNDING = 1e-12  # how far a cosine may exceed 1 and still count as 1


@dataclass(frozen=True)
class UrGeometry:
    """Denavit-Hartenberg constants of a UR-type arm in canonical form.

    The canonical form has a2, a3 < 0 and d4, d5, reach > 0, whatever the URDF's own frames.

    Attributes:
        a2, a3: lengths of upper arm and forearm, negative as in the manufacturer's table, m.
        d4, d5: offsets of the wrist, m.
        reach: from the crossing of axes 5 and 6 to the tool tip (d6 plus tool), m.
        shoulder: (3,) crossing of axes 1 and 2 in the world, m.
        frame: (3, 3) columns x0, y0, z1 of the canonical base in the world.
        sign, offset: (5,) canonical angle = sign * q + offset.
    """

    a2: float
    a3: float
    d4: float
    d5: float
    reach: float
    shoulder: Array
    frame: Array
    sign: Array
    offset: Array


def ur_geometry(robot: Robot, tolerance: float = _TOLERANCE) -> UrGeometry:
    """Derive the constants from the joint axes at zero.

    Args:
        tolerance: what axes that are parallel, at right angles or meet may be off by, m and rad.

    Raises:
        InputError: the arm is not UR-type; names the joint.
    """
    poses = pose_at_zero(robot)
    w, p = poses.axis[0], poses.origin[0, 1:]
    if tolerance > _TOLERANCE:
        p = idealized(Axes(w, p), tolerance).points

    def refuse(joint: int, message: str) -> InputError:
        return robot.refused(joint, f"not a UR-type arm: {message}")

    for joint, other in ((2, 1), (3, 1)):
        if float(np.linalg.norm(np.cross(w[joint], w[other]))) > tolerance:
            raise refuse(joint, f"its axis is not parallel to that of joint {other + 1}")
    for joint, other in ((1, 0), (4, 3), (5, 4)):
        if abs(float(w[joint] @ w[other])) > tolerance:
            raise refuse(joint, f"its axis is not at right angles to that of joint {other + 1}")
        if abs(float((p[joint] - p[other]) @ np.cross(w[joint], w[other]))) > tolerance:
            raise refuse(joint, f"its axis does not meet that of joint {other + 1}")

    # Where axes meet at right angles, or the common normal of two meets the first.
    shoulder, wrist, knuckle = (p[i] + ((p[j] - p[i]) @ w[i]) * w[i] for i, j in _MEETING)
    z1 = -w[0] if w[0, 2] < 0 else w[0]  # up in the world, so that the names mean the same
    z2 = w[1] * np.sign((wrist - shoulder) @ w[1])
    z5 = w[4] * np.sign((knuckle - wrist) @ w[4])
    z6 = poses.tool_axis[0]
    upper_arm = _across(p[2] - shoulder, z2)
    forearm = _across(p[3] - p[2], z2)
    lengths = {
        "a2": -float(np.linalg.norm(upper_arm)),
        "a3": -float(np.linalg.norm(forearm)),
        "d4": float((wrist - shoulder) @ z2),
        "d5": float((knuckle - wrist) @ z5),
        "reach": float((poses.tip[0] - knuckle) @ z6),
    }
    for joint, (name, length) in zip((2, 3, 3, 4, 5), lengths.items(), strict=True):
        if abs(length) < _TOLERANCE:
            raise refuse(joint, f"the link length {name} is zero")
    if lengths["reach"] < 0:
        raise refuse(5, "the tool's z axis points back into the wrist")

    x1 = np.cross(z1, z2)
    axes = np.array([z1, z2, z2, z2, z5])
    x = [
        x1,  # the canonical base takes its x axis from the arm at zero
        x1,
        upper_arm / lengths["a2"],
        forearm / lengths["a3"],
        np.cross(z2, z5),
        np.cross(z6, z5),
    ]
    offset = [float(angle_about(axes[i], x[i], x[i + 1])) for i in range(5)]
    return UrGeometry(
        **lengths,
        shoulder=shoulder,
        frame=np.column_stack([x1, np.cross(z1, x1), z1]),
        sign=np.einsum("ij,ij->i", axes, w[:5]).round(),
        offset=np.array(offset),
    )


_MEETING = ((0, 1), (3, 4), (4, 5))


def _across(vector: Array, axis: Array) -> Array:
    return vector - (vector @ axis) * axis


def solve_inverse(
    geometry: UrGeometry,
    points: Array,
    directions: Array,
    locked_angle: float,
    branches: NDArray[np.intp] | None = None,
    slack: float = 0.0,
) -> Array:
    """All configurations that put the tip on a point with the tool along a direction.

    Args:
        points: (n, 3) tip positions in the world, m.
        directions: (n, 3) unit vectors from the flange to the tip.
        locked_angle: the angle of joint 6 in rad, which the task leaves free.
        branches: (n,) the only one wanted of each point; all without it.
        slack: by how much a cosine may exceed 1 and still count as 1, where solutions of an arm
            next to this one are looked for.

    Returns:
        (n, 8, 6), or (n, 1, 6) with ``branches``: angles in (-pi, pi], NaN where a branch has no
        solution. At an aligned wrist, where a whole circle of solutions exists, one of them (the
        task determinant is zero there).
    """
    g = geometry
    # Signs of the branches' choices, (n or 1, 2 or 1 shoulders, the same of elbows and wrists).
    if branches is None:
        both = np.array([1.0, -1.0])
        left, unflipped = both[None, :, None, None], both[None, None, None, :]
        elbow_up = both[None, None, :, None]
    else:
        left, elbow_up, unflipped = (
            _wide(1.0 - 2.0 * ((branches >> bit) & 1).astype(np.float64)) for bit in (2, 1, 0)
        )
    target = (points - g.shoulder) @ g.frame
    tool = directions @ g.frame
    knuckle = target - g.reach * tool  # crossing of axes 5 and 6

    # Joint 1: the wrist plane keeps the distance d4 from the base axis.
    distance = np.hypot(knuckle[:, 0], knuckle[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = _arccos(g.d4 / distance, slack)
    heading = np.arctan2(knuckle[:, 1], knuckle[:, 0]) + np.pi / 2
    t1 = _wide(heading) + _wide(spread) * left

    c1, s1 = np.cos(t1), np.sin(t1)
    along = c1 * _wide(tool[:, 0]) + s1 * _wide(tool[:, 1])
    aside = s1 * _wide(tool[:, 0]) - c1 * _wide(tool[:, 1])
    up = _wide(tool[:, 2])

    # Joint 5, wrist unflipped or flipped; then the direction of the wrist in the arm's plane.
    t5 = _arccos(aside, slack) * unflipped
    side = np.where(t5 >= 0, 1.0, -1.0)
    total = np.arctan2(-up * side, -along * side)  # joints 2 + 3 + 4

    # Joints 2 and 3: a planar arm of two links.
    px = c1 * _wide(knuckle[:, 0]) + s1 * _wide(knuckle[:, 1]) - g.d5 * np.sin(total)
    py = _wide(knuckle[:, 2]) + g.d5 * np.cos(total)
    bend = _arccos((px**2 + py**2 - g.a2**2 - g.a3**2) / (2 * g.a2 * g.a3), slack)
    # Elbow up is a left turn for the left shoulder, which reaches out along -x1, and a right
    # turn for the right one.
    t3 = bend * (left * elbow_up)
    t2 = np.arctan2(py, px) - np.arctan2(g.a3 * np.sin(t3), g.a2 + g.a3 * np.cos(t3))
    t4 = total - t2 - t3

    canonical = np.stack(np.broadcast_arrays(t1, t2, t3, t4, t5), axis=-1)
    canonical = canonical.reshape(len(points), 8 if branches is None else 1, 5)
    five = np.pi - np.mod(np.pi - (canonical - g.offset) * g.sign, 2 * np.pi)  # (-pi, pi]
    five[np.isnan(five).any(axis=2)] = np.nan
    sixth = np.where(np.isnan(five[:, :, :1]), np.nan, locked_angle)
    return np.concatenate([five, sixth], axis=2)


def _wide(values: Array) -> Array:
    return values[:, None, None, None]


def _arccos(cosine: Array, slack: float) -> Array:
    """arccos with NaN out of reach; what exceeds 1 by rounding and slack counts as 1."""
    near = np.abs(cosine) <= 1.0 + _ROUNDING + slack
    return np.arccos(np.where(near, np.clip(cosine, -1.0, 1.0), np.nan))


_SLACK = 0.05  # how much a cosine may exceed 1 where the ideal arm just fails to reach


class UrKinematics(SixRevolute):
    """UR-type arms."""

    branches = BRANCHES

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The constants of the arm, or of the ideal one that its axes are a little off."""
        super().__init__(robot, files, "not a UR-type arm")
        axes, ideal = Axes(self._poses.axis[0], self._poses.origin[0, 1:]), None
        try:
            self.geometry = ur_geometry(robot)
        except InputError:
            # A refusal with the larger tolerance is the one to be seen.
            self.geometry = ur_geometry(robot, CALIBRATION)
            ideal = idealized(axes, CALIBRATION)
        shown = ideal or axes
        self._set_sizes(files, shown.directions, shown.points)
        self._near = None if ideal is None else self._near_ideal(ideal.off(axes))

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        if self._near is None:
            return solve_inverse(self.geometry, points, directions, self._locked, branches)
        return self._near.solve(points, directions, branches)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        return () if self._near is None else self._near.remarks(points, directions)

    def _near_ideal(self, off: tuple[float, float]) -> NearIdeal:
        """How an arm is solved whose axes are a little off those of the ideal one, rad and m.

        Which of ``BRANCHES`` the signs stand for is asked of the ideal arm's solutions for the pose
        among many that is farthest from any change of sign: there the true arm's factors have the
        same signs.
        """
        signs = signs_of(self._robot, self.reach, 2 * CALIBRATION)
        assert signs is not None  # a UR-type arm has them
        tries = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6))
        poses = forward(self._robot, tries)
        found = solve_inverse(self.geometry, poses.tip, poses.tool_axis, 0.0)
        found = found[~np.isnan(found).any(axis=(1, 2))]
        factors = signs.factors(forward(self._robot, found.reshape(-1, 6)))
        clearest = np.argmax(np.abs(factors).reshape(len(found), -1).min(axis=1))
        own = signs.branches(self._robot, found[clearest])[0]
        signs = replace(signs, numbers=np.argsort(own))
        solve = partial(solve_inverse, self.geometry, locked_angle=self._locked, slack=_SLACK)
        return NearIdeal(robot=self._robot, closed_form=solve, signs=signs, off=off)
