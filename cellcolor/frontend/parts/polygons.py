"""Faces of more than three corners, cut into triangles that fill their outlines."""

from __future__ import annotations

from collections.abc import Callable

import igl.predicates
import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

_BENT = np.radians(30.0)  # between a face's normal and that of a triangle in it
_SMALL = 0.01  # of a face's area; smaller triangles say nothing of how it bends
_AGAINST = 1e-9  # of a face's area; a triangle that is so far wound against its face is outside


def triangulated(
    vertices: Array, corners: Index, sizes: Index, name: Callable[[int], str]
) -> Faces:
    """Triangles (m, 3) of faces, in their order, wound as they are.

    A face is cut into a fan about its first corner. Where that leaves its outline, because the face
    is concave, libigl clips its ears.

    Args:
        corners: vertices of all faces, one face after another.
        sizes: how many corners each face has, three or more.
        name: of a face in its file, for errors.

    Raises:
        InputError: a face crosses itself, so no triangles fill it, or it is far from flat.
    """
    of = np.repeat(np.arange(len(sizes)), sizes - 2)
    starts = np.cumsum(sizes) - sizes
    first = starts[of]
    onward = first + np.arange(len(of)) - (starts - 2 * np.arange(len(sizes)))[of]
    faces: Faces = corners[np.column_stack([first, onward + 1, onward + 2])].reshape(-1, 3)
    places = np.nan_to_num(vertices)  # what is not finite is refused elsewhere
    cut = sizes[of] > 3
    for face in np.flatnonzero(_leaving(places, faces[cut], of[cut], len(sizes))).tolist():
        own = corners[starts[face] :][: sizes[face]]
        ears, _ = igl.predicates.polygons_to_triangles(places, own, np.array([0, len(own)]))
        alone = np.zeros(len(ears), dtype=np.int64)
        if len(ears) != len(own) - 2 or _leaving(places, ears, alone, 1)[0]:
            message = f"the face of {len(own)} corners crosses itself: no triangles fill it"
            raise InputError(None, name(face), message)
        faces[of == face] = ears
    _refuse_bent(places, faces, of, sizes, name)
    return faces


def _leaving(vertices: Array, triangles: Faces, of: Index, faces: int) -> Mask:
    """Of which faces (faces,) some triangle lies outside, by the face ``of`` each (m,)."""
    along, area, size = _along_face(vertices, triangles, of, faces)
    least = np.full(faces, np.inf)
    np.minimum.at(least, of, along)
    return np.asarray((least < -_AGAINST * size * area) | (size < _AGAINST * area))


def _refuse_bent(
    vertices: Array, triangles: Faces, of: Index, sizes: Index, name: Callable[[int], str]
) -> None:
    """Refuse a face of more than three corners that is far from flat: where it bends is open."""
    along, _, size = _along_face(vertices, triangles, of, len(sizes))
    areas = np.linalg.norm(TriangleMesh(vertices, triangles).area_vectors, axis=1)
    large = (sizes[of] > 3) & (areas > _SMALL * size[of])
    bent = np.flatnonzero(large & (along < np.cos(_BENT) * areas * size[of]))
    if len(bent):
        at = bent[0]
        angle = np.degrees(np.arccos(np.clip(along[at] / (areas[at] * size[of[at]]), -1, 1)))
        message = (
            f"the face of {sizes[of[at]]} corners is far from flat, a part of it {angle:.0f} "
            "degrees off the whole: triangles have to say where it bends"
        )
        raise InputError(None, name(int(of[at])), message)


def _along_face(
    vertices: Array, triangles: Faces, of: Index, faces: int
) -> tuple[Array, Array, Array]:
    """Products (m,) of the area vectors of triangles and their faces; area and size of faces."""
    mesh = TriangleMesh(vertices, triangles)
    whole = np.zeros((faces, 3))
    np.add.at(whole, of, mesh.area_vectors)
    along = np.einsum("ij,ij->i", mesh.area_vectors, whole[of])
    return along, np.asarray(np.bincount(of, mesh.areas, faces)), np.linalg.norm(whole, axis=1)
