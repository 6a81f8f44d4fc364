"""What a pattern is: it lays a path on a part of a segment."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cellcolor.deadline import Deadline
from cellcolor.tool_paths.triangles import Triangles


@dataclass(frozen=True, eq=False)
class Laid:
    """A path on a mesh.

    Attributes:
        mesh: a mesh made by cutting the triangles of the one that was to be covered.
        walk: its vertices along the path, each the neighbor of the one before, none on the mesh's
            border; empty if the part is too narrow for the pattern.
    """

    mesh: Triangles
    walk: list[int]


Pattern = Callable[[Triangles, float, Deadline], Laid]
"""Lays a path on a connected part of a segment, given the wanted spacing between passes in m and a
deadline, which it looks at."""
