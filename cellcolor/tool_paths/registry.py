"""Patterns, which lay a path on a part of a segment, by name.

Other distributions register theirs as ``cellcolor.patterns``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from cellcolor.deadline import Deadline
from cellcolor.errors import InputError
from cellcolor.registered import find, load

if TYPE_CHECKING:
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


Pattern = Callable[["Triangles", float, Deadline], Laid]
"""Lays a path on a connected part of a segment, given the wanted spacing between passes in m and a
deadline, which it looks at."""


_GROUP = "cellcolor.patterns"
DEFAULT_PATTERN = "contour"
"""The pattern that is used where none is named."""
PATTERNS = {
    "contour": "cellcolor.tool_paths.contour:lay_contours",
    "back-and-forth": "cellcolor.tool_paths.back_and_forth:lay_back_and_forth",
}
"""This package's own, as ``module:function``."""


def find_pattern(name: str) -> Pattern:
    """The pattern of that name; ``back-and-forth:HOW`` says which way its rows run.

    Raises:
        InputError: no pattern has this name, or two have it; or it cannot be imported.
    """
    name, _, rows = name.partition(":")
    loaded = load(find(name, PATTERNS, _GROUP, "pattern"), "pattern")
    if not callable(loaded):
        raise InputError(None, "pattern", f"{name!r} is not a function")
    if rows and name != "back-and-forth":
        raise InputError(None, "pattern", f"{name} has no rows whose direction could be given")
    if rows:
        from cellcolor.tool_paths.back_and_forth import fields_of

        fields_of(rows)  # refuses what is no direction
        return partial(loaded, rows=rows)
    pattern: Pattern = loaded
    return pattern
