"""What every export is made of, and what an export is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cellcolor.arrays import Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.files.writing import FileKind


@dataclass(frozen=True)
class PlannedMotion:
    """A painted surface, and how an arm covers it.

    Attributes:
        surface: the painted labelled surface.
        segment_of: (n,) the segment of each vertex, -1 where it has no color.
        fills: the color of each segment in pictures, like ``#77AADD``.
        paths: where the tool goes.
        trajectory: how the arm moves.
    """

    surface: LabelledSurface
    segment_of: Index
    fills: tuple[str, ...]
    paths: ToolPaths
    trajectory: Trajectory


@dataclass(frozen=True, slots=True)
class Export:
    """A file that another program reads.

    Attributes:
        kind: how it is distinguished from files of other programs, which are not overwritten.
        content: makes its bytes.
    """

    kind: FileKind
    content: Callable[[PlannedMotion], bytes]
