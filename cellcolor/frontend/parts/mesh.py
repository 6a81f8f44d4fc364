"""Surfaces from triangle meshes: checked, refined or repaired on request only."""

from __future__ import annotations

import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import in_meters
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.remesh import refine, repair
from cellcolor.frontend.parts.surface import Faces, Surface, face_normals
from cellcolor.frontend.sizes import check_vertices

__all__ = ["mesh_surface", "summed_normals"]

_FARTHEST, _SMALLEST = 1e6, 1e-6  # m


def mesh_surface(
    vertices: Array,
    faces: Faces,
    meters_per_unit: float = 1.0,
    max_edge_m: float | None = None,
    mend: bool = False,
    deadline: Deadline = NEVER,
) -> Surface:
    """A mesh as it is, checked; refined or repaired on request.

    Normals are those of the adjoining faces, weighted with their angles.

    Args:
        vertices: (n, 3) coordinates.
        faces: (m, 3) vertex indices, counter-clockwise as seen from outside.
        meters_per_unit: of the coordinates.
        max_edge_m: longer edges are halved; normals come from the faces of the finer mesh.
        mend: see :func:`~cellcolor.frontend.parts.remesh.repair`.
        deadline: when to give up.

    Raises:
        InputError: no triangles, coordinates that are not finite, two vertices in one place, faces
            without area, vertices without faces, edges or vertices that are not manifold,
            inconsistent winding, a closed mesh inside out; names the element. More vertices than
            fit, before or after halving edges.
        OutOfTime: the deadline came first.
    """
    deadline.check()
    unknown = np.argwhere((faces < 0) | (faces >= len(vertices)))
    if len(unknown):  # here already: a repair would take -1 for the last one
        face, corner = unknown[0]
        message = f"there is no vertex {faces[face, corner]}"
        raise InputError(None, f"faces[{face}][{corner}]", message)
    if mend and len(faces) and np.isfinite(vertices).all():
        # Sizes first: a triangle that is far too long for a unit looks like one without area.
        _check_size(vertices[np.unique(faces)], meters_per_unit)
        vertices, faces = repair(vertices, faces)
    if not len(faces):
        raise InputError(None, "faces", "there are none")
    _check_size(vertices, meters_per_unit)
    check_vertices(len(vertices))
    # The labelled surface's own rules, held here before any work is done.
    bare = LabelledSurface("part", (), vertices, faces, ((),) * len(vertices))
    deadline.check()
    _check_elements(vertices, faces)
    if all((j, i) in bare.left_of for i, j in bare.left_of):  # closed
        corners = vertices[faces]
        if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0:
            raise InputError(None, "faces", "closed mesh inside out: its volume is negative")
    if max_edge_m is not None:
        size = in_meters((np.ptp(vertices, axis=0) * meters_per_unit).tolist(), " x ")
        try:
            vertices, faces = refine(vertices, faces, max_edge_m / meters_per_unit, deadline)
        except InputError as error:
            message = f"the part is {size}: {error.message}"
            raise InputError(error.file, error.field, message) from error
    deadline.check()
    normals = summed_normals(vertices, faces)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    if size.min() < 1e-6:
        vertex = np.argmin(size)
        raise InputError(None, f"vertices[{vertex}]", "has no normal: its faces cancel out")
    normals /= size
    return Surface(vertices * meters_per_unit, faces, normals, faceted=True)


def _check_size(vertices: Array, meters_per_unit: float) -> None:
    """Refuse sizes that no arm has to do with, and no distance can be computed of."""
    if not np.isfinite(vertices).all():
        return  # which has an error of its own
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    farthest = float(max(abs(low).max(), abs(high).max())) * meters_per_unit
    if farthest > _FARTHEST:
        message = f"up to {farthest:.3g} m from their origin; is meters_per_unit right?"
        raise InputError(None, "vertices", message)
    size = float((high - low).max()) * meters_per_unit
    if size < _SMALLEST:
        message = f"within {size:.3g} m of each other; is meters_per_unit right?"
        raise InputError(None, "vertices", message)


def _check_elements(vertices: Array, faces: Faces) -> None:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    if not used.all():
        raise InputError(None, f"vertices[{np.argmin(used)}]", "belongs to no face")
    _, first, index = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    twin = first[index.reshape(-1)] != np.arange(len(vertices))
    if twin.any():
        vertex = int(np.argmax(twin))
        other = int(first[index.reshape(-1)[vertex]])
        raise InputError(None, f"vertices[{vertex}]", f"in one place with vertex {other}")
    double_area = np.linalg.norm(face_normals(vertices, faces), axis=1)
    longest = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2).max(1)
    flat = double_area <= 1e-9 * longest**2
    if flat.any():
        raise InputError(None, f"faces[{np.argmax(flat)}]", "has no area")


def summed_normals(vertices: Array, faces: Faces) -> Array:
    """Sums of the adjoining faces' unit normals, weighted with their angles at the vertex.

    trimesh's own vertex normals have length 1 already, and so do not tell faces that cancel out.
    """
    angles = trimesh.triangles.angles(vertices[faces])
    unit = face_normals(vertices, faces)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, angles[:, :, None] * unit[:, None])
    return normals
