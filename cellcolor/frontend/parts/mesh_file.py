"""Surfaces from mesh files."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Literal

import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.obj_file import read_obj
from cellcolor.frontend.parts.part import Part
from cellcolor.frontend.parts.surface import Faces, Surface
from cellcolor.frontend.sizes import check_faces
from cellcolor.frontend.tables import Positive

__all__ = ["MeshObject", "load_mesh", "read_mesh"]

_MOST_BYTES = 200_000_000  # some millions of triangles; reading takes ten times as much memory
_HEADER = 4096  # bytes; where a PLY file names its elements


class MeshObject(Part):
    """A triangle mesh from a file (STL, OBJ, PLY)."""

    kind: Literal["mesh"] = "mesh"
    file: str
    meters_per_unit: Positive
    max_edge_m: Positive | None = None
    repair: bool = False

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:
        """The mesh as it is, or refined or repaired on request; see :func:`load_mesh`."""
        units, longest = self.meters_per_unit, self.max_edge_m
        return load_mesh(folder / self.file, units, longest, self.repair, deadline)


def load_mesh(
    file: Path,
    meters_per_unit: float,
    max_edge_m: float | None = None,
    mend: bool = False,
    deadline: Deadline = NEVER,
) -> Surface:
    """A mesh file as a surface, checked; see :func:`~cellcolor.frontend.parts.mesh.mesh_surface`.

    STL has no shared vertices, so there the corners with equal coordinates are one vertex.

    Args:
        meters_per_unit: of the file's coordinates.
        max_edge_m, mend: see :func:`~cellcolor.frontend.parts.mesh.mesh_surface`.
        deadline: when to give up; not looked at while another library reads the file.

    Raises:
        InputError: missing or unreadable file, or the mesh cannot be used; names file and element.
        OutOfTime: the deadline came first.
    """
    try:
        vertices, faces = read_mesh(file, deadline)
        check_faces(len(faces))
        return mesh_surface(vertices, faces, meters_per_unit, max_edge_m, mend, deadline)
    except InputError as error:
        # Of halving edges the scene is to blame, which alone can say that it was asked for.
        raise error if error.field == "max_edge_m" else error.in_file(str(file)) from error


def read_mesh(file: Path, deadline: Deadline = NEVER) -> tuple[Array, Faces]:
    """Vertices and faces of a mesh file as they are, of STL with equal corners as one vertex.

    Raises:
        InputError: missing or unreadable file, or more than 200 MB; names the file.
        OutOfTime: the deadline came first; not looked at while another library reads the file.
    """
    if not _is_file(file):
        raise InputError(str(file), None, "no such mesh file")
    if file.suffix.lower() not in (".stl", ".obj", ".ply"):
        raise InputError(str(file), None, "not a mesh format known here (STL, OBJ, PLY)")
    if file.stat().st_size > _MOST_BYTES:
        message = f"has {file.stat().st_size:,} bytes, at most {_MOST_BYTES:,} are read"
        raise InputError(str(file), None, message)
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
