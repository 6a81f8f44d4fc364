"""Folds that a remesher leaves, mended where they are: a vertex is drawn into a neighbor.

A fold is a face without area, two neighbors that lie back to back, or two faces that share a corner
and cross.
"""

from __future__ import annotations

import igl
import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.mending import (
    crossing_pairs,
    flat_faces,
    repeated_corners,
    repeated_faces,
    used,
)
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

_LEAST, _MOST = np.radians(150.0), np.radians(175.0)
_MORE = np.radians(0.1)
_APART = 6  # corners of two faces that share none


def fold_angle(mesh: TriangleMesh) -> float:
    """The angle above which two neighbors count as folded, rad.

    It is larger than at any edge of this mesh, at least 150 and at most 175 degrees.
    """
    first, second = mesh.triangle_normals[mesh.pairs[1] // 3].transpose(1, 0, 2)
    cosine = np.einsum("ij,ij->i", first, second).min(initial=1.0)
    return float(np.clip(np.arccos(max(cosine, -1.0)) + _MORE, _LEAST, _MOST))


def folds(vertices: Array, faces: Faces, angle: float) -> list[Index]:
    """The vertices of each fold.

    Args:
        angle: between the normals of two neighbors, rad; above it they are folded.
    """
    flat, pairs = _faults(vertices, faces, angle)
    together = [np.unique(both) for both in faces[pairs]]
    return [*faces[flat], *(corners for corners in together if len(corners) < _APART)]


def _faults(vertices: Array, faces: Faces, angle: float) -> tuple[Index, Index]:
    """The flat faces (k,), and the pairs (p, 2) of faces that are folded or cross anywhere."""
    mesh, flat = TriangleMesh(vertices, faces), flat_faces(vertices, faces)
    sides = mesh.pairs[1][np.isin(mesh.pairs[0], mesh.sharp_edges(angle))] // 3
    turned = sides[~flat[sides].any(axis=1)]
    return np.flatnonzero(flat), np.concatenate([turned, crossing_pairs(vertices, faces)])


def unfolded(
    vertices: Array, faces: Faces, angle: float, reach: float, deadline: Deadline = NEVER
) -> tuple[Array, Faces, int]:
    """A surface with fewer folds, and how many vertices were removed.

    A vertex is drawn into a neighbor where that leaves fewer folds around, no edge of three faces,
    and no place of the border elsewhere. Of several ways the one is taken that leaves the vertex's
    place nearest to the surface. Folds that cannot be repaired in this way stay.

    Args:
        faces: (m, 3) of a manifold.
        angle: see :func:`folds`.
        reach: a vertex's place stays that near to the surface.
    """
    mesh, gone = TriangleMesh(vertices, faces), 0
    fixed = np.zeros(len(vertices), dtype=bool)
    fixed[mesh.edges[mesh.triangles_at != 2]] = True
    while True:
        before = gone
        for corners in folds(vertices, faces, angle):
            deadline.check()
            was, best = faces, reach
            for vertex in corners[~fixed[corners]].tolist():
                faces, best = _drawn_in(vertices, was, vertex, angle, faces, best)
            gone += faces is not was
        if gone == before:
            return *used(vertices, faces), gone


def _drawn_in(
    vertices: Array, faces: Faces, vertex: int, angle: float, otherwise: Faces, best: float
) -> tuple[Faces, float]:
    """The faces with a vertex drawn into a neighbor, and how far its place is from them then.

    Args:
        otherwise: what is returned if no way leaves it nearer than ``best``.
    """
    ring = _ring(faces, vertex)
    near = np.asarray(np.isin(faces, [*ring, vertex]).any(axis=1))
    here = faces[near]
    cost = sum(map(len, _faults(vertices, here, angle)))
    for other in ring.tolist():
        if len(np.intersect1d(ring, _ring(faces, other))) != 2:
            continue
        drawn = np.where(here == vertex, other, here)
        kept = ~repeated_corners(drawn)
        moved = drawn[kept & (here == vertex).any(axis=1)]
        drawn = drawn[kept]
        if repeated_faces(drawn).any():
            continue
        if sum(map(len, _faults(vertices, drawn, angle))) >= cost:
            continue
        squared = igl.point_mesh_squared_distance(vertices[[vertex]], vertices, moved)[0]
        if np.sqrt(squared.max()) < best:
            best = float(np.sqrt(squared.max()))
            otherwise = np.concatenate([faces[~near], drawn])
    return otherwise, best


def _ring(faces: Faces, vertex: int) -> Index:
    """The neighbors of a vertex; none of one that is gone."""
    star = faces[(faces == vertex).any(axis=1)]
    return np.setdiff1d(star, [vertex])
