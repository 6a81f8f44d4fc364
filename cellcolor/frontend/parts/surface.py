"""The surface to be covered, a triangle mesh with normals at its vertices, and the parts that have
one: the kinds of ``[object]`` in a scene.

A build keeps some kilobytes for each vertex. What a mesh may have is chosen so that 4 GiB are
enough, and asked before memory is spent; units read wrongly are the usual way past it.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, angles_between
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.placement import Placement, rotation_from_rpy
from cellcolor.frontend.tables import Registry, Table
from cellcolor.mesh.dividing import halved
from cellcolor.mesh.triangle_mesh import TriangleMesh

Faces = NDArray[np.int64]

MOST_VERTICES = 250_000


def check_vertices(count: int, field: str | None = None) -> None:
    """Refuse a mesh with too many vertices."""
    if count > MOST_VERTICES:
        raise InputError(None, field, f"has {count:,} vertices, at most {MOST_VERTICES:,} fit")


SHARP = float(np.radians(30.0))
"""Between the normals of two faces, rad; an edge is sharp from there on."""


@dataclass(frozen=True)
class Surface:
    """A triangle mesh with outward unit normals; faces are counter-clockwise from outside.

    Attributes:
        vertices: (n, 3), m.
        faces: (m, 3) vertices of each triangle.
        normals: (n, 3) at the vertices.
        faceted: whether the normals are means of face normals; else a smooth shape's own.
        divided: the mesh before its edges were halved, m, and in which of its triangles each face
            lies (m,); None if none were.
    """

    vertices: Array
    faces: Faces
    normals: Array
    faceted: bool = False
    divided: tuple[TriangleMesh, Index] | None = None

    def placed(self, placement: Placement) -> Surface:
        """The same surface in the world."""
        turn = rotation_from_rpy(*placement.rpy_rad)
        vertices = placement.placed(self.vertices)
        return replace(self, vertices=vertices, normals=self.normals @ turn.T)

    def taken_along(self, before: Placement, after: Placement) -> Surface:
        """This surface, already placed, after its part has been moved to another placement."""
        turn = rotation_from_rpy(*after.rpy_rad) @ rotation_from_rpy(*before.rpy_rad).T
        vertices = (self.vertices - np.array(before.position_m)) @ turn.T
        vertices += np.array(after.position_m)
        return replace(self, vertices=vertices, normals=self.normals @ turn.T)

    @cached_property
    def mesh(self) -> TriangleMesh:
        """The mesh alone, with everything computed from it."""
        return TriangleMesh(self.vertices, self.faces)

    def lengths(self, edges: Faces) -> Array:
        """Lengths (k,) of mesh edges (k, 2), m."""
        i, j = edges.T
        lengths: Array = np.linalg.norm(self.vertices[i] - self.vertices[j], axis=1)
        return lengths

    def turns(self, edges: Faces) -> Array:
        """Angles (k,) between the normals at the ends of mesh edges (k, 2), rad."""
        i, j = edges.T
        return angles_between(self.normals[i], self.normals[j])


def along_edges(surface: Surface, edges: Index, way: Array) -> tuple[Array, Array]:
    """Points (k, 3), m, on mesh edges (k, 2), and unit tool directions (k, 3) there.

    Both are interpolated: ``way`` (k,) is 0 at an edge's first end and 1 at its second. The
    direction is NaN where the normals of the two ends cancel.
    """
    i, j = edges.T
    at = way[:, None]
    points = (1 - at) * surface.vertices[i] + at * surface.vertices[j]
    normals = (1 - at) * surface.normals[i] + at * surface.normals[j]
    with np.errstate(invalid="ignore"):
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points, -normals


def refine(
    mesh: TriangleMesh, longest: float, deadline: Deadline = NEVER
) -> tuple[TriangleMesh, Index]:
    """Halve edges until none is longer than ``longest``, in the unit of the mesh.

    The surface stays the same and the mesh conforming, since an edge is halved for both its
    faces. The given points come first.

    Returns:
        The finer mesh, and in which triangle of the given one each of its triangles lies.

    Raises:
        InputError: there would be too many vertices; that is checked in advance.
    """
    # An edge is cut into as many parts as fit at least. A triangle has no more area than the
    # equilateral one on its longest side, and there are about two triangles for each vertex.
    on_edges = len(mesh.points) + float(np.ceil(mesh.lengths / longest - 1).sum())
    needed = max(on_edges, float(mesh.areas.sum()) / (np.sqrt(3) / 4 * longest**2) / 2)
    if needed > MOST_VERTICES:
        raise InputError(
            None,
            "max_edge_m",
            f"needs about {needed:.2g} vertices or more, at most {MOST_VERTICES:,} fit: "
            "is it too small, or meters_per_unit too large?",
        )
    lies_in = np.arange(len(mesh.corners))
    while True:
        deadline.check()
        marked = mesh.lengths > longest
        if not marked.any():
            return mesh, lies_in
        check_vertices(len(mesh.points) + int(marked.sum()), "max_edge_m")
        mesh, of = halved(mesh, marked)
        lies_in = lies_in[of]


class Part(Table):
    """An object in its own frame: the keys of its table, and the surface that they describe.

    A kind that files can name has a key ``kind`` with its name, and is registered in ``PARTS`` or
    by an entry point of the group ``cellcolor.parts``.
    """

    @abstractmethod
    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:
        """The part's surface in its own frame.

        Args:
            folder: what the names of files in the table are relative to.

        Raises:
            InputError: there is no such surface.
        """


PARTS: Registry[Part] = Registry(
    "cellcolor.parts",
    Part,  # type: ignore[type-abstract]
    {
        "spherical-cap": "cellcolor.frontend.parts.shapes:CapObject",
        "pipe": "cellcolor.frontend.parts.shapes:PipeObject",
        "rectangle": "cellcolor.frontend.parts.shapes:RectangleObject",
        "mesh": "cellcolor.frontend.parts.mesh_file:MeshObject",
    },
)
