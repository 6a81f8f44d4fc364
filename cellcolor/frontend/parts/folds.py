"""Folds of a remeshed surface mended where they are: a vertex beside one is drawn into a neighbor.

Remeshing slides vertices along sharp edges. Where these are short or turn a corner, a triangle may
end without area, or laid back onto the one beside it.
"""

from __future__ import annotations

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.cleaning import flat_faces, used
from cellcolor.frontend.parts.sharp import sharp_edges
from cellcolor.frontend.parts.surface import Faces, face_normals
from cellcolor.frontend.parts.topology import edge_table

__all__ = ["fold_angle", "folds", "unfolded"]

_LEAST, _MOST = np.radians(150.0), np.radians(175.0)
_DEGREES = np.radians(1.0)


def fold_angle(vertices: Array, faces: Faces) -> float:
    """From where on two faces count as folded, rad.

    That is what no edge of this mesh has, from 150 degrees up, and 175 at most.
    """
    angles = np.arange(_LEAST, _MOST + _DEGREES / 2, _DEGREES)
    sharper = [len(sharp_edges(vertices, faces, angle)) > 0 for angle in angles[:-1]]
    return float(angles[sharper.index(False) if False in sharper else -1])


def unfolded(
    vertices: Array, faces: Faces, angle: float, reach: float, deadline: Deadline = NEVER
) -> tuple[Array, Faces, int]:
    """A surface with fewer folds and flat faces, and how many vertices that took.

    A vertex of a fold is drawn into a neighbor where that leaves fewer folds around, no edge of
    three faces, and no place of the border elsewhere. Of several ways the one is taken that leaves
    the vertex's place nearest to the surface. What cannot be mended so stays.

    Args:
        vertices: (n, 3).
        faces: (m, 3) of a manifold.
        angle: between the normals of two faces, rad, from which on they are folded.
        reach: the vertex's place stays that near to the surface.
        deadline: when to give up.

    Raises:
        OutOfTime: the deadline came first.
    """
    patch = _Patch(vertices, faces, angle, reach)
    gone = 0
    while True:
        before = gone
        for corners in folds(vertices, patch.faces(), angle):
            deadline.check()
            gone += patch.mend(corners.tolist())
        if gone == before:
            return *used(vertices, patch.faces()), gone


def folds(vertices: Array, faces: Faces, angle: float) -> list[Index]:
    """The vertices of each flat face, and of each pair of faces that are folded."""
    flat = flat_faces(vertices, faces)
    table = edge_table(faces)
    _, sides = table.pairs()
    pairs = sides // 3
    normals = face_normals(vertices, faces)
    turned = _turned(normals[pairs[:, 0]], normals[pairs[:, 1]], angle) & ~flat[pairs].any(axis=1)
    return [*faces[flat], *map(np.unique, faces[pairs[turned]])]


def _turned(first: Array, second: Array, angle: float) -> Mask:
    """Whether normals (k, 3) of any length are so far from each other."""
    dot = np.einsum("ij,ij->i", first, second)
    return np.asarray(
        dot < np.cos(angle) * np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    )


class _Patch:
    """Faces that change a few at a time."""

    def __init__(self, vertices: Array, faces: Faces, angle: float, reach: float) -> None:
        self.vertices, self.angle, self.reach = vertices, angle, reach
        self.corners = dict(enumerate(faces.tolist()))
        self.faces_of: list[set[int]] = [set() for _ in range(len(vertices))]
        for face, corners in self.corners.items():
            for corner in corners:
                self.faces_of[corner].add(face)
        table = edge_table(faces)
        self.fixed = set(table.ends[table.count != 2].ravel().tolist())

    def faces(self) -> Faces:
        return np.array(list(self.corners.values()), dtype=np.int64).reshape(-1, 3)

    def mend(self, corners: list[int]) -> bool:
        """Draw one of these vertices into a neighbor, if one may be."""
        best = None
        for vertex in corners:
            if vertex in self.fixed or not self.faces_of[vertex]:
                continue
            star = self.faces_of[vertex]
            ring = self._neighbors(vertex)
            around = set().union(*(self.faces_of[other] for other in ring))
            outside = [self.corners[face] for face in around - star]
            before = self._cost([*outside, *(self.corners[face] for face in star)])
            for other in ring:
                new = self._drawn(vertex, other)
                if new is None or self._cost([*outside, *new]) >= before:
                    continue
                distance = self._distance(vertex, new)
                if distance <= self.reach and (best is None or distance < best[0]):
                    best = distance, vertex, other
        if best is not None:
            self._draw(*best[1:])
        return best is not None

    def _neighbors(self, vertex: int) -> list[int]:
        found = {corner for face in self.faces_of[vertex] for corner in self.corners[face]}
        return sorted(found - {vertex})

    def _drawn(self, vertex: int, other: int) -> list[list[int]] | None:
        """What becomes of a vertex's faces if it goes where a neighbor is; None: it may not."""
        common = set(self._neighbors(vertex)) & set(self._neighbors(other))
        if len(common) != 2:
            return None
        new = [
            [other if corner == vertex else corner for corner in self.corners[face]]
            for face in self.faces_of[vertex] - self.faces_of[other]
        ]
        there = {frozenset(self.corners[face]) for face in self.faces_of[other]}
        return None if not new or any(frozenset(face) in there for face in new) else new

    def _draw(self, vertex: int, other: int) -> None:
        for face in list(self.faces_of[vertex]):
            corners = self.corners[face]
            if other in corners:
                del self.corners[face]
                for corner in corners:
                    self.faces_of[corner].discard(face)
            else:
                self.corners[face] = [other if corner == vertex else corner for corner in corners]
                self.faces_of[other].add(face)
        self.faces_of[vertex] = set()

    def _cost(self, faces: list[list[int]]) -> int:
        """How many of these faces are flat, and edges between them folds."""
        rows = np.array(faces)
        flat = flat_faces(self.vertices, rows)
        of_edge: dict[tuple[int, int], int] = {}
        pairs = []
        for number, (a, b, c) in enumerate(faces):
            for edge in ((a, b), (b, c), (c, a)):
                twin = of_edge.get(edge[::-1])
                if twin is not None:
                    pairs.append((twin, number))
                of_edge[edge] = number
        at = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        normals = face_normals(self.vertices, rows)
        turned = _turned(normals[at[:, 0]], normals[at[:, 1]], self.angle)
        return int(flat.sum()) + int((turned & ~flat[at].any(axis=1)).sum())

    def _distance(self, vertex: int, faces: list[list[int]]) -> float:
        """How far the place of a vertex is from faces."""
        place = np.tile(self.vertices[vertex], (len(faces), 1))
        nearest = trimesh.triangles.closest_point(self.vertices[np.array(faces)], place)
        return float(np.nanmin(np.linalg.norm(nearest - place, axis=1)))
