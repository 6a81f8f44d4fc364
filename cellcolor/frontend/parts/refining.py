"""Surfaces with shorter mesh edges: halved until none is too long, or bisected where asked."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.frontend.sizes import check_refinement, check_vertices
from cellcolor.mesh.dividing import bisected_corners, halved, with_longest_sides
from cellcolor.mesh.triangle_mesh import TriangleMesh

__all__ = ["bisected", "refine"]


def refine(mesh: TriangleMesh, longest: float, deadline: Deadline = NEVER) -> TriangleMesh:
    """Halve edges until none is longer than ``longest``, in the unit of the mesh.

    The mesh stays the same surface and conforming: an edge is halved for both its faces. The
    first points are the given ones.

    Raises:
        InputError: that would be too many vertices; nothing was made yet.
        OutOfTime: the deadline came first.
    """
    check_refinement(len(mesh.points), mesh.lengths, float(mesh.areas.sum()), longest)
    while True:
        deadline.check()
        marked = mesh.lengths > longest
        if not marked.any():
            return mesh
        check_vertices(len(mesh.points) + int(marked.sum()), "max_edge_m")
        mesh, _ = halved(mesh, marked)


def bisected(surface: Surface, marked: Mask, field: str) -> Surface:
    """A surface with some mesh edges parted in the middle, and others where that is needed.

    New vertices come after the given ones. Their normals are halfway between those of the ends.

    Args:
        surface: the surface.
        marked: (k,) which of its edges, in the order of
            :meth:`~cellcolor.frontend.parts.surface.Surface.edges`.
        field: the key that asks for it.

    Raises:
        InputError: there would be too many vertices; names the key.
    """
    mesh = surface.mesh
    marked = with_longest_sides(mesh, marked)
    parted = mesh.edges[marked]
    check_vertices(len(mesh.points) + len(parted), field)
    points, directions = along_edges(surface, parted, np.full(len(parted), 0.5))
    return Surface(
        np.concatenate([mesh.points, points]),
        bisected_corners(mesh, marked),
        np.concatenate([surface.normals, -directions]),
        surface.faceted,
    )
