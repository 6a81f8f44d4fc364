"""The surface to be covered: a triangle mesh with normals at its vertices, and its refinement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, angles_between
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.placement import Placement, rotation_from_rpy
from cellcolor.frontend.sizes import check_refinement, check_vertices
from cellcolor.mesh.dividing import halved
from cellcolor.mesh.triangle_mesh import TriangleMesh

Faces = NDArray[np.int64]

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

    def vertex_areas(self) -> Array:
        """(n,) a third of the area of the adjoining faces, m^2; the sum is the whole area."""
        return self.mesh.vertex_areas

    def edges(self) -> Faces:
        """Every mesh edge once, (k, 2), smaller index first, in lexicographic order."""
        return self.mesh.edges

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
    check_refinement(len(mesh.points), mesh.lengths, float(mesh.areas.sum()), longest)
    lies_in = np.arange(len(mesh.corners))
    while True:
        deadline.check()
        marked = mesh.lengths > longest
        if not marked.any():
            return mesh, lies_in
        check_vertices(len(mesh.points) + int(marked.sum()), "max_edge_m")
        mesh, of = halved(mesh, marked)
        lies_in = lies_in[of]
