"""A part whose mesh is in memory: arrays, or a mesh of trimesh."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, model_serializer

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mesh import mesh_surface
from cellcolor.frontend.parts.part import Part
from cellcolor.frontend.parts.surface import Faces, Surface


def _coordinates(value: Any) -> Array:
    vertices: Array = np.array(value, dtype=np.float64)
    _check_triples(vertices)
    return vertices


def _indices(value: Any) -> Faces:
    given = np.array(value)
    if given.dtype.kind not in "iu":
        raise ValueError("needs whole numbers")
    faces: Faces = given.astype(np.int64)
    _check_triples(faces)
    return faces


def _check_triples(array: NDArray[Any]) -> None:
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"needs three columns, has the shape {array.shape}")
    array.setflags(write=False)


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
