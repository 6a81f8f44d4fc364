"""How large a build may get, asked before memory is spent on it.

Each check raises an :class:`~cellcolor.errors.InputError` that names the key and the numbers. A
build keeps some kilobytes for each vertex. The limits are chosen so that 4 GiB are enough; units
read wrongly and spacings far too fine are the usual ways past them.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.errors import InputError

MOST_VERTICES = 250_000
_MOST_POINTS = 20_000_000  # on all mesh edges; each is tested for up to eight branches
_MOST_ON_AN_EDGE = 500_000  # they are tested together
_MOST_AROUND = 200_000_000  # faces around vertices; some microseconds each


def check_vertices(count: int, field: str | None = None) -> None:
    """Refuse a mesh with too many vertices."""
    if count > MOST_VERTICES:
        raise InputError(None, field, f"has {count:,} vertices, at most {MOST_VERTICES:,} fit")


def check_turns(vertices: int, turns: int) -> None:
    """Refuse more turns of the tool than fit into memory with this many vertices."""
    if vertices * turns > MOST_VERTICES:
        message = f"{turns} turns on {vertices:,} vertices are more than {MOST_VERTICES:,} together"
        raise InputError(None, "task.turn", message)


def check_faces(count: int) -> None:
    """Refuse a mesh with more faces than one with as many vertices as fit can have.

    It has two for each vertex, and a few more if it has handles.
    """
    if count > 3 * MOST_VERTICES:
        raise InputError(
            None, "faces", f"there are {count:,}, at most {MOST_VERTICES:,} vertices fit"
        )


def check_refinement(vertices: int, lengths: Array, area: float, longest: float) -> None:
    """Refuse to halve edges where that would give too many vertices.

    An edge is cut into as many parts as fit at least. A triangle has no more area than the
    equilateral one on its longest side, and there are about two triangles for each vertex.

    Args:
        vertices: of the mesh as it is.
        lengths: (k,) of its edges.
        area: of its faces.
        longest: what no edge may exceed, in the unit of the lengths.
    """
    on_edges = vertices + float(np.ceil(lengths / longest - 1).sum())
    on_faces = area / (np.sqrt(3) / 4 * longest**2) / 2
    needed = max(on_edges, on_faces)
    if needed > MOST_VERTICES:
        raise InputError(
            None,
            "max_edge_m",
            f"needs about {needed:.2g} vertices or more, at most {MOST_VERTICES:,} fit: "
            "is it too small, or meters_per_unit too large?",
        )


def check_points(lengths: Array, spacing: float, field: str) -> None:
    """Refuse to test too many points on mesh edges.

    Args:
        lengths: (k,) of the edges, m.
        spacing: between points, m.
        field: the key that says so.
    """
    counts = np.ceil(lengths / spacing)
    total = float(counts.sum())
    if total > _MOST_POINTS or counts.max() > _MOST_ON_AN_EDGE:
        raise InputError(
            None,
            field,
            f"puts {total:.2g} points on the mesh's edges, {counts.max():.2g} on the longest; "
            f"at most {_MOST_POINTS:,} and {_MOST_ON_AN_EDGE:,} are tested",
        )


def check_rounding(vertices: int, faces: float) -> None:
    """Refuse to round normals over a radius that holds too many triangles."""
    if vertices * faces > _MOST_AROUND:
        raise InputError(
            None,
            "task.edge_radius_m",
            f"holds about {faces:,.0f} triangles, for each of {vertices:,} vertices; at most "
            f"{_MOST_AROUND:,} are looked at: a smaller radius, or larger triangles",
        )
