"""The arm with its tool as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import Body, MeshBody


@dataclass(frozen=True)
class TaskSpace:
    """Rows and columns of the task's Jacobian.

    Attributes:
        joints: how many joints answer, counted from the base; those after them move nothing that is
            asked for.
        turn: whether the turn of the tool about its axis is asked for, one row in rad.
        lengths: how many rows are lengths: 3 for the tip's position, 2 where the tip moves in a
            plane across the tool.
        direction: whether the tool's direction is asked for, two rows in rad. Otherwise it is what
            it is.
    """

    joints: int
    turn: bool
    lengths: int = 3
    direction: bool = True

    @property
    def dimensions(self) -> int:
        """How many rows there are."""
        return self.lengths + 2 * self.direction + self.turn

    @property
    def most_joints(self) -> int:
        """How many an arm may have: one more may turn the tool about its axis, and is locked."""
        return self.joints + 1 if self.direction and not self.turn else self.joints

    @property
    def plane(self) -> bool:
        """Whether the tip moves in a plane across the tool."""
        return self.lengths == 2


FREE_TURN = TaskSpace(joints=5, turn=False)
"""The tool's turn is free: a sixth joint turns it about its own axis and is locked."""

GIVEN_TURN = TaskSpace(joints=6, turn=True)
"""The tool's whole pose is asked for."""

POSITION = TaskSpace(joints=3, turn=False, direction=False)
"""Where the tip is, and nothing else."""

POSITION_AND_TURN = TaskSpace(joints=4, turn=True, direction=False)
"""Where the tip is, and how the tool is turned about its own axis, whose direction is fixed."""

FREE_IN_PLANE = TaskSpace(joints=2, turn=False, lengths=2, direction=False)
"""Where the tip is in a plane, and nothing else."""

GIVEN_IN_PLANE = TaskSpace(joints=3, turn=True, lengths=2, direction=False)
"""The same, and the tool's turn."""


@dataclass(frozen=True)
class Robot:
    """Joints in a row, a tool, and what collides. The world frame is the root link.

    Attributes:
        placement: (joints, 4, 4) fixed pose of each joint frame in the one before it.
        axis: (joints, 3) unit axis of each joint in its own frame.
        slides: (joints,) which joints are prismatic; the others turn.
        lower, upper: (joints,) joint limits in rad, infinite for continuous joints; in m of
            prismatic ones.
        velocity: (joints,) limits in rad/s or m/s, NaN where the file has none.
        effort: (joints,) limits of torques in N m or forces in N, NaN where the file has none.
        mass: (joints,) mass that each joint's frame carries, in kg; fixed links and tool included.
        center: (joints, 3) its center of mass in that frame, m.
        tip: (4, 4) pose of the tool tip in the frame of the last joint; the tool works along +z.
        bodies: collision shapes, base first.
        tested_pairs: pairs of bodies (indices) that self-collision looks at: all that do not
            belong to one link or to links next to each other.
        warnings: what its files have that is probably not meant, a sentence each.
        model: Pinocchio's, with a frame for each link.
        tool_links: the links of the tool that have a body.
        task: what it is asked to do with the tool; ``load_robot`` leaves the turn free.
    """

    files: tuple[Path, Path]
    placement: Array
    axis: Array
    slides: Mask
    lower: Array
    upper: Array
    velocity: Array
    effort: Array
    mass: Array
    center: Array
    tip: Array
    bodies: tuple[Body, ...]
    tested_pairs: tuple[tuple[int, int], ...]
    joint_names: tuple[str, ...]
    warnings: tuple[str, ...]
    model: pin.Model = field(repr=False, compare=False)
    task: TaskSpace = FREE_TURN
    tool_links: frozenset[str] = frozenset()

    @property
    def joints(self) -> int:
        """How many there are between base and tip."""
        return len(self.axis)

    @property
    def turning(self) -> Index:
        """The joints that are not prismatic."""
        return np.flatnonzero(~self.slides)

    def frame_of(self, link: str) -> Array:
        """(4, 4) pose of a link in the frame of the joint that moves it.

        Raises:
            KeyError: there is no such link.
        """
        if not self.model.existFrame(link, pin.FrameType.BODY):
            raise KeyError(link)
        frame = self.model.frames[self.model.getFrameId(link, pin.FrameType.BODY)]
        return np.array(frame.placement.homogeneous)

    def base_frame(self, link: str | None) -> Array:
        """(4, 4) pose in the world of a link that no joint moves.

        Args:
            link: None for ``base`` if there is such a link (REP 199), else what the first joint is
                on.

        Raises:
            KeyError: no link of this name stands still.
        """
        standing = [
            frame.name
            for frame in self.model.frames
            if frame.type == pin.FrameType.BODY and frame.parentJoint == 0
        ]
        if link is None:
            joint = self.model.frames[
                self.model.getFrameId(self.joint_names[0], pin.FrameType.JOINT)
            ]
            link = "base" if "base" in standing else self.model.frames[joint.parentFrame].name
        elif link not in standing:
            raise KeyError(link)
        return self.frame_of(link)

    def refused(self, joint: int, message: str) -> InputError:
        """An error that names a joint and the arm's file."""
        return InputError(str(self.files[0]), f"joint[{self.joint_names[joint]}]", message)

    @property
    def stand_ins(self) -> tuple[MeshBody, ...]:
        """The bodies that collide in the place of a link's mesh."""
        return tuple(body for body in self.bodies if isinstance(body, MeshBody))

    @property
    def has_solids(self) -> bool:
        """Whether bodies with flat faces are among the collision shapes."""
        return any(body.solid is not None for body in self.bodies)
