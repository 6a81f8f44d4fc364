"""Meshes made usable on request: refined to a maximum edge length, or repaired."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.cleaning import (
    merged,
    repeated_corners,
    repeated_faces,
    used,
    without_flat,
)
from cellcolor.frontend.parts.surface import Faces, every_edge, face_normals
from cellcolor.frontend.parts.topology import edge_table
from cellcolor.frontend.parts.winding import against_the_others, inside_out, turned
from cellcolor.frontend.sizes import check_refinement, check_vertices

__all__ = ["refine", "repair"]


def refine(
    vertices: Array, faces: Faces, longest: float, deadline: Deadline = NEVER
) -> tuple[Array, Faces]:
    """Halve edges until none is longer than ``longest``, in the unit of the vertices.

    The mesh stays the same surface and conforming: an edge is halved for both its faces. The
    first vertices are the given ones.

    Raises:
        InputError: that would be too many vertices; nothing was made yet.
        OutOfTime: the deadline came first.
    """
    i, j = every_edge(faces).T
    lengths = np.linalg.norm(vertices[i] - vertices[j], axis=1)
    area = float(np.linalg.norm(face_normals(vertices, faces), axis=1).sum()) / 2
    check_refinement(len(vertices), lengths, area, longest)
    while True:
        deadline.check()
        sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)  # (m, 3, 2): ab, bc, ca
        lengths = np.linalg.norm(vertices[sides[:, :, 0]] - vertices[sides[:, :, 1]], axis=2)
        split = lengths > longest
        if not split.any():
            return vertices, faces
        pairs, number = np.unique(np.sort(sides[split], axis=1), axis=0, return_inverse=True)
        check_vertices(len(vertices) + len(pairs), "max_edge_m")
        middle = np.full(faces.shape, -1, dtype=np.int64)
        middle[split] = len(vertices) + number.reshape(-1)
        vertices = np.vstack([vertices, vertices[pairs].mean(axis=1)])
        faces = _divided(faces, middle)


def _divided(faces: Faces, middle: Faces) -> Faces:
    """Faces cut along the middles (m, 3) of their sides ab, bc, ca; -1 where there is none."""
    count = (middle >= 0).sum(axis=1)
    # Turn each face so that a single halved side comes first, and a single whole one last.
    first = np.where(count == 1, np.argmax(middle >= 0, axis=1), 0)
    first = np.where(count == 2, (np.argmin(middle, axis=1) + 1) % 3, first)
    order = (first[:, None] + np.arange(3)) % 3
    (a, b, c), (ab, bc, ca) = (np.take_along_axis(x, order, axis=1).T for x in (faces, middle))
    patterns = {
        0: [(a, b, c)],
        1: [(a, ab, c), (ab, b, c)],
        2: [(ab, b, bc), (a, ab, bc), (a, bc, c)],
        3: [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)],
    }
    return np.concatenate(
        [
            np.column_stack(triangle)[count == halved]
            for halved, triangles in patterns.items()
            for triangle in triangles
        ]
    )


def repair(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Merge vertices in one place, drop useless faces and vertices, make the winding consistent.

    A closed mesh is turned outside out. Of an open one the side that most faces have is kept;
    which side is the outside nobody but its owner knows. What is still wrong afterwards (edges
    that are not manifold, holes) stays.
    """
    vertices, faces = merged(vertices, faces)
    faces = faces[~repeated_corners(faces)]
    faces = faces[~repeated_faces(faces)]
    vertices, faces = used(vertices, without_flat(vertices, faces))
    faces = turned(faces, against_the_others(faces, edge_table(faces))[0])
    return vertices, turned(faces, inside_out(vertices, faces))
