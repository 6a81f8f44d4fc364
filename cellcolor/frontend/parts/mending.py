"""Faults of a triangle mesh, found and mended with libigl.

Every function takes vertices (n, 3) and faces (m, 3). Whether a scene can use a mesh is said by
:func:`~cellcolor.frontend.parts.mesh.mesh_surface`.
"""

from __future__ import annotations

from dataclasses import dataclass

import igl
import igl.predicates
import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped, repeated_corners

_SAME = 1e-8  # share of the mesh's size; vertices this close count as one place
_FLAT = 1e-6  # of the longest side's square; a doubled area that counts as none
_INSIDE = 1e-7  # of a face's size; so far through another one a face has to go to cross it
_APART = 0.01  # of the shortest side beside a copy of a vertex
_UPRIGHT = 1e-3  # unit normals around a vertex whose mean is shorter nearly cancel out


def used(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Only the vertices that faces have, in their order."""
    there, number = np.unique(faces, return_inverse=True)
    return vertices[there], number.reshape(-1, 3).astype(np.int64)


@dataclass(frozen=True)
class Cleaned:
    """A mesh without useless faces, and what was left out.

    Attributes:
        vertices: (n, 3), for vertices in one place the first of them.
        faces: (m, 3) with an area, each once.
        unused, twins: how many vertices no face had, and how many were in one place with another.
        folded: how many faces had two corners in one place.
        double: (k, 3) faces that were there twice.
        flat: (k, 3) faces without area.
    """

    vertices: Array
    faces: Faces
    unused: int
    twins: int
    folded: int
    double: Faces
    flat: Faces


def cleaned(vertices: Array, faces: Faces) -> Cleaned:
    """A mesh without what no repair needs to think about.

    Raises:
        InputError: no face is left.
    """
    there = len(np.unique(faces))
    points, corners = vertices, faces
    size = float(np.ptp(vertices, axis=0).max(initial=0.0)) if len(vertices) else 0.0
    if size:
        place = np.rint((vertices - vertices.min(axis=0)) / (_SAME * size)).astype(np.int64)
        _, first, group = np.unique(place, axis=0, return_index=True, return_inverse=True)
        points, corners = used(vertices, first[group.ravel()][faces])
    folded = repeated_corners(corners)
    corners = corners[~folded]
    twice = repeated_faces(corners)
    double, corners = corners[twice], corners[~twice]
    thin = flat_faces(points, corners)
    flat, corners = corners[thin], corners[~thin]
    if not len(corners):
        raise InputError(None, "faces", "none is left that has an area and is no copy of another")
    unused, twins = len(vertices) - there, there - len(points)
    return Cleaned(points, corners, unused, twins, int(folded.sum()), double, flat)


def repeated_faces(faces: Faces) -> Mask:
    """The faces (m,) whose three corners, in any order, an earlier face has."""
    again = np.ones(len(faces), dtype=bool)
    again[np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1]] = False
    return again


def flat_faces(vertices: Array, faces: Faces) -> Mask:
    """The faces (m,) without area: less high than a millionth of their longest side.

    That is ten times what the four-byte numbers of STL and PLY files make of a face without height.
    """
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    return np.asarray(2 * TriangleMesh(vertices, faces).areas <= _FLAT * longest**2)


def refuse_gaps(vertices: Array, faces: Faces, flat: Faces) -> None:
    """Refuse faces beside flat ones: without these there would be gaps.

    Raises:
        InputError: a corner of a flat face lies on the side of another (a T-vertex); names the
            place.
    """
    sides = TriangleMesh(vertices, np.concatenate([faces, flat])).edge_of_side
    beside = np.isin(sides[: len(faces)], sides[len(faces) :])
    if beside.any():
        face, side = np.argwhere(beside)[0]
        middle = vertices[np.roll(faces[face], -side)[:2]].mean(axis=0)
        message = (
            "are flat, with a corner on the side of another face (a T-vertex): no repair closes "
            "that; the part has to be meshed anew by what it comes from"
        )
        raise InputError(None, f"faces near {in_words(middle)}", message)


def in_words(place: Array) -> str:
    """``(0.1, 0.2, 0.3)``."""
    return f"({', '.join(f'{x:.4g}' for x in place)})"


def turned(faces: Faces, which: Mask) -> Faces:
    """Faces, some of them with reversed winding."""
    return np.where(which[:, None], faces[:, ::-1], faces)


def against_the_others(faces: Faces) -> tuple[Mask, Mask]:
    """The faces (m,) to turn for a consistent winding, and the faces of one-sided parts.

    Neighbors are two faces with an edge that no other has. Of each part the fewer are turned. A
    part is one-sided, as a Moebius strip is, if no turning makes its neighbors wind alike.
    """
    alike, part = igl.bfs_orient(faces)
    turn = (alike != faces).any(axis=1)
    turn ^= (2 * np.bincount(part, turn) > np.bincount(part))[part]
    mesh = TriangleMesh(np.zeros((int(faces.max(initial=-1)) + 1, 3)), turned(faces, turn))
    first, second = mesh.pairs[1].T
    ascending = mesh.ascending.ravel()
    wrong = first[ascending[first] == ascending[second]] // 3
    one_sided = np.isin(part, part[wrong])
    return turn & ~one_sided, one_sided


def inside_out(mesh: TriangleMesh) -> Mask:
    """The faces (m,) of closed parts with a negative volume; neighbors wind alike."""
    part = mesh.parts()
    points = mesh.points - mesh.points.mean(axis=0)
    a, b, c = points[mesh.corners].transpose(1, 0, 2)
    volume = np.bincount(part, np.einsum("ij,ij->i", a, np.cross(b, c)))
    opened = np.bincount(part, (mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)) > 0
    return np.asarray(((volume < 0) & ~opened)[part])


def cut_apart(vertices: Array, faces: Faces) -> tuple[Array, Faces, float]:
    """A manifold: a mesh cut apart where it is none, at edges of three faces and more.

    The copies of a vertex are moved apart a little, since two in one place would be merged again.
    The one with most faces stays.

    Returns:
        vertices, faces, and how far a copy of a vertex was moved at most, in the vertices' unit.
    """
    parted, original = igl.split_nonmanifold(faces)
    corners = np.bincount(parted.ravel(), minlength=len(original))
    order = np.lexsort((-corners, original))
    moved = np.zeros(len(original), dtype=bool)
    moved[order[1:]] = original[order[1:]] == original[order[:-1]]
    points = vertices[original]
    if not moved.any():
        return points, parted, 0.0
    # Towards the middle of its faces, by a share of the shortest side that it is an end of.
    mesh, shortest = TriangleMesh(points, parted), np.full(len(points), np.inf)
    np.minimum.at(shortest, mesh.edges, mesh.lengths[:, None])
    towards = np.zeros_like(points)
    np.add.at(towards, parted, points[parted].mean(axis=1, keepdims=True) - points[parted])
    length = np.linalg.norm(towards, axis=1, keepdims=True)
    step = _APART * shortest[:, None] * towards / np.maximum(length, 1e-300) * moved[:, None]
    return points + step, parted, float(np.linalg.norm(step, axis=1).max())


def filled(vertices: Array, faces: Faces, longest: float) -> tuple[list[Faces], int]:
    """Faces for each hole of a manifold whose border is not longer, and how many holes stay.

    A hole stays if what libigl makes of its border would be flat, fold back onto the faces around,
    or give an edge a third face.
    """
    new: list[Faces] = []
    left = 0
    for loop in TriangleMesh(vertices, faces).border_loops():
        points = vertices[loop]
        if np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum() > longest:
            continue
        ends = np.array([0, len(loop)])
        made, _ = igl.predicates.polygons_to_triangles(vertices, np.array(loop), ends)
        made = made.astype(np.int64)
        whole = TriangleMesh(vertices, np.concatenate([faces, *new, made]))
        normals = np.zeros_like(vertices)
        np.add.at(normals, whole.corners, np.nan_to_num(whole.triangle_normals)[:, None])
        around = np.linalg.norm(normals[loop], axis=1)
        fits = len(made) == len(loop) - 2 and not flat_faces(vertices, made).any()
        if fits and whole.triangles_at.max() <= 2 and around.min() > _UPRIGHT:
            new.append(made)
        else:
            left += 1
    return new, left


def crossing_pairs(vertices: Array, faces: Faces) -> Index:
    """Pairs of faces (p, 2), the smaller number first, of which one goes through the other.

    Faces that share an edge are no such pair, nor are faces that lie in one plane and overlap.
    """
    mesh = TriangleMesh(vertices, faces)
    arrays = np.ascontiguousarray(vertices), np.ascontiguousarray(faces, dtype=np.int64)
    pairs = np.sort(igl.predicates.find_self_intersections(*arrays)[1], axis=1)
    normals, size = np.nan_to_num(mesh.triangle_normals), np.sqrt(mesh.areas)

    def goes_through(one: Index, other: Index) -> Mask:
        """Whether faces have corners on both sides of others, beyond what rounding does."""
        height = vertices[faces[one]] - vertices[faces[other, :1]]
        height = np.einsum("kij,kj->ki", height, normals[other])
        off = _INSIDE * np.maximum(size[one], size[other])
        return np.asarray((height.min(axis=1) < -off) & (height.max(axis=1) > off))

    first, second = pairs.T
    return np.unique(pairs[goes_through(first, second) & goes_through(second, first)], axis=0)


def border_groups(mesh: TriangleMesh) -> tuple[Index, Index]:
    """The edges (b,) with only one face, and the connected group (b,) of each."""
    border = np.flatnonzero(mesh.triangles_at == 1)
    ends = mesh.edges[border]
    group = grouped(len(mesh.points), ends)[ends[:, 0]]
    return border, np.unique(group, return_inverse=True)[1]
