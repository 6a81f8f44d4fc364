"""Surfaces from mesh files, and the unit of a file, which is guessed from its size.

A Wavefront OBJ is read as one mesh, positions and faces: its groups, objects and materials part a
file into meshes, and texture coordinates double vertices along seams, but for a robot it is all
one surface. trimesh reads the other formats. Faces of more than three corners are cut into
triangles that fill their outlines.
"""

from __future__ import annotations

import io
import math
import re
from array import array
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Literal, TextIO

import igl.predicates
import numpy as np
import trimesh

from cellcolor.arrays import Array, Index, Mask, numbered
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, naming, system_errors
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.surface import MOST_VERTICES, Faces, Part, Surface
from cellcolor.frontend.tables import Positive
from cellcolor.mesh.triangle_mesh import TriangleMesh, check_corners

_MOST_BYTES = 200_000_000  # some millions of triangles; reading takes ten times as much memory
_PLY_CORNERS = ("vertex_indices", "vertex_index")
_HEADER = 4096  # bytes; where a PLY file names its elements


class MeshObject(Part):
    """A triangle mesh from a file (STL, OBJ, PLY)."""

    kind: Literal["mesh"] = "mesh"
    file: str
    meters_per_unit: Positive
    max_edge_m: Positive | None = None
    repair: bool = False
    flip: bool = False

    NEWER = ("flip",)

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:
        """The mesh, checked, or refined or repaired on request.

        See :func:`~cellcolor.frontend.parts.mesh.mesh_surface`. STL has no shared vertices, so
        there the corners with equal coordinates are one vertex. With ``flip`` the faces are turned
        over; of an open mesh the other side is then the outside.

        Raises:
            InputError: missing or unreadable file, or the mesh cannot be used; names file and
                element.
        """
        file = folder / self.file
        try:
            vertices, faces = read_mesh(file, deadline)
            if len(faces) > 3 * MOST_VERTICES:  # there are two for each vertex, more with handles
                message = f"there are {len(faces):,}, at most {MOST_VERTICES:,} vertices fit"
                raise InputError(None, "faces", message)
            faces = np.ascontiguousarray(faces[:, ::-1]) if self.flip else faces
            units, longest = self.meters_per_unit, self.max_edge_m
            return mesh_surface(vertices, faces, units, longest, self.repair, deadline)
        except InputError as error:
            # Of halving edges the scene is to blame, which alone can say that it was asked for.
            if error.field == "max_edge_m":
                raise
            message = error.message
            if error.field and error.field.startswith(("faces[", "vertices[")):
                # A scene repairs less than the command does.
                command = f"cellcolor repair {file} -o {file.stem}-repaired.obj"
                message += f"; repair it first: {command}" if self.repair else ""
            raise InputError(error.file or str(file), error.field, message) from error


def read_mesh(file: Path, deadline: Deadline = NEVER) -> tuple[Array, Faces]:
    """Vertices and faces of a mesh file as they are, of STL with equal corners as one vertex.

    Raises:
        InputError: missing or unreadable file, or more than 200 MB; names the file.
        OutOfTime: the deadline came first; not looked at while another library reads the file.
    """
    if not _is_file(file):
        there = "is a directory" if file.is_dir() else "no such mesh file"
        raise InputError(str(file), None, there)
    if file.suffix.lower() not in (".stl", ".obj", ".ply"):
        raise InputError(str(file), None, "not a mesh format known here (STL, OBJ, PLY)")
    if file.stat().st_size > _MOST_BYTES:
        message = f"has {file.stat().st_size:,} bytes, at most {_MOST_BYTES:,} are read"
        raise InputError(str(file), None, message)
    if file.suffix.lower() == ".obj":
        return read_obj(file, deadline)
    _check_container(file)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused below
            mesh = trimesh.load_mesh(file, process=False, maintain_order=True)
        vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except Exception as error:  # trimesh's readers raise whatever their parsers ran into
        raise InputError(str(file), None, f"trimesh cannot read it: {error!r}") from error
    deadline.check()
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        stl = file.suffix.lower() == ".stl"  # whose faces have three vertices of their own
        place = f"faces[{bad[0] // 3}]" if stl else f"vertices[{bad[0]}]"
        raise InputError(str(file), place, "has a coordinate that is not a finite number")
    if file.suffix.lower() == ".ply" and len(faces) > mesh.metadata["_ply_raw"]["face"]["length"]:
        with naming(file):
            faces = _ply_faces(mesh)
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
    with system_errors(file, "cannot be read"), file.open("rb") as stream:
        head = stream.read(_HEADER)
        size = stream.seek(0, io.SEEK_END)
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


def read_obj(file: Path, deadline: Deadline) -> tuple[Array, Faces]:
    """Vertices (n, 3) in the order of the file, and triangles (m, 3).

    Raises:
        InputError: unreadable, a face of fewer than three corners or one that crosses itself, an
            index of no vertex, what is not a number; names the line.
    """
    points, corners, sizes, lines = array("d"), array("q"), array("q"), array("q")
    with (
        system_errors(file, "cannot be read"),
        file.open(encoding="utf-8", errors="replace") as stream,
    ):
        for number, line in deadline.watch(_lines(stream)):
            kind, *words = line.split() or [""]
            try:
                if kind == "v":
                    points.extend(map(float, words[:3]))
                    if len(points) % 3:
                        raise ValueError("a vertex has three coordinates")
                    if not all(map(math.isfinite, points[-3:])):
                        raise ValueError("a coordinate is not a finite number")
                elif kind == "f":
                    face = [_index(word, len(points) // 3) for word in words]
                    if len(face) < 3:
                        raise ValueError("a face has three corners or more")
                    corners.extend(face)
                    sizes.append(len(face))
                    lines.append(number)
            except (ValueError, OverflowError) as error:
                raise InputError(str(file), f"line {number}", str(error)) from error
    vertices = np.array(points, dtype=np.float64).reshape(-1, 3)
    with naming(file):
        given = np.array(corners, dtype=np.int64), np.array(sizes, dtype=np.int64)
        return vertices, triangulated(vertices, *given, lambda face: f"line {lines[face]}")


def _ply_faces(mesh: trimesh.Trimesh) -> Faces:
    """The triangles of a PLY file's faces, of which trimesh cuts concave ones wrongly.

    Raises:
        InputError: a face crosses itself; names it.
    """
    data = mesh.metadata["_ply_raw"]["face"]["data"]
    text = isinstance(data, dict)
    names = list(data) if text else data.dtype.names
    name = next((each for each in names if each in _PLY_CORNERS), names[0])
    rows = [np.asarray(row, dtype=np.int64) for row in (data[name] if text else data[name]["f1"])]
    sizes = np.array([len(row) for row in rows])
    vertices = np.asarray(mesh.vertices)
    check_corners(np.asarray(mesh.faces), len(vertices))
    return triangulated(vertices, np.concatenate(rows), sizes, lambda face: f"faces[{face}]")


def _lines(stream: TextIO) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; one that ends in a backslash goes on in the next."""
    begun = ""
    for number, line in enumerate(stream, start=1):
        text = line.partition("#")[0].rstrip()
        if text.endswith("\\"):
            begun += text[:-1] + " "
            continue
        yield number, begun + text
        begun = ""


def _index(word: str, known: int) -> int:
    """The vertex of a corner ``v``, ``v/vt`` or ``v/vt/vn``; below zero counted from the end."""
    given = int(word.partition("/")[0])
    index = given - 1 if given > 0 else known + given
    if not given or not 0 <= index < known:
        raise ValueError(f"there is no vertex {given} so far")
    return index


UNITS = {"m": 1.0, "mm": 0.001, "cm": 0.01, "in": 0.0254}
"""In meters."""
_METERS, _MILLIMETERS = 3.0, 10.0  # greatest extent; up to it meters, from it on millimeters


def likely_unit(extent: float) -> tuple[str | None, str]:
    """``m`` or ``mm`` or None, and why, for the greatest extent of a mesh in its own unit."""
    size = f"its greatest extent is {extent:.4g}"
    if extent <= _METERS:
        return "m", f"{size}: in millimeters it would be smaller than the tip of a tool"
    if extent >= _MILLIMETERS:
        return "mm", f"{size}: in meters it would be larger than what an arm covers"
    return None, f"{size}, which could be meters as well as millimeters: say which, --unit"


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
    of, number = numbered(sizes - 2)
    starts = np.cumsum(sizes) - sizes
    first = starts[of]
    faces: Faces = corners[np.column_stack([first, first + number + 1, first + number + 2])]
    places = np.nan_to_num(vertices)  # what is not finite is refused elsewhere
    for face in np.flatnonzero(_beside(places, faces, of)[0]).tolist():
        own = corners[starts[face] :][: sizes[face]]
        ears, _ = igl.predicates.polygons_to_triangles(places, own, np.array([0, len(own)]))
        alone = np.zeros(len(ears), dtype=np.int64)
        if len(ears) != len(own) - 2 or _beside(places, ears, alone)[0].any():
            message = f"the face of {len(own)} corners crosses itself: no triangles fill it"
            raise InputError(None, name(face), message)
        faces[of == face] = ears
    bent = _beside(places, faces, of)[1]
    if bent.max(initial=0.0) > _BENT:
        at = np.flatnonzero(bent > _BENT)[0]
        message = (
            f"the face of {sizes[of[at]]} corners is far from flat, a part of it "
            f"{np.degrees(bent[at]):.0f} degrees off the whole: triangles have to say where it "
            "bends"
        )
        raise InputError(None, name(int(of[at])), message)
    return faces


def _beside(vertices: Array, triangles: Faces, of: Index) -> tuple[Mask, Array]:
    """Which faces have a triangle that lies outside, and how far triangles (m,) are off them, rad.

    Args:
        of: (m,) the face that each triangle is a part of. Small ones say nothing of how it bends.
    """
    mesh = TriangleMesh(vertices, triangles)
    whole = np.zeros((of.max(initial=-1) + 1, 3))
    np.add.at(whole, of, mesh.area_vectors)
    size, area = np.linalg.norm(whole, axis=1), np.bincount(of, mesh.areas)
    along = np.einsum("ij,ij->i", mesh.area_vectors, whole[of])
    against = along < -_AGAINST * (size * area)[of]
    outside = (np.bincount(of, against) > 0) | (size < _AGAINST * area)
    large = 2 * mesh.areas > _SMALL * size[of]
    with np.errstate(invalid="ignore"):
        off = np.arccos(np.clip(along / (2 * mesh.areas * size[of]), -1, 1))
    return np.asarray(outside), np.where(large, off, 0.0)
