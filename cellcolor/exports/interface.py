"""The input of every export, and the description of an export."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.files.writing import FileKind
from cellcolor.frontend.setup import Controller

if TYPE_CHECKING:
    from cellcolor.frontend.arm.robot import Robot


class NotForThisArm(Exception):
    """No program for this arm in this language; the text says why."""


@dataclass(frozen=True, eq=False)
class PlannedMotion:
    """A motion, and the arm that makes it.

    Attributes:
        trajectory: joint angles over time.
        robot: the arm with its tool; None if unknown, and then no program for a controller can be
            written.
        flange: (4, 4) pose of the link that the tool is mounted on, in the frame of the last joint.
        base: (4, 4) pose in the world of the frame that the controller counts from.
        step_s: fixed time step of the exported samples, s; None keeps those of the trajectory.
        force_n: the force along the tool's axis that the setup asks for, N.
        controller: what the setup says of the arm's controller; None if it names none.
        led: whether the arm does not rest where strokes begin and end.
        part: (4, 4) pose of the part in the world, the work object of programs.
    """

    trajectory: Trajectory
    robot: Robot | None = None
    flange: Array = field(default_factory=lambda: np.eye(4))
    base: Array = field(default_factory=lambda: np.eye(4))
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
