"""Names of solutions by signs: shoulder, elbow and wrist (``docs/frontend.md``).

Where axes 2 and 3 are parallel, and either axes 4, 5 and 6 meet (a spherical wrist) or axis 4 is
parallel to these as well and axes 5 and 6 meet, the determinant of the task is a product of three
factors, as adding columns of the Jacobian to one another shows:

- shoulder: how fast the wrist's center moves along axis 2 when joint 1 turns;
- elbow: the area that joints 2 and 3 span with the center of the wrist (with joint 4, if its axis
  is parallel), twice the triangle's;
- wrist: the volume of the unit vectors along axes 4, 5 and 6.

Each is continuous, so along a motion without singularity none changes its sign. And a pose has at
most one solution for each choice of signs: joint 1 has to bring the wrist's center to a given
height along axis 2, joints 2 and 3 to a given place in the plane across it, and joint 5 axis 6 to a
given angle with axis 4. Each of the three has at most two solutions, one with either sign of its
factor.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.inverse import pose_at_zero
from cellcolor.frontend.arm.kinematics import (
    Poses,
    forward,
    nearest_points,
    signed_task_determinant,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.memory import chunks

BRANCHES = tuple(
    f"shoulder-{shoulder} elbow-{elbow} wrist-{wrist}"
    for shoulder in ("front", "back")
    for elbow in ("up", "down")
    for wrist in ("unflipped", "flipped")
)
"""Branch names; the index has the shoulder in bit 2, the elbow in bit 1, the wrist in bit 0.

Shoulder front: the wrist's center is on that side of axis 1 to which a positive angle of joint 2
leads an upright arm. Elbow up: above the line from the shoulder to the wrist's center, as seen with
the center in front of joint 2, or behind it for shoulder back. Wrist unflipped: the tool has turned
from the direction in which axis 4 leads outwards by a positive angle of joint 5, below 180 degrees.
"""


@dataclass(frozen=True)
class Signs:
    """What the three factors of an arm are computed from.

    Attributes:
        elbow: (3,) a point of axis 3 in the frame behind joint 3, m.
        shoulder: (3,) a point of axis 2 in the frame behind joint 2, m.
        center: (3,) where axes 5 and 6 meet, in the frame behind joint 6, m.
        end: frame and point (3,) up to where the forearm counts: the wrist's center, or a point of
            axis 4 if that is parallel to axes 2 and 3.
        upwards: 1, or -1 if axis 1 points down at its zero.
        outwards: 1, or -1 if axis 4 points from the wrist's center to the elbow.
        reach: to make the factors comparable, m.
        parity: sign of the task determinant over the product of the factors' signs.
        numbers: (8,) the number of each branch in ``BRANCHES`` among the names of the family.
    """

    elbow: Array
    shoulder: Array
    center: Array
    end: tuple[int, Array]
    upwards: float
    outwards: float
    reach: float
    parity: float
    numbers: Index = field(default_factory=lambda: np.arange(len(BRANCHES)))

    def factors(self, poses: Poses) -> Array:
        """The three factors (k, 3) without unit: shoulder, elbow, wrist; positive for branch 0."""
        axes = poses.axis.transpose(1, 0, 2)
        first, second, fourth, fifth = self.upwards * axes[0], axes[1], axes[3], axes[4]
        center = _at(poses, 6, self.center)
        lever = _dot(np.cross(second, first), center - poses.origin[:, 1]) / self.reach
        shoulder = _at(poses, 2, self.shoulder)
        upper, whole = _at(poses, 3, self.elbow) - shoulder, _at(poses, *self.end) - shoulder
        area = _dot(second, np.cross(upper, whole)) / self.reach**2
        flip = self.outwards * _dot(fifth, np.cross(fourth, poses.tool_axis))
        # Above the line to a wrist in front is on the other side of it than above one behind.
        return np.stack([lever, area * np.where(lever >= 0, 1.0, -1.0), flip], axis=1)

    def branches(self, robot: Robot, configurations: Array) -> tuple[NDArray[np.intp], Array]:
        """The branch and the task determinant, (k,) each, of configurations (k, joints) in rad.

        The branch is a number, the determinant absolute, in m^3.

        For a calibrated arm, next to a singularity, a factor can have the wrong sign, since axes
        that nearly meet have a center only nearly. Then the product of the signs is not that of the
        task determinant, and the factor nearest to zero is the wrong one.
        """
        found = np.empty(len(configurations), dtype=np.intp)
        determinants = np.empty(len(configurations))
        for rows in chunks(len(found)):
            poses = forward(robot, configurations[rows])
            factors = self.factors(poses)
            negative = factors < 0
            # The product of the plain factors: the second one has the sign of the first in it.
            product = np.where(negative[:, 1] ^ negative[:, 2], -1.0, 1.0)
            determinant = signed_task_determinant(poses)
            wrong = np.flatnonzero(product * determinant * self.parity < 0)
            nearest = np.argmin(np.abs(factors[wrong]), axis=1)
            negative[wrong, nearest] ^= True
            # A shoulder that changes its sign takes the elbow's with it, whose own factor stays.
            negative[wrong[nearest == 0], 1] ^= True
            found[rows] = self.numbers[negative @ np.array([4, 2, 1])]
            determinants[rows] = np.abs(determinant)
        return found, determinants


def signs_of(robot: Robot, reach: float, tolerance: float) -> Signs | None:
    """What names the solutions of an arm of six joints; None if its determinant has no factors.

    Args:
        reach: of the arm, m.
        tolerance: what axes that are parallel or meet may be off by, rad and m.
    """
    poses = pose_at_zero(robot)
    axes, origins = poses.axis[0], poses.origin[0, 1:]

    def parallel(i: int, j: int) -> bool:
        return float(np.linalg.norm(np.cross(axes[i], axes[j]))) <= tolerance

    def meeting(i: int, j: int) -> Array | None:
        here, there = nearest_points(origins[i], axes[i], origins[j], axes[j])
        apart = float(np.linalg.norm(here - there)) > tolerance
        return None if parallel(i, j) or apart else here

    center, inner = meeting(5, 4), meeting(3, 4)
    if not parallel(1, 2) or parallel(0, 1) or center is None:
        return None
    shoulder = nearest_points(origins[1], axes[1], origins[0], axes[0])[0]
    elbow = origins[2] + ((shoulder - origins[2]) @ axes[2]) * axes[2]
    if parallel(2, 3):
        end, frame = origins[3] + ((elbow - origins[3]) @ axes[3]) * axes[3], 4
    elif inner is not None and np.linalg.norm(inner - center) <= tolerance:
        end, frame = center, 6
    else:
        return None
    leads = float((center - elbow) @ axes[3])
    signs = Signs(
        elbow=_within(poses, 3, elbow),
        shoulder=_within(poses, 2, shoulder),
        center=_within(poses, 6, center),
        end=(frame, _within(poses, frame, end)),
        upwards=-1.0 if axes[0, 2] < 0 else 1.0,
        outwards=-1.0 if leads < -tolerance else 1.0,
        reach=reach,
        parity=1.0,
    )
    return Signs(**(vars(signs) | {"parity": _parity(robot, signs)}))


def _parity(robot: Robot, signs: Signs) -> float:
    """The same for all configurations; asked where the factors are far from zero."""
    poses = forward(robot, np.random.default_rng(0).uniform(-np.pi, np.pi, (200, robot.joints)))
    factors = signs.factors(poses)
    clear = int(np.argmax(np.abs(factors).min(axis=1)))
    determinant = signed_task_determinant(poses)
    return float(np.sign(determinant[clear] * factors[clear, 1] * factors[clear, 2]))


def _at(poses: Poses, frame: int, point: Array) -> Array:
    """A point (3,) of a frame in the world, (k, 3)."""
    return np.asarray(poses.origin[:, frame] + poses.rotation[:, frame] @ point)


def _within(poses: Poses, frame: int, point: Array) -> Array:
    """A point (3,) of the world in a frame, in the one configuration of some poses."""
    return np.asarray(poses.rotation[0, frame].T @ (point - poses.origin[0, frame]))


def _dot(first: Array, second: Array) -> Array:
    return np.asarray(np.einsum("...i,...i->...", first, second))
