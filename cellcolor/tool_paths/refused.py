"""A region without the places that a tool must not touch, found as finely as paths are laid.

A test says of points whether the tool may be there. Where it refuses one corner of a triangle and
not another, the triangle is halved until its sides are short. So what is left out is hardly more
than what the test refuses, however coarse the surface's mesh is.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask
from cellcolor.data.trajectory import LeftOut
from cellcolor.mesh.dividing import with_longest_sides
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.tool_paths.region import kept_parts
from cellcolor.tool_paths.triangles import Triangles, split_at

Codes = NDArray[np.uint8]
"""Why points are refused, as places in a list of reasons; 0 where they are not."""


class Refusals(Protocol):
    """Where the tool must not touch a segment.

    Attributes:
        names: of the codes.
        doubtful: triangles of the surface in which something is known to be refused.
    """

    names: tuple[str, ...]
    doubtful: set[int]

    def __call__(self, points: Array, normals: Array) -> Codes:
        """Why points (k, 3) of the segment, with unit normals (k, 3), are refused, (k,)."""
        ...

    def tested(self, point: Array, normal: Array) -> Array:
        """The place (3,) of the test that refuses a point: the point itself, or one beside it."""
        ...


def without_refused(
    mesh: Triangles, segment: int, refusals: Refusals, finest: float, least_area: float
) -> tuple[list[Triangles], list[LeftOut]]:
    """The parts of a mesh that are left, largest first, and what is left out.

    A place of what is left out is one where the test has failed, far from all that is not refused.

    Args:
        mesh: a connected part of the segment.
        finest: sides are halved until none is longer, where it matters, m.
        least_area: parts that are smaller count as refused like what is around them, m².
    """
    codes = refusals(mesh.points, mesh.normals)
    doubtful = np.fromiter(refusals.doubtful, dtype=np.int64)
    while True:
        bad = (codes > 0)[mesh.corners]
        halved = (bad.any(axis=1) & ~bad.all(axis=1)) | np.isin(mesh.faces, doubtful)
        split = np.zeros(len(mesh.edges), dtype=bool)
        split[mesh.edge_of_side[halved].ravel()] = True
        split &= mesh.lengths > finest
        if not split.any():
            break
        # With the longest side of each triangle cut as well, even needles get shorter.
        split = with_longest_sides(mesh, split)
        count = len(mesh.points)
        mesh, _ = split_at(mesh, split, 0.5)
        new = refusals(mesh.points[count:], mesh.normals[count:])
        codes = np.concatenate([codes, new])
    kept: Mask = ~np.any(bad, axis=1)
    if kept.all():
        return [mesh], []
    parts = kept_parts(mesh, kept)
    why = np.where(kept, 0, codes[mesh.corners].max(axis=1))
    around = np.zeros(len(codes), dtype=np.uint8)
    np.maximum.at(around, mesh.corners.ravel(), np.repeat(why, 3))
    large = []
    for members, part in parts:
        area = float(part.areas.sum())
        code = around[mesh.corners[members]].max()
        if area < least_area and code:
            why[members] = code
        else:
            large.append((area, part))
    large.sort(key=lambda one: -one[0])
    return [part for _, part in large], _places(mesh, segment, why, codes, refusals)


def _places(
    mesh: Triangles, segment: int, why: Codes, codes: Codes, refusals: Refusals
) -> list[LeftOut]:
    """Triangles (m,) that are left out, those that meet and have the same reason as one place."""
    out = np.flatnonzero(why)
    # Triangles are joined over what they share: a corner, for one reason.
    keys = mesh.corners[out] * len(refusals.names) + why[out][:, None]
    shared = np.unique(keys, return_inverse=True)[1].reshape(-1, 3)
    pairs = np.column_stack([np.repeat(np.arange(len(out)), 3), len(out) + shared.ravel()])
    place_of = grouped(len(out) + int(shared.max(initial=-1)) + 1, pairs)[: len(out)]
    deep = _depths(mesh, codes)
    found = []
    for number in np.unique(place_of).tolist():
        members = out[place_of == number]
        corners = np.unique(mesh.corners[members])
        deepest = corners[np.argmax(deep[corners])]
        place = refusals.tested(mesh.points[deepest], mesh.normals[deepest])
        area, reason = float(mesh.areas[members].sum()), refusals.names[why[members[0]]]
        found.append(LeftOut(segment, area, reason, tuple(place.tolist())))
    return found


def _depths(mesh: Triangles, codes: Codes) -> Array:
    """How far each refused point (n,) is from one that is not, m; 0 for the others."""
    deep = np.where(codes > 0, np.inf, 0.0)
    if (codes == 0).any():
        deep[codes > 0] = cKDTree(mesh.points[codes == 0]).query(mesh.points[codes > 0])[0]
    return deep
