"""Surfaces from mesh files: checked, repaired on request only."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.sizes import check_faces, check_vertices
from cellcolor.frontend.target.obj_file import read_obj
from cellcolor.frontend.target.remesh import refine, repair
from cellcolor.frontend.target.surface import Faces, Surface, face_normals

__all__ = ["load_mesh"]

_FARTHEST, _SMALLEST = 1e6, 1e-6  # m
_HEADER = 4096  # bytes; where a PLY file names its elements


def load_mesh(
    file: Path,
    meters_per_unit: float,
    max_edge_m: float | None = None,
    mend: bool = False,
    deadline: Deadline = NEVER,
) -> Surface:
    """A mesh file as it is, checked; refined or repaired on request.

    STL has no shared vertices, so there the corners with equal coordinates are one vertex.
    Normals are those of the adjoining faces, weighted with their angles.

    Args:
        meters_per_unit: of the file's coordinates.
        max_edge_m: longer edges are halved; normals come from the faces of the finer mesh.
        mend: see :func:`~cellcolor.frontend.target.remesh.repair`.
        deadline: when to give up; not looked at while another library reads the file.

    Raises:
        InputError: missing or unreadable file, no triangles, coordinates that are not finite,
            two vertices in one place, faces without area, vertices without faces, edges or
            vertices that are not manifold, inconsistent winding, a closed mesh inside out;
            names the element. More vertices than fit, before or after halving edges.
        OutOfTime: the deadline came first.
    """
    vertices, faces = _read_mesh(file, deadline)
    deadline.check()
    unknown = np.argwhere((faces < 0) | (faces >= len(vertices)))
    if len(unknown):  # here already: a repair would take -1 for the last one
        face, corner = unknown[0]
        message = f"there is no vertex {faces[face, corner]}"
        raise InputError(str(file), f"faces[{face}][{corner}]", message)
    if mend:
        finite = np.isfinite(vertices).all()
        vertices, faces = repair(vertices, faces) if finite else (vertices, faces)
    if not len(faces):
        raise InputError(str(file), "faces", "there are none")
    _check_size(file, vertices, meters_per_unit)
    try:
        check_vertices(len(vertices))
        # The labelled surface's own rules, held here before any work is done.
        bare = LabelledSurface(file.name, (), vertices, faces, ((),) * len(vertices))
    except InputError as error:
        raise error.in_file(str(file)) from error
    deadline.check()
    _check_elements(file, vertices, faces)
    if all((j, i) in bare.left_of for i, j in bare.left_of):  # closed
        corners = vertices[faces]
        if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0:
            raise InputError(str(file), "faces", "closed mesh inside out: its volume is negative")
    if max_edge_m is not None:
        vertices, faces = refine(vertices, faces, max_edge_m / meters_per_unit, deadline)
    deadline.check()
    normals = _vertex_normals(vertices, faces)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    if size.min() < 1e-6:
        vertex = np.argmin(size)
        raise InputError(str(file), f"vertices[{vertex}]", "has no normal: its faces cancel out")
    normals /= size
    return Surface(vertices * meters_per_unit, faces, normals)


def _read_mesh(file: Path, deadline: Deadline) -> tuple[Array, Faces]:
    if not _is_file(file):
        raise InputError(str(file), None, "no such mesh file")
    if file.suffix.lower() not in (".stl", ".obj", ".ply"):
        raise InputError(str(file), None, "not a mesh format known here (STL, OBJ, PLY)")
    if file.suffix.lower() == ".obj":
        return read_obj(file, deadline)
    _check_container(file)
    try:
        mesh = trimesh.load_mesh(file, process=False, maintain_order=True)
        vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except Exception as error:  # trimesh's readers raise whatever their parsers ran into
        raise InputError(str(file), None, f"trimesh cannot read it: {error!r}") from error
    deadline.check()
    try:
        check_faces(len(faces))
    except InputError as error:
        raise error.in_file(str(file)) from error
    if file.suffix.lower() == ".stl":
        vertices, index = np.unique(vertices, axis=0, return_inverse=True)
        faces = index.reshape(-1)[faces]
    return vertices, faces


def _is_file(file: Path) -> bool:
    try:
        return file.is_file()
    except OSError:  # a name that is too long
        return False


def _check_container(file: Path) -> None:
    """Refuse what trimesh takes for text in an unknown encoding, or for a mesh without faces.

    Raises:
        InputError: an STL file is cut off or none, or a PLY file has its triangles in strips.
    """
    try:
        with file.open("rb") as stream:
            head = stream.read(_HEADER)
            size = stream.seek(0, io.SEEK_END)
    except OSError as error:
        raise InputError(str(file), None, error.strerror or "cannot be read") from error
    if file.suffix.lower() == ".ply":
        if re.search(rb"^element\s+tri_?strips?\s", head, re.MULTILINE):
            message = "has triangle strips, which are not read: save it with faces"
            raise InputError(str(file), "tristrips", message)
        return
    faces = int.from_bytes(head[80:84], "little")
    if len(head) >= 84 and size == 84 + 50 * faces:
        return  # binary
    if not head.lstrip().lower().startswith(b"solid"):
        message = "cut off, or no STL"
        if len(head) >= 84:
            message += f": for {faces} faces it needs {84 + 50 * faces} bytes, it has {size}"
        raise InputError(str(file), None, message)
    try:
        file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError(str(file), None, "neither binary STL nor UTF-8 text") from error


def _check_size(file: Path, vertices: Array, meters_per_unit: float) -> None:
    """Refuse sizes that no arm has to do with, and no distance can be computed of."""
    if not np.isfinite(vertices).all():
        return  # which has an error of its own
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    farthest = float(max(abs(low).max(), abs(high).max())) * meters_per_unit
    if farthest > _FARTHEST:
        message = f"up to {farthest:.3g} m from their origin; is meters_per_unit right?"
        raise InputError(str(file), "vertices", message)
    size = float((high - low).max()) * meters_per_unit
    if size < _SMALLEST:
        message = f"within {size:.3g} m of each other; is meters_per_unit right?"
        raise InputError(str(file), "vertices", message)


def _check_elements(file: Path, vertices: Array, faces: Faces) -> None:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    if not used.all():
        raise InputError(str(file), f"vertices[{np.argmin(used)}]", "belongs to no face")
    _, first, index = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    twin = first[index.reshape(-1)] != np.arange(len(vertices))
    if twin.any():
        vertex = int(np.argmax(twin))
        other = int(first[index.reshape(-1)[vertex]])
        raise InputError(str(file), f"vertices[{vertex}]", f"in one place with vertex {other}")
    double_area = np.linalg.norm(face_normals(vertices, faces), axis=1)
    longest = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2).max(1)
    flat = double_area <= 1e-9 * longest**2
    if flat.any():
        raise InputError(str(file), f"faces[{np.argmax(flat)}]", "has no area")


def _vertex_normals(vertices: Array, faces: Faces) -> Array:
    """Sums of the adjoining faces' unit normals, weighted with their angles at the vertex."""
    corners = vertices[faces]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    cosine = (
        (ahead * behind).sum(2) / np.linalg.norm(ahead, axis=2) / np.linalg.norm(behind, axis=2)
    )
    angles = np.arccos(np.clip(cosine, -1, 1))
    unit = face_normals(vertices, faces)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, angles[:, :, None] * unit[:, None])
    return normals
