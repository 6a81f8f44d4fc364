"""Tool paths: where the tool goes on each segment of a painted surface, without lifting."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcolor.data.value import (
    Document,
    Integers,
    RowsOfThree,
    Value,
    WithArrays,
    check_lengths,
)
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.validation import settle


@dataclass(frozen=True, eq=False, repr=False)
class ToolPath(WithArrays, Value):
    """One path on a labelled surface, from its first point to its last without lifting.

    The step from point i to point i + 1 is straight and lies in the triangle ``faces[i]``.

    Attributes:
        segment: which segment of the painting it covers; several paths may cover one segment.
        color: the segment's.
        points: (k, 3) float64, m.
        normals: (k, 3) float64, outward unit normals of the surface.
        faces: (k - 1,) int64, the triangle that each step lies in.

    Raises:
        InputError: an array has another shape or kind; names the member.
    """

    segment: int
    color: int
    points: RowsOfThree
    normals: RowsOfThree
    faces: Integers

    def __post_init__(self) -> None:
        settle(self)
        if len(self.points) < 2:
            raise InputError(None, "points", "a path needs at least two points")
        check_lengths(self, ("normals",), len(self.points), "points")
        check_lengths(self, ("faces",), len(self.points) - 1, "steps")

    @property
    def length(self) -> float:
        """Of the whole path, m."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def __str__(self) -> str:
        points = count(len(self.points), "point")
        return f"tool path on segment {self.segment}: {self.length:.3f} m, {points}"


@dataclass(frozen=True, eq=False, repr=False)
class ToolPaths(WithArrays, Document):
    """The tool paths of one painting.

    Attributes:
        name: what to call it.
        pattern: how the paths were laid out, such as ``contour``.
        spacing_m: desired distance between neighboring passes, m.
        tool_radius_m: of the tool's footprint, m.
        paths: see :class:`ToolPath`.
        surface_sha256: fingerprint of the labelled surface that they lie on.
    """

    FORMAT = "cellcolor/tool-paths"
    LINES = ("paths",)

    name: str
    pattern: str
    spacing_m: float
    tool_radius_m: float
    paths: tuple[ToolPath, ...]
    surface_sha256: str

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> ToolPaths:
        paths = document.get("paths")
        for number, path in enumerate(paths if isinstance(paths, list) else ()):
            try:
                ToolPath.from_document(path)
            except InputError as error:
                raise InputError(None, f"paths[{number}].{error.field}", error.message) from error
        return super().from_document(document)

    @property
    def length(self) -> float:
        """Of all paths, m."""
        return sum(path.length for path in self.paths)

    def __str__(self) -> str:
        paths = count(len(self.paths), "tool path")
        return f"{self.name}: {paths}, {self.pattern}, {self.length:.2f} m"
