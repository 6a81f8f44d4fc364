"""The input of every export, and the description of an export."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.files.writing import FileKind


class NotForThisArm(Exception):
    """No program for this arm in this language; the text says why."""


@dataclass(frozen=True, eq=False)
class ArmAxes:
    """An arm's joint axes with all joints at zero, in the frame of its base.

    Attributes:
        names: of the joints, base first.
        points: (joints, 3) a point on each axis, m.
        directions: (joints, 3) unit vectors; a joint turns about it by the right-hand rule.
        slides: whether some joint is prismatic.
    """

    names: tuple[str, ...]
    points: Array
    directions: Array
    slides: bool = False

    @classmethod
    def of(
        cls, names: tuple[str, ...], placement: Array, axis: Array, slides: bool = False
    ) -> ArmAxes:
        """The axes of a chain of joints.

        Args:
            names: of the joints, base first.
            placement: (joints, 4, 4) pose of each joint in the frame of the joint before it.
            axis: (joints, 3) each joint's axis in its own frame.
            slides: whether some joint is prismatic.
        """
        frames, frame = [], np.eye(4)
        for pose in placement:
            frame = frame @ pose
            frames.append(frame)
        at_zero = np.array(frames)
        return cls(
            names, at_zero[:, :3, 3], np.einsum("nij,nj->ni", at_zero[:, :3, :3], axis), slides
        )


@dataclass(frozen=True)
class PlannedMotion:
    """A painted surface and the motion that covers it.

    Attributes:
        surface: the painted labelled surface.
        segment_of: (n,) the segment of each vertex, -1 where it has no color.
        fills: the color of each segment in pictures, like ``#77AADD``.
        paths: the tool paths.
        trajectory: joint angles over time.
        axes: of the arm; None if unknown, and then no program for a controller can be written.
        step_s: fixed time step of the exported samples, s; None keeps those of the trajectory.
        force_n: the force along the tool's axis that the setup asks for, N.
    """

    surface: LabelledSurface
    segment_of: Index
    fills: tuple[str, ...]
    paths: ToolPaths
    trajectory: Trajectory
    axes: ArmAxes | None = None
    step_s: float | None = None
    force_n: float = 0.0

    @property
    def colors(self) -> NDArray[np.uint8]:
        """(n, 4) red, green, blue and opacity of each vertex; light grey without a color."""
        fills = [bytes.fromhex(fill[1:] + "FF") for fill in (*self.fills, "#DDDDDD")]
        return np.array([list(fill) for fill in fills], dtype=np.uint8)[self.segment_of]


@dataclass(frozen=True, slots=True)
class Export:
    """A file that another program reads.

    Attributes:
        kind: recognizes files written by cellcolor; only these are overwritten.
        content: makes the bytes; raises :class:`NotForThisArm` if it has no program for the arm.
    """

    kind: FileKind
    content: Callable[[PlannedMotion], bytes]
