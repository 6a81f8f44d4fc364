"""The surface to be covered: generated, or read from a mesh file; placed in the world."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.frontend.robot import Array
from cellcolor.frontend.scene import CapObject, MeshObject, Placement

__all__ = ["Surface", "disc_mesh", "load_mesh", "make_surface", "spherical_cap"]

Faces = NDArray[np.int64]


@dataclass(frozen=True)
class Surface:
    """A triangle mesh with outward unit normals at its vertices; faces ccw from outside, m."""

    vertices: Array
    faces: Faces
    normals: Array

    def placed(self, placement: Placement) -> Surface:
        """The same surface in the world."""
        rotation = rotation_from_rpy(*placement.rpy_rad)
        vertices = self.vertices @ rotation.T + np.array(placement.position_m)
        return Surface(vertices, self.faces, self.normals @ rotation.T)

    def vertex_areas(self) -> Array:
        """A third of the adjoining faces' areas, (n,), m^2; they add up to the whole."""
        third = np.linalg.norm(_face_normals(self.vertices, self.faces), axis=1) / 6
        areas = np.zeros(len(self.vertices))
        np.add.at(areas, self.faces, third[:, None])
        return areas

    def edges(self) -> Faces:
        """Every mesh edge once, (k, 2), smaller index first, in lexicographic order."""
        pairs = np.concatenate(
            [self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]]
        )
        return np.unique(np.sort(pairs, axis=1), axis=0)


def make_surface(spec: CapObject | MeshObject, base: Path) -> Surface:
    """The object of a scene in its own frame; mesh files are relative to the folder ``base``."""
    if isinstance(spec, MeshObject):
        return load_mesh(base / spec.file, spec.meters_per_unit)
    return spherical_cap(
        spec.radius_m, spec.half_angle_rad, spec.target_vertices, spec.jitter, spec.seed
    )


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation matrix of extrinsic x, y, z angles, as in URDF."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def disc_mesh(target: int, jitter: float, seed: int) -> tuple[Array, Faces]:
    """The unit disc as concentric rings of 6, 12, 18, ... vertices about a center.

    Args:
        target: wanted number of vertices; the nearest possible one is 1 + 3 k (k + 1).
        jitter: vertices are moved by at most this part of a ring's width, along the rim and
            (except on the rim) across it, so that borders do not run along mesh lines.
        seed: of the jitter.

    Returns:
        points (n, 2) and faces (m, 3), counter-clockwise.
    """
    rings = max(1, round((np.sqrt(1 + 4 * (target - 1) / 3) - 1) / 2))
    ring = np.repeat(np.arange(1, rings + 1), 6 * np.arange(1, rings + 1))
    place = np.concatenate([np.arange(6 * k) for k in range(1, rings + 1)])
    shift = np.random.default_rng(seed).uniform(-jitter, jitter, (len(ring), 2))
    shift[ring == rings, 0] = 0.0
    radius = (ring + shift[:, 0]) / rings
    # A ring's vertices are pi/3 ring widths apart, so this is a part of a ring width as well.
    angle = (place + shift[:, 1]) * np.pi / (3 * ring)
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    return np.vstack([[0.0, 0.0], points]), np.array(_disc_faces(rings), dtype=np.int64)


def _disc_faces(rings: int) -> list[tuple[int, int, int]]:
    def vertex(ring: int, place: int) -> int:
        return 0 if ring == 0 else 1 + 3 * ring * (ring - 1) + place % (6 * ring)

    faces = []
    for ring in range(1, rings + 1):
        for sector in range(6):
            outer, inner = sector * ring, sector * (ring - 1)
            for step in range(ring):
                a, b = vertex(ring, outer + step), vertex(ring, outer + step + 1)
                faces.append((a, b, vertex(ring - 1, inner + step)))
                if step + 1 < ring:
                    inside = vertex(ring - 1, inner + step), vertex(ring - 1, inner + step + 1)
                    faces.append((inside[0], b, inside[1]))
    return faces


def spherical_cap(
    radius: float, half_angle: float, target: int, jitter: float, seed: int
) -> Surface:
    """A cap of a sphere about +z, centered on the origin, with vertices of equal area.

    Args:
        radius: of the sphere, m.
        half_angle: between the axis and the rim, rad.
        target, jitter, seed: see :func:`disc_mesh`, which is mapped onto the cap keeping areas.
    """
    disc, faces = disc_mesh(target, jitter, seed)
    squared = (disc**2).sum(axis=1)
    height = 1 - squared * (1 - np.cos(half_angle))  # cosine of the polar angle
    with np.errstate(invalid="ignore", divide="ignore"):
        stretch = np.sqrt((1 - height**2) / squared)
    stretch[0] = 0.0
    normals = np.column_stack([disc * stretch[:, None], height])
    return Surface(radius * normals, faces, normals)


def load_mesh(file: Path, meters_per_unit: float) -> Surface:
    """A mesh file as it is: checked, never repaired.

    STL has no shared vertices, so there the corners with equal coordinates are one vertex.
    Normals are those of the adjoining faces, weighted with their angles.

    Raises:
        InputError: missing or unreadable file, no triangles, coordinates that are not finite,
            two vertices in one place, faces without area, vertices without faces, edges or
            vertices that are not manifold, inconsistent winding, a closed mesh inside out;
            names the element.
    """
    vertices, faces = _read_mesh(file)
    if not len(faces):
        raise InputError(str(file), "faces", "there are none")
    try:
        # The labelled surface's own rules, held here before any work is done.
        bare = LabelledSurface(file.name, (), vertices, faces, ((),) * len(vertices))
    except InputError as error:
        raise error.in_file(str(file)) from error
    _check_elements(file, vertices, faces)
    if len(bare.left_of) == 2 * len(
        np.unique(np.sort(np.array(list(bare.left_of)), axis=1), axis=0)
    ):
        corners = vertices[faces]
        if np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) < 0:
            raise InputError(str(file), "faces", "closed mesh inside out: its volume is negative")
    normals = _vertex_normals(vertices, faces)
    return Surface(vertices * meters_per_unit, faces, normals)


def _read_mesh(file: Path) -> tuple[Array, Faces]:
    if not file.is_file():
        raise InputError(str(file), None, "no such mesh file")
    if file.suffix.lower() not in (".stl", ".obj", ".ply"):
        raise InputError(str(file), None, "not a mesh format known here (STL, OBJ, PLY)")
    try:
        mesh = trimesh.load_mesh(file, process=False, maintain_order=True)
        vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except Exception as error:  # trimesh's readers raise whatever their parsers ran into
        raise InputError(str(file), None, f"trimesh cannot read it: {error!r}") from error
    if file.suffix.lower() == ".stl":
        vertices, index = np.unique(vertices, axis=0, return_inverse=True)
        faces = index.reshape(-1)[faces]
    return vertices, faces


def _check_elements(file: Path, vertices: Array, faces: Faces) -> None:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    if not used.all():
        raise InputError(str(file), f"vertices[{np.argmin(used)}]", "belongs to no face")
    _, first, index = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    twin = first[index.reshape(-1)] != np.arange(len(vertices))
    if twin.any():
        vertex = int(np.argmax(twin))
        other = int(first[index.reshape(-1)[vertex]])
        raise InputError(str(file), f"vertices[{vertex}]", f"in one place with vertex {other}")
    double_area = np.linalg.norm(_face_normals(vertices, faces), axis=1)
    longest = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2).max(1)
    flat = double_area <= 1e-9 * longest**2
    if flat.any():
        raise InputError(str(file), f"faces[{np.argmax(flat)}]", "has no area")


def _face_normals(vertices: Array, faces: Faces) -> Array:
    """Normals (m, 3) with twice the face's area as their length."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normals: Array = np.cross(b - a, c - a)
    return normals


def _vertex_normals(vertices: Array, faces: Faces) -> Array:
    corners = vertices[faces]
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    cosine = (
        (ahead * behind).sum(2) / np.linalg.norm(ahead, axis=2) / np.linalg.norm(behind, axis=2)
    )
    angles = np.arccos(np.clip(cosine, -1, 1))
    unit = _face_normals(vertices, faces)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    normals = np.zeros_like(vertices)
    np.add.at(normals, faces, angles[:, :, None] * unit[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals
