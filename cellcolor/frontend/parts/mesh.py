"""Surfaces from triangle meshes, in memory too: checked, refined or repaired on request only."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import trimesh
from numpy.typing import NDArray
from pydantic import PlainValidator, model_serializer

from cellcolor.arrays import Array, Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import in_meters
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mending import (
    against_the_others,
    cleaned,
    in_words,
    inside_out,
    refuse_gaps,
    turned,
    used,
)
from cellcolor.frontend.parts.surface import Faces, Part, Surface, check_vertices, refine
from cellcolor.mesh.triangle_mesh import TriangleMesh, check_corners

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
        max_edge_m: longer edges are halved; normals come from the faces of the finer mesh.
        mend: merge vertices in one place, drop useless faces and vertices, make the winding
            consistent. A closed mesh is turned outside out. For an open one the side that most
            faces have is kept; only its owner knows which side is the outside. Remaining faults
            (edges that are not manifold, holes) stay.

    Raises:
        InputError: no triangles, coordinates that are not finite, two vertices in one place, faces
            without area, vertices without faces, edges or vertices that are not manifold,
            inconsistent winding, a closed mesh inside out; names the element. More vertices than
            fit, before or after halving edges.
    """
    deadline.check()
    check_corners(faces, len(vertices))  # here already: a repair would take -1 for the last one
    if mend and len(faces) and np.isfinite(vertices).all():
        # Sizes first: a triangle that is far too long for a unit looks like one without area.
        _check_size(vertices[np.unique(faces)], meters_per_unit)
        clean = cleaned(vertices, faces)
        refuse_gaps(clean.vertices, clean.faces, clean.flat)
        vertices, faces = used(clean.vertices, clean.faces)
        faces = turned(faces, against_the_others(faces)[0])
        faces = turned(faces, inside_out(TriangleMesh(vertices, faces)))
    if not len(faces):
        raise InputError(None, "faces", "there are none")
    _check_size(vertices, meters_per_unit)
    check_vertices(len(vertices))
    # The labelled surface's own rules, held here before any work is done.
    LabelledSurface("part", (), vertices, faces, ((),) * len(vertices))
    deadline.check()
    mesh = TriangleMesh(vertices, faces)
    _check_elements(mesh)
    if not mesh.border.any():  # closed
        corners = vertices[faces]
        if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0:
            raise InputError(None, "faces", "closed mesh inside out: its volume is negative")
    divided: tuple[TriangleMesh, Index] | None = None
    if max_edge_m is not None:
        size = in_meters((np.ptp(vertices, axis=0) * meters_per_unit).tolist())
        try:
            whole = TriangleMesh(mesh.points * meters_per_unit, mesh.corners)
            mesh, lies_in = refine(mesh, max_edge_m / meters_per_unit, deadline)
            divided = whole, lies_in
        except InputError as error:
            message = f"the part is {size}: {error.message}"
            raise InputError(error.file, error.field, message) from error
    deadline.check()
    # trimesh's own vertex normals have length 1 already, and do not reveal faces that cancel out.
    angles = trimesh.triangles.angles(mesh.points[mesh.corners])
    normals = np.zeros_like(mesh.points)
    np.add.at(normals, mesh.corners, angles[:, :, None] * mesh.triangle_normals[:, None])
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    if size.min() < 1e-6:
        vertex = int(np.argmin(size))
        field, message = f"vertices[{vertex}]", "has no normal: its faces cancel out"
        if divided is not None and vertex >= len(vertices):  # one that no file has
            face = divided[1][(mesh.corners == vertex).any(axis=1)][0]
            where = in_words(mesh.points[vertex] * meters_per_unit)
            field, message = (
                f"faces[{face}]",
                f"lies on another, so there is no normal at {where} m",
            )
        raise InputError(None, field, message)
    normals /= size
    points = mesh.points * meters_per_unit
    return Surface(points, mesh.corners, normals, faceted=True, divided=divided)


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


def _check_elements(mesh: TriangleMesh) -> None:
    _, first, index = np.unique(mesh.points, axis=0, return_index=True, return_inverse=True)
    earlier = first[index.ravel()]
    twin = earlier != np.arange(len(mesh.points))
    if twin.any():
        vertex = int(np.argmax(twin))
        message = f"in the same place as vertex {earlier[vertex]}"
        raise InputError(None, f"vertices[{vertex}]", message)
    longest = mesh.lengths[mesh.edge_of_side].max(axis=1)
    flat = 2 * mesh.areas <= 1e-9 * longest**2
    if flat.any():
        raise InputError(None, f"faces[{np.argmax(flat)}]", "has no area")


def _coordinates(value: Any) -> Array:
    return _triples(np.array(value, dtype=np.float64))


def _indices(value: Any) -> Faces:
    given = np.array(value)
    if given.dtype.kind not in "iu":
        raise ValueError("needs whole numbers")
    return _triples(given.astype(np.int64))


def _triples(array: NDArray[Any]) -> NDArray[Any]:
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"needs three columns, has the shape {array.shape}")
    array.setflags(write=False)
    return array


class ArraysObject(Part):
    """A triangle mesh in memory, in meters; no file has one.

    Attributes:
        vertices: (n, 3) in m.
        faces: (m, 3) vertex indices, counter-clockwise as seen from outside.
    """

    kind: Literal["arrays"] = "arrays"
    vertices: Annotated[Any, PlainValidator(_coordinates)]
    faces: Annotated[Any, PlainValidator(_indices)]

    @classmethod
    def of(cls, mesh: Any) -> ArraysObject:
        """From a ``trimesh.Trimesh``, or from vertices and faces.

        Raises:
            InputError: it is neither.
        """
        if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
            return cls(vertices=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces))
        if isinstance(mesh, tuple) and len(mesh) == 2:
            return cls(vertices=np.asarray(mesh[0]), faces=np.asarray(mesh[1]))
        message = "must be a part, a mesh of trimesh, or (vertices, faces)"
        raise InputError(None, "object", message)

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:  # noqa: ARG002
        """The mesh, checked like a mesh file."""
        return mesh_surface(self.vertices, self.faces, deadline=deadline)

    @property
    def sha256(self) -> str:
        """Fingerprint of the arrays."""
        text = self.vertices.astype(">f8").tobytes() + self.faces.astype(">i8").tobytes()
        return hashlib.sha256(text).hexdigest()

    @model_serializer
    def _in_short(self) -> dict[str, Any]:
        """What a surface's ``meta`` says of it: the surface has the mesh itself."""
        sizes = {"vertices": len(self.vertices), "faces": len(self.faces)}
        return {"kind": self.kind, **sizes, "sha256": self.sha256}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ArraysObject) and self.sha256 == other.sha256

    def __hash__(self) -> int:
        return hash(self.sha256)
