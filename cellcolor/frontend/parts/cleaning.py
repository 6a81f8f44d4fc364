"""Simple faults mended: vertices in one place, faces there twice or without area, the winding.

Faces are made to wind alike, and outward where that can be known.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped

__all__ = [
    "against_the_others",
    "flat_faces",
    "inside_out",
    "merged",
    "repeated_corners",
    "repeated_faces",
    "turned",
    "used",
    "without_flat",
]

_SAME = 1e-8  # of the mesh's size; vertices so near to each other are in one place
_FLAT = 1e-6  # of the longest side's square; a doubled area that counts as none
_PASSES = 30


def merged(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Of vertices in one place, within 1e-8 of the mesh's size, the first for all of them."""
    size = float(np.ptp(vertices, axis=0).max(initial=0.0)) if len(vertices) else 0.0
    if not size:
        return vertices, faces
    place = np.rint((vertices - vertices.min(axis=0)) / (_SAME * size)).astype(np.int64)
    order = np.lexsort(place.T[::-1])
    new = np.ones(len(order), dtype=bool)
    new[1:] = (place[order[1:]] != place[order[:-1]]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    first = np.full(int(new.sum()), len(order), dtype=np.int64)
    np.minimum.at(first, group, np.arange(len(order)))
    return used(vertices, first[group][faces])


def used(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Only the vertices that faces have, in their order."""
    there = np.zeros(len(vertices), dtype=bool)
    there[faces] = True
    number = np.cumsum(there) - 1
    return vertices[there], number[faces].astype(np.int64)


def repeated_corners(faces: Faces) -> Mask:
    """The faces (m,) with a vertex that is two of their corners."""
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


def repeated_faces(faces: Faces) -> Mask:
    """The faces (m,) whose three corners, in any order, an earlier face has."""
    corners = np.sort(faces, axis=1)
    order = np.lexsort((np.arange(len(faces)), *corners.T[::-1]))
    again = np.zeros(len(faces), dtype=bool)
    again[order[1:]] = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    return again


def flat_faces(vertices: Array, faces: Faces) -> Mask:
    """The faces (m,) without area: less high than a millionth of their longest side.

    That is ten times what the four-byte numbers of STL and PLY files make of a face without height.
    """
    doubled = 2 * TriangleMesh(vertices, faces).areas
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    return np.asarray(doubled <= _FLAT * longest**2)


def without_flat(vertices: Array, faces: Faces) -> Faces:
    """The same surface without flat faces, and without gaps where these were.

    A flat face has a corner on its longest side. The face on the other side of that is parted
    there, and the flat one left out. Flat faces whose longest side has not one other face are
    left out as well.
    """
    for _ in range(_PASSES):
        flat = flat_faces(vertices, faces)
        if not flat.any():
            break
        faces = _parted_beside(vertices, faces, flat)
        faces = faces[~repeated_corners(faces)]
        faces = faces[~repeated_faces(faces)]
    return faces[~flat_faces(vertices, faces)]


def _parted_beside(vertices: Array, faces: Faces, flat: Mask) -> Faces:
    """One pass over flat faces; a face takes part in one change at most."""
    _, sides = TriangleMesh(vertices, faces).pairs
    beside = np.full(3 * len(faces), -1, dtype=np.int64)
    beside[sides[:, 0]], beside[sides[:, 1]] = sides[:, 1], sides[:, 0]
    touched = np.zeros(len(faces), dtype=bool)
    keep = np.ones(len(faces), dtype=bool)
    added = []
    for face in np.flatnonzero(flat).tolist():
        corners = vertices[faces[face]]
        lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
        corner = int(np.argmax(lengths))
        side = int(beside[3 * face + corner])
        other, at = divmod(side, 3)
        if touched[face] or (side >= 0 and touched[other]):
            continue
        keep[face] = False
        touched[face] = True
        if side < 0:
            continue
        middle = int(faces[face, (corner + 2) % 3])
        a, b, c = (int(faces[other, (at + k) % 3]) for k in range(3))
        keep[other] = False
        touched[other] = True
        if middle != c:  # else two flat faces lie back to back
            added += [(a, middle, c), (middle, b, c)]
    return np.concatenate([faces[keep], np.array(added, dtype=np.int64).reshape(-1, 3)])


def against_the_others(mesh: TriangleMesh) -> tuple[Mask, Mask]:
    """The faces (m,) to be turned so that all neighbors wind alike, and those of one-sided parts.

    Neighbors are two faces with an edge that no other has. Of each part the fewer are turned. A
    part is one-sided, as a Moebius strip is, if no turning makes its neighbors wind alike.
    """
    count, ascending = len(mesh.corners), mesh.ascending.ravel()
    _, sides = mesh.pairs
    first, second = sides[:, 0] // 3, sides[:, 1] // 3
    alike = ascending[sides[:, 0]] != ascending[sides[:, 1]]
    # Every face is there twice, as it is (f) and turned (count + f); linked is what goes together.
    other = np.where(alike, second, second + count)
    mirrored = np.where(alike, second + count, second)
    links = np.concatenate(
        [np.column_stack([first, other]), np.column_stack([first + count, mirrored])]
    )
    group = grouped(2 * count, links)
    as_it_is, turned_over = group[:count], group[count:]
    chosen = np.minimum(as_it_is, turned_over)
    kept = as_it_is == chosen
    votes = np.bincount(chosen, np.where(kept, 1.0, -1.0), minlength=len(group))
    turn = kept ^ (votes[chosen] >= 0)
    one_sided = as_it_is == turned_over
    return turn & ~one_sided, one_sided


def inside_out(mesh: TriangleMesh) -> Mask:
    """The faces (m,) of closed parts with a negative volume; neighbors wind alike."""
    if not len(mesh.corners):
        return np.zeros(0, dtype=bool)
    part = mesh.parts()
    open_ = np.zeros(int(part.max(initial=-1)) + 1, dtype=bool)
    open_[part[(mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)]] = True
    points = mesh.points - mesh.points.mean(axis=0)
    a, b, c = (points[mesh.corners[:, k]] for k in range(3))
    volume = np.bincount(part, np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=len(open_))
    return np.asarray(((volume < 0) & ~open_)[part])


def turned(faces: Faces, which: Mask | Index) -> Faces:
    """Faces, some of them wound the other way round."""
    changed = faces.copy()
    changed[which] = changed[which][:, ::-1]
    return changed
