"""How the object lies to the robot: its size, its distance, and which of its sides is outside.

What a wrong unit, a wrong placement or a mesh wound the wrong way would change.
"""

from __future__ import annotations

from dataclasses import dataclass

import fcl
import numpy as np
import trimesh

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.contact.fcl_bodies import frames_along, mesh_model
from cellcolor.frontend.parts.surface import Faces, Surface
from cellcolor.mesh.triangle_mesh import TriangleMesh

_POINTS = 500  # of the surface that are looked at
_SHORT = 1e-3  # by this part of its length a line of sight ends before the surface
_THIN = 1e-7  # m; radius of a line of sight


@dataclass(frozen=True)
class Survey:
    """Where the object is.

    Attributes:
        size_m: of its bounding box along the axes of the world.
        distance_m: from the origin of the robot's base to the nearest point of it.
        from_behind: of an open mesh, the share (0 to 1) of what can be seen of it that shows its
            back only; 0 for a closed one and for what cannot be seen.
    """

    size_m: tuple[float, ...]
    distance_m: float
    from_behind: float

    def __str__(self) -> str:
        size = " x ".join(_meters(side) for side in self.size_m)
        return f"{size} m, nearest point {_meters(self.distance_m)} m from the robot's base"

    @property
    def seen_from_behind(self) -> bool:
        """Whether the faces are probably wound the wrong way."""
        return self.from_behind > 0.5

    @property
    def warnings(self) -> tuple[str, ...]:
        """Likely mistakes, one sentence each."""
        if not self.seen_from_behind:
            return ()
        return (
            f"the robot sees {100 * self.from_behind:.0f} % of the object only from behind: if its "
            "faces are wound clockwise as seen from outside, the tool comes from the wrong side",
        )


def survey(surface: Surface, viewpoints: Array) -> Survey:
    """Measure the placed surface, seen from some points (v, 3) in the world, m."""
    vertices, faces, mesh = surface.vertices, surface.faces, surface.mesh
    nearest = trimesh.triangles.closest_point(vertices[faces], np.zeros((len(faces), 3)))
    return Survey(
        tuple((vertices.max(axis=0) - vertices.min(axis=0)).tolist()),
        float(np.linalg.norm(nearest, axis=1).min()),
        _from_behind(mesh, viewpoints) if mesh.border.any() else 0.0,
    )


def _from_behind(mesh: TriangleMesh, viewpoints: Array) -> float:
    """Of the points that are seen from anywhere, the share whose front is not seen."""
    vertices, faces = mesh.points, mesh.corners
    points, face = _spread(mesh)
    shape = fcl.CollisionObject(mesh_model(vertices, faces), fcl.Transform())
    normals = mesh.area_vectors[face]
    seen, front = np.zeros((2, len(points)), dtype=bool)
    for eye in viewpoints:
        visible = _visible(shape, eye, points)
        seen |= visible
        front |= visible & (np.einsum("ij,ij->i", normals, eye - points) > 0)
    return float((seen & ~front).sum() / max(seen.sum(), 1))


def _spread(mesh: TriangleMesh) -> tuple[Array, Faces]:
    """Points (k, 3) all over the surface, each for as much area, and the face (k,) of each."""
    corners, areas = mesh.points[mesh.corners], mesh.areas
    wanted = (np.arange(_POINTS) + 0.5) / _POINTS * areas.sum()
    face = np.minimum(np.searchsorted(np.cumsum(areas), wanted), len(areas) - 1)
    u, v = np.random.default_rng(0).random((2, _POINTS))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    weights = np.stack([1 - u - v, u, v], axis=1)
    return np.einsum("ij,ijk->ik", weights, corners[face]), face


def _visible(shape: fcl.CollisionObject, eye: Array, points: Array) -> Mask:
    """Whether nothing of the shape lies before points (k, 3) of it, (k,)."""
    sights = (1 - _SHORT) * (points - eye)
    turns, middles = frames_along(eye, eye + sights)
    visible = np.zeros(len(points), dtype=bool)
    for row, length in enumerate(np.linalg.norm(sights, axis=1).tolist()):
        if length:
            capsule, place = fcl.Capsule(_THIN, length), fcl.Transform(turns[row], middles[row])
            line, request = fcl.CollisionObject(capsule, place), fcl.CollisionRequest()
            visible[row] = not fcl.collide(shape, line, request, fcl.CollisionResult())
    return visible


def _meters(length: float) -> str:
    """Three digits, whether it is 0.7 mm or 70 m."""
    return f"{length:.0f}" if length >= 100 else f"{length:.3g}"
