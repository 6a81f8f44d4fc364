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
    adapter_of,
    integers,
    rows_of_three,
)
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.documents import dump_lines, take_body, validate
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
        object.__setattr__(self, "points", rows_of_three(self.points, "points"))
        object.__setattr__(self, "normals", rows_of_three(self.normals, "normals"))
        object.__setattr__(self, "faces", integers(self.faces, "faces"))
        if len(self.points) < 2:
            raise InputError(None, "points", "a path needs at least two points")
        if len(self.normals) != len(self.points):
            message = f"has {len(self.normals)} entries for {len(self.points)} points"
            raise InputError(None, "normals", message)
        if len(self.faces) != len(self.points) - 1:
            message = f"has {len(self.faces)} entries for {len(self.points) - 1} steps"
            raise InputError(None, "faces", message)

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

    name: str
    pattern: str
    spacing_m: float
    tool_radius_m: float
    paths: tuple[ToolPath, ...]
    surface_sha256: str

    @property
    def length(self) -> float:
        """Of all paths, m."""
        return sum(path.length for path in self.paths)

    def __str__(self) -> str:
        paths = count(len(self.paths), "tool path")
        return f"{self.name}: {paths}, {self.pattern}, {self.length:.2f} m"

    def to_json(self) -> str:
        """The file's text."""
        paths = [
            {
                "segment": path.segment,
                "color": path.color,
                "points": path.points.tolist(),
                "normals": path.normals.tolist(),
                "faces": path.faces.tolist(),
            }
            for path in self.paths
        ]
        document: dict[str, Any] = {
            "format": self.FORMAT,
            "version": 1,
            "name": self.name,
            "pattern": self.pattern,
            "spacing_m": self.spacing_m,
            "tool_radius_m": self.tool_radius_m,
            "surface_sha256": self.surface_sha256,
            "paths": paths,
        }
        return dump_lines(document, frozenset({"paths"}))

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> ToolPaths:
        raw = validate(adapter_of(_ToolPathsFile), take_body(document, cls.FORMAT))
        paths = []
        for number, path in enumerate(raw.paths):
            try:
                members = (path.segment, path.color, path.points, path.normals, path.faces)
                paths.append(ToolPath(*members))
            except InputError as error:
                raise InputError(None, f"paths[{number}].{error.field}", error.message) from error
        return cls(
            raw.name,
            raw.pattern,
            raw.spacing_m,
            raw.tool_radius_m,
            tuple(paths),
            raw.surface_sha256,
        )


@dataclass(frozen=True, slots=True)
class _PathInFile(Value):
    """A path's members, before they become arrays."""

    segment: int
    color: int
    points: list[tuple[float, float, float]]
    normals: list[tuple[float, float, float]]
    faces: list[int]


@dataclass(frozen=True, slots=True)
class _ToolPathsFile(Value):
    """The file's members, before they become arrays."""

    name: str
    pattern: str
    spacing_m: float
    tool_radius_m: float
    paths: list[_PathInFile]
    surface_sha256: str
