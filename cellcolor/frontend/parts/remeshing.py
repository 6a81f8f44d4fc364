"""A mesh remeshed to edges of about one length, by gpytoolbox in a process of its own.

The method is Botsch and Kobbelt's ("A remeshing approach to multiresolution modeling", 2004): edges
are split, collapsed and flipped, and vertices are moved along the surface and projected back onto
it. Along sharp edges that are short or turn a corner, a triangle may lose its area, or fold back
onto the one beside it, or cross one with which it shares a corner. Such folds are repaired
locally: a vertex beside one is merged into a neighbor.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any, TypeVar, cast

import numpy as np
import trimesh

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.cleaning import borders, flat_faces, used
from cellcolor.frontend.parts.crossings import crossing_of, crossing_pairs
from cellcolor.frontend.parts.repairing import Change, Mending, Telling, counted, mended
from cellcolor.frontend.parts.surface import SHARP, Faces, refine
from cellcolor.frontend.sizes import MOST_VERTICES
from cellcolor.mesh.remesher import distances, remesh
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.processes import Limits, run_alone

_T = TypeVar("_T")

_MEMORY = 3072.0  # MB (2**20 bytes) that the remesher may take
_LONGEST = 4 / 3  # of the wanted length: edges of a border above that are halved first
_ROUNDS = 3  # of mending folds and what else is wrong; the second seldom finds more
_FEWEST = 10  # vertices; a mesh so coarse has lost its shape


@dataclass(frozen=True)
class Deviation:
    """The distances between two meshes, at vertices and centers of faces.

    Attributes:
        greatest, mean: from the old mesh to the new one.
        greatest_back, mean_back: from the new one to the old one.
    """

    greatest: float
    mean: float
    greatest_back: float
    mean_back: float


def expected_vertices(area: float, length: float) -> float:
    """About how many vertices a mesh of equilateral triangles has, two triangles for each."""
    return float(area / (np.sqrt(3) / 2 * length**2))


def length_for(area: float, vertices: float) -> float:
    """The edge length with which a mesh has about a given number of vertices."""
    return float(np.sqrt(area / (np.sqrt(3) / 2 * vertices)))


def remeshed(
    vertices: Array,
    faces: Faces,
    length: float,
    deadline: Deadline = NEVER,
    tell: Telling = lambda _: None,
) -> tuple[Array, Faces, list[Change], Deviation]:
    """A manifold mesh with edges of about one length; sharp edges stay, and so does the border.

    Vertices of the border keep their places; its edges are halved where they are longer than four
    thirds of the length, and not joined where they are shorter. Folds that the remeshing made
    are repaired, and the list says which changes that needed and which folds remain.

    Args:
        length: wanted, in the unit of the vertices.

    Raises:
        InputError: too many vertices would come of it, or too few; the library has failed, was out
            of memory, or has torn holes.
        ModuleNotFoundError: gpytoolbox is not installed.
    """
    mesh = TriangleMesh(vertices, faces)
    area = float(mesh.areas.sum())
    expected = expected_vertices(area, length)
    if not _FEWEST <= expected <= MOST_VERTICES:
        message = f"gives about {expected:,.0f} vertices, {_FEWEST} to {MOST_VERTICES:,} fit"
        raise InputError(None, "edge_length_m", message)
    if find_spec("gpytoolbox") is None:
        raise ModuleNotFoundError("No module named 'gpytoolbox'", name="gpytoolbox")
    if mesh.lengths[mesh.triangles_at == 1].max(initial=0.0) > _LONGEST * length:
        try:
            mesh, _ = refine(mesh, _LONGEST * length, deadline)
        except InputError as error:
            raise InputError(None, "edge_length_m", error.message) from error
    vertices, faces = mesh.points, mesh.corners
    kept = mesh.edges[mesh.sharp_edges(SHARP)]
    tell(f"remeshing to about {expected:,.0f} vertices")
    made = _asked(deadline, remesh, vertices, faces, length, kept)
    tell("mending folds")
    points, corners, changes = _mended(*made, fold_angle(mesh), length, deadline)
    if borders(TriangleMesh(points, corners)) > borders(mesh):
        message = "gpytoolbox tore holes into the mesh; shorter edges keep more of its shape"
        raise InputError(None, "edge_length_m", message)
    tell("measuring the deviation")
    deviation = Deviation(*_asked(deadline, distances, vertices, faces, points, corners))
    return points, corners, changes, deviation


def _mended(
    vertices: Array, faces: Faces, angle: float, length: float, deadline: Deadline
) -> tuple[Array, Faces, list[Change]]:
    """A remeshed mesh without folds as far as possible, and what that took."""
    taken = 0
    changes: list[Change] = []
    for _ in range(_ROUNDS):
        vertices, faces, gone = unfolded(vertices, faces, angle, length, deadline)
        taken += gone
        vertices, faces, more = mended(vertices, faces, Mending(0.0, 0.0), deadline)
        changes += more
        left = folds(vertices, faces, angle, deadline)
        if not left or not more:
            break
    if taken:
        changes.insert(0, Change(f"folds mended: {counted(taken, 'vertex')} drawn into neighbors"))
    if left:
        place = ", ".join(f"{x:.4g}" for x in vertices[left[0]].mean(axis=0))
        where = f"at ({place}) m" if len(left) == 1 else f"the first at ({place}) m"
        changes.append(Change(f"{count(len(left), 'fold')} left, {where}"))
    return vertices, faces, changes


def _asked(deadline: Deadline, function: Callable[..., _T], *arguments: Any) -> _T:
    """What a function of the remesher returns, called in a process of its own."""
    ended = run_alone(function, arguments, Limits(math.inf, _MEMORY), lambda: deadline.over)
    if ended.end == "stopped":
        deadline.check()
    if ended.end != "done":
        out = ended.end == "memory" or "bad_alloc" in ended.error
        why = "out of memory, 3 GiB" if out else ended.error
        raise InputError(None, "edge_length_m", f"gpytoolbox could not remesh it ({why})")
    return cast(_T, ended.value)


_LEAST, _MOST = np.radians(150.0), np.radians(175.0)
_DEGREES = np.radians(1.0)
_APART = 6  # corners of two faces that share none


def fold_angle(mesh: TriangleMesh) -> float:
    """The angle above which two faces count as folded, rad.

    It is larger than at any edge of this mesh, at least 150 and at most 175 degrees.
    """
    angles = np.arange(_LEAST, _MOST + _DEGREES / 2, _DEGREES)
    sharper = [len(mesh.sharp_edges(angle)) > 0 for angle in angles[:-1]]
    return float(angles[sharper.index(False) if False in sharper else -1])


def unfolded(
    vertices: Array, faces: Faces, angle: float, reach: float, deadline: Deadline = NEVER
) -> tuple[Array, Faces, int]:
    """A surface with fewer folds and flat faces, and how many vertices were removed.

    A vertex of a fold is drawn into a neighbor where that leaves fewer folds around, no edge of
    three faces, and no place of the border elsewhere. Of several ways the one is taken that leaves
    the vertex's place nearest to the surface. Folds that cannot be repaired in this way stay.

    Args:
        vertices: (n, 3).
        faces: (m, 3) of a manifold.
        angle: between the normals of two faces, rad; above it they are folded.
        reach: the vertex's place stays that near to the surface.
    """
    patch = _Patch(vertices, faces, angle, reach)
    gone = 0
    while True:
        before = gone
        for corners in folds(vertices, patch.faces(), angle, deadline):
            deadline.check()
            gone += patch.mend(corners.tolist())
        if gone == before:
            return *used(vertices, patch.faces()), gone


def folds(vertices: Array, faces: Faces, angle: float, deadline: Deadline = NEVER) -> list[Index]:
    """The vertices of each flat face, and of each pair of faces that are folded.

    Two are folded if they share an edge and turn by the angle, or share one corner and cross.
    """
    flat = flat_faces(vertices, faces)
    mesh = TriangleMesh(vertices, faces)
    pairs, normals = mesh.pairs[1] // 3, mesh.area_vectors
    turned = _turned(normals[pairs[:, 0]], normals[pairs[:, 1]], angle) & ~flat[pairs].any(axis=1)
    crossing = crossing_pairs(vertices, faces, deadline)
    near = [] if crossing is None else [np.unique(both) for both in faces[crossing]]
    return [
        *faces[flat],
        *map(np.unique, faces[pairs[turned]]),
        *(both for both in near if len(both) < _APART),
    ]


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
        mesh = TriangleMesh(vertices, faces)
        self.fixed = set(mesh.edges[mesh.triangles_at != 2].ravel().tolist())

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
        """How many of these faces are flat, edges between them folds, and pairs of them cross."""
        rows = np.array(faces)
        flat = flat_faces(self.vertices, rows)
        of_edge: dict[tuple[int, int], int] = {}
        beside = []
        for number, (a, b, c) in enumerate(faces):
            for edge in ((a, b), (b, c), (c, a)):
                twin = of_edge.get(edge[::-1])
                if twin is not None:
                    beside.append((twin, number))
                of_edge[edge] = number
        at = np.array(beside, dtype=np.int64).reshape(-1, 2)
        normals = TriangleMesh(self.vertices, rows).area_vectors
        turned = _turned(normals[at[:, 0]], normals[at[:, 1]], self.angle)
        places = self.vertices[rows]
        pairs = np.column_stack(np.triu_indices(len(rows), 1))
        crossing = crossing_of(self.vertices, rows, places.min(axis=1), places.max(axis=1), pairs)
        return int(flat.sum()) + int((turned & ~flat[at].any(axis=1)).sum()) + len(crossing)

    def _distance(self, vertex: int, faces: list[list[int]]) -> float:
        """How far the place of a vertex is from faces."""
        place = np.tile(self.vertices[vertex], (len(faces), 1))
        nearest = trimesh.triangles.closest_point(self.vertices[np.array(faces)], place)
        return float(np.nanmin(np.linalg.norm(nearest - place, axis=1)))
