"""The input of every export, and the description of an export."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.files.writing import FileKind
from cellcolor.frontend.setup import Controller

if TYPE_CHECKING:
    from cellcolor.frontend.arm.robot import Robot


class NotForThisArm(Exception):
    """No program for this arm in this language; the text says why."""


@dataclass(frozen=True, eq=False)
class ArmAxes:
    """An arm's joint axes with all joints at zero, in the frame of its base.

    Attributes:
        names: of the joints, base first.
        points: (joints, 3) a point on each axis, m.
        directions: (joints, 3) unit vectors; a joint turns about it by the right-hand rule.
        flange, tip: (4, 4) poses of the flange link and of the tool's tip.
        base: (4, 4) pose of the frame that the controller counts from.
        speeds: (joints,) the URDF's limits, rad/s, NaN where it has none.
        slides: whether some joint is prismatic.
    """

    names: tuple[str, ...]
    points: Array
    directions: Array
    flange: Array
    tip: Array
    base: Array
    speeds: Array
    slides: bool = False

    @classmethod
    def of(cls, robot: Robot, flange_link: str, base_link: str | None = None) -> ArmAxes:
        """The axes of an arm.

        Args:
            robot: the arm with its tool.
            flange_link: that the tool is mounted on.
            base_link: the frame of the controller; without one it is ``base`` if there is such a
                link (REP 199), else the link that carries the first joint.

        Raises:
            KeyError: there is no such link before the first joint.
        """
        frames, frame = [], np.eye(4)
        for pose in robot.placement:
            frame = frame @ pose
            frames.append(frame)
        at_zero = np.array(frames)
        return cls(
            robot.joint_names,
            at_zero[:, :3, 3],
            np.einsum("nij,nj->ni", at_zero[:, :3, :3], robot.axis),
            frame @ robot.frame_of(flange_link),
            frame @ robot.tip,
            robot.base_frame(base_link),
            robot.velocity,
            bool(robot.slides.any()),
        )

    def tips(self, joints: Array) -> Array:
        """(k, 4, 4) poses of the tool's tip with the joints (k, joints), rad, of an arm that turns.

        Axis by axis: how all behind it has turned and moved since the joints were at zero.
        """
        turn, shift = Rotation.identity(len(joints)), np.zeros((len(joints), 3))
        for point, direction, angles in zip(self.points, self.directions, joints.T, strict=True):
            own = turn * Rotation.from_rotvec(angles[:, None] * direction)
            shift = turn.apply(point) + shift - own.apply(point)
            turn = own
        found = np.tile(self.tip, (len(joints), 1, 1))
        found[:, :3] = turn.as_matrix() @ self.tip[:3]
        found[:, :3, 3] += shift
        return found


@dataclass(frozen=True, eq=False)
class PlannedMotion:
    """A motion, and the arm that makes it.

    Attributes:
        trajectory: joint angles over time.
        axes: of the arm; None if unknown, and then no program for a controller can be written.
        step_s: fixed time step of the exported samples, s; None keeps those of the trajectory.
        force_n: the force along the tool's axis that the setup asks for, N.
        controller: what the setup says of the arm's controller; None if it names none.
        led: whether the arm does not rest where strokes begin and end.
        part: (4, 4) pose of the part in the world, the work object of programs.
    """

    trajectory: Trajectory
    axes: ArmAxes | None = None
    step_s: float | None = None
    force_n: float = 0.0
    controller: Controller | None = None
    led: bool = False
    part: Array = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True, slots=True)
class Export:
    """A file that another program reads.

    Attributes:
        kind: recognizes files written by cellcolor; only these are overwritten.
        content: makes the bytes; raises :class:`NotForThisArm` if there is none for the arm.
    """

    kind: FileKind
    content: Callable[[PlannedMotion], bytes]
