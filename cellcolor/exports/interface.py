"""What every export is made of, and what an export is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.files.writing import FileKind


class NotForThisArm(Exception):
    """No program for this arm in this language; the text says why."""


@dataclass(frozen=True, eq=False)
class ArmAxes:
    """Where an arm's joints turn when all of them are at zero, in the frame of its base.

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
        """Of joints with a fixed pose (joints, 4, 4) in the frame before, and an axis (joints, 3)
        in their own frame.
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
    """A painted surface, and how an arm covers it.

    Attributes:
        surface: the painted labelled surface.
        segment_of: (n,) the segment of each vertex, -1 where it has no color.
        fills: the color of each segment in pictures, like ``#77AADD``.
        paths: where the tool goes.
        trajectory: how the arm moves.
        axes: the arm's; None where it is not known, so that there is no program for a controller.
        step_s: the fixed time step, s; None takes the samples of the trajectory.
        force_n: what the tool is to press with along its axis, N, as the setup has it.
    """

    surface: LabelledSurface
    segment_of: Index
    fills: tuple[str, ...]
    paths: ToolPaths
    trajectory: Trajectory
    axes: ArmAxes | None = None
    step_s: float | None = None
    force_n: float = 0.0


@dataclass(frozen=True, slots=True)
class Export:
    """A file that another program reads.

    Attributes:
        kind: how it is distinguished from files of other programs, which are not overwritten.
        content: makes its bytes; raises :class:`NotForThisArm` where there is no such file.
    """

    kind: FileKind
    content: Callable[[PlannedMotion], bytes]
