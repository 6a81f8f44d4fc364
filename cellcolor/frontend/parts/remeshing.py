"""A mesh remeshed to edges of about one length, by gpytoolbox in a process of its own.

The method is Botsch and Kobbelt's ("A remeshing approach to multiresolution modeling", 2004): edges
are split, collapsed and flipped, and vertices are moved along the surface and projected back onto
it. The library is compiled, cannot be interrupted and crashes on some meshes; a process can be
ended.

Along sharp edges that are short or turn a corner it leaves folds: faces without area, neighbors
that lie back to back, faces that share a corner and cross. There a vertex is drawn into a neighbor.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import igl
import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.mending import (
    border_groups,
    crossing_pairs,
    flat_faces,
    repeated_faces,
    used,
)
from cellcolor.frontend.parts.surface import MOST_VERTICES, SHARP, Faces, refine
from cellcolor.mesh.triangle_mesh import TriangleMesh, repeated_corners
from cellcolor.processes import run_alone

_MEMORY = 3072.0  # MB (2**20 bytes) that the remesher may take
_ITERATIONS = 10
_LONGEST = 4 / 3  # of the wanted length: edges of a border above that are halved first
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

    def __str__(self) -> str:
        return (
            f"the new mesh is at most {1e3 * self.greatest:.3g} mm from the old one, "
            f"{1e3 * self.mean:.3g} mm in the mean; back {1e3 * self.greatest_back:.3g} and "
            f"{1e3 * self.mean_back:.3g} mm (vertices and middles of faces)"
        )


def length_for(area: float, vertices: float) -> float:
    """The edge length with which a mesh has about so many vertices, if all triangles are equal."""
    return float(np.sqrt(area / (np.sqrt(3) / 2 * vertices)))


def remeshed(
    vertices: Array,
    faces: Faces,
    length: float,
    deadline: Deadline = NEVER,
    tell: Callable[[str], None] = lambda _: None,
) -> tuple[Array, Faces, Deviation]:
    """A manifold mesh with edges of about one length; sharp edges stay, and so does the border.

    Vertices of the border keep their places; its edges are halved where they are longer than four
    thirds of the length, and not joined where they are shorter.

    Args:
        length: wanted, in the unit of the vertices.

    Raises:
        InputError: too many vertices would come of it, or too few; the library has failed, was out
            of memory, or has torn holes.
        ModuleNotFoundError: gpytoolbox is not installed.
    """
    mesh = TriangleMesh(vertices, faces)
    expected = float(mesh.areas.sum() / (np.sqrt(3) / 2 * length**2))
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
    tell(f"remeshing to about {expected:,.0f} vertices")
    kept = mesh.edges[mesh.sharp_edges(SHARP)]
    arguments = mesh.points, mesh.corners, length, kept
    ended = run_alone(_remesh, arguments, math.inf, _MEMORY, lambda: deadline.over)
    if ended.end == "stopped":
        deadline.check()
    if ended.end != "done":
        out = ended.end == "memory" or "bad_alloc" in ended.error
        why = "out of memory, 3 GiB" if out else ended.error
        raise InputError(None, "edge_length_m", f"gpytoolbox could not remesh it ({why})")
    tell("mending folds")
    points, corners = ended.value
    points, corners, _ = unfolded(points, corners, fold_angle(mesh), length, deadline)
    made = TriangleMesh(points, corners)
    if border_groups(made)[1].max(initial=-1) > border_groups(mesh)[1].max(initial=-1):
        message = "gpytoolbox tore holes into the mesh; shorter edges keep more of its shape"
        raise InputError(None, "edge_length_m", message)
    tell("measuring the deviation")
    return made.points, made.corners, Deviation(*_apart(mesh, made), *_apart(made, mesh))


def _remesh(vertices: Array, faces: Index, length: float, kept: Index) -> tuple[Array, Index]:
    """A mesh with edges of about a length; the edges ``kept`` (k, 2) stay."""
    from gpytoolbox import remesh_botsch

    points, corners = remesh_botsch(
        vertices, faces.astype(np.int32), _ITERATIONS, length, True,
        feature_edges=kept.astype(np.int32),
    )  # fmt: skip
    return points, corners.astype(np.int64)


def _apart(mesh: TriangleMesh, other: TriangleMesh) -> tuple[float, float]:
    """The greatest and the mean distance of a mesh from another one."""
    asked = np.concatenate([mesh.points, mesh.points[mesh.corners].mean(axis=1)])
    squared = igl.point_mesh_squared_distance(asked, other.points, other.corners)[0]
    distance = np.sqrt(np.maximum(squared, 0.0))
    return float(distance.max()), float(distance.mean())


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
