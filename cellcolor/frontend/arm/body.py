"""Collision shapes as plain numbers, and the bodies of arm and tool on the joints that carry them.

Each engine makes of a shape what it works with.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Literal

import igl
import numpy as np
import pinocchio as pin
import trimesh
from scipy.spatial import ConvexHull, QhullError

from cellcolor.arrays import Array, Index
from cellcolor.errors import InputError
from cellcolor.frontend.arm.link_mesh import find_mesh, load_link_mesh
from cellcolor.frontend.arm.urdf import LinkShape, Urdf
from cellcolor.frontend.setup import MeshCollision, RobotFiles
from cellcolor.mesh.triangle_mesh import grouped

Kind = Literal[
    "box", "sphere", "cylinder", "capsule", "cone", "half-space", "cells", "hull", "mesh"
]

_MESHES: dict[str, Callable[..., trimesh.Trimesh]] = {
    "box": lambda *size: trimesh.creation.box(size),
    "sphere": partial(trimesh.creation.icosphere, 2),
    "cylinder": partial(trimesh.creation.cylinder, sections=20),
    "cone": partial(trimesh.creation.cone, sections=20),
    "capsule": lambda radius, length: trimesh.creation.capsule(length, radius, count=[20, 20]),
}
"""Filled shapes by their sizes in m, anywhere along z."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape and where it is. All but a mesh are filled.

    Attributes:
        kind: a cylinder, capsule or cone is about its own z axis, in the middle of its length; a
            half space is below its own plane z = 0; ``cells`` are equal cubes.
        sizes: in m; three sides of a box, the radius of a sphere, radius and length of what has an
            axis (a capsule's without its round ends), the side of a cell.
        vertices: (n, 3) of a hull or a mesh, m; of cells the corner with the lowest coordinates.
        faces: (m, 3) of a hull or a mesh, counter-clockwise seen from outside.
        rotation, origin: (3, 3), and (3,) in m, from its own frame to that of what carries it.
        made: what engines have made of it, by their names; the same shape elsewhere shares it.
    """

    kind: Kind
    sizes: tuple[float, ...] = ()
    vertices: Array = field(default_factory=lambda: np.empty((0, 3)))
    faces: Index = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    origin: Array = field(default_factory=lambda: np.zeros(3))
    made: dict[str, Any] = field(default_factory=dict, repr=False)

    def moved(self, rotation: Array, origin: Array) -> Shape:
        """The same shape, turned and then moved."""
        turned, there = rotation @ self.rotation, rotation @ self.origin + origin
        return replace(self, rotation=turned, origin=there)

    def heights(self, points: Array) -> Array:
        """How far points (..., 3) are above the plane of a half space, (...,), m."""
        return np.asarray((points - self.origin) @ self.rotation[:, 2])

    @cached_property
    def points(self) -> Array:
        """(k, 3) one of each part that hangs together, in its own frame; none of a half space.

        Of cells these are the middles of all.
        """
        if self.kind == "cells":
            return np.asarray(self.vertices + self.sizes[0] / 2)
        if self.kind in ("hull", "mesh"):
            return one_of_each_part(self.vertices, self.faces)
        return np.zeros((0 if self.kind == "half-space" else 1, 3))

    @cached_property
    def corners(self) -> Array:
        """(8, 3) of a box around a hull or a mesh: none of its points moves farther than these.

        The first one's neighbors along the edges have the numbers 1, 2 and 4.
        """
        to_box, extents = trimesh.bounds.oriented_bounds(self.vertices)
        signs = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        from_box = np.linalg.inv(to_box)
        return np.asarray((signs * extents) @ from_box[:3, :3].T + from_box[:3, 3])

    def shell(self) -> tuple[Array, Index]:
        """Points (k, 3) in m and triangles (t, 3) of its surface, curved faces as many flat ones.

        They are in the frame of what carries it. A half space has none, and cells have no such.
        """
        points, faces = self.vertices, self.faces
        if self.kind in _MESHES:
            mesh = _MESHES[self.kind](*self.sizes)
            points = mesh.vertices - mesh.bounds.mean(axis=0)
            faces = np.array(mesh.faces, dtype=np.int64)
        return points @ self.rotation.T + self.origin, faces


def one_of_each_part(vertices: Array, faces: Index) -> Array:
    """A vertex (parts, 3) of each part of a mesh whose faces hang together."""
    part = grouped(len(vertices), np.concatenate([faces[:, :2], faces[:, 1:]]))
    used = np.unique(faces)
    return np.asarray(vertices[used[np.unique(part[used], return_index=True)[1]]])


def convex_hull(points: Array) -> Shape | None:
    """The convex hull of points (n, 3); None if they lie in a plane."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    kept, faces = np.unique(faces, return_inverse=True)
    return Shape("hull", vertices=points[kept], faces=faces.reshape(-1, 3))


_SAME = 1e-6  # m; a sphere's center and a cylinder's end nearer than this are one point


@dataclass(frozen=True)
class Body:
    """A collision shape: all points within ``radius`` of a segment, or a flat-ended cylinder.

    ``start`` and ``end`` (3,) in m are in the frame of ``joint`` (0 is the world, the
    others are the frames behind the joints). A sphere is a capsule whose ends coincide.

    With a ``solid``, in the frame of the joint, the body is that, and the capsule is around it.
    """

    link: str
    joint: int
    start: Array
    end: Array
    radius: float
    flat: bool
    solid: Shape | None = None

    @cached_property
    def length(self) -> float:
        """Distance between the ends in m."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def outline(self) -> Array:
        """The ends (2, 3) of its axis, or the corners (8, 3) around a solid, m.

        No point of the axis or the solid moves farther than one of these: its displacement is a
        mean of theirs.
        """
        return np.array([self.start, self.end]) if self.solid is None else self.solid.corners

    @cached_property
    def shape(self) -> Shape:
        """The shape in the frame of the joint."""
        if self.solid is not None:
            return self.solid
        middle = (self.start + self.end) / 2
        if not self.length:
            return Shape("sphere", (self.radius,), origin=middle)
        turn = trimesh.geometry.align_vectors((0, 0, 1), self.end - self.start)[:3, :3]
        kind: Kind = "cylinder" if self.flat else "capsule"
        return Shape(kind, (self.radius, self.length), rotation=turn, origin=middle)


_SAMPLES = 5_000  # of a hull's surface
_FAR = 0.02  # m; a hull that is farther off its mesh is warned of


@dataclass(frozen=True, kw_only=True)
class MeshBody(Body):
    """What collides in the place of a link's mesh.

    Attributes:
        chosen: hull or exact.
        vertices, faces: the mesh, in the frame of the joint that carries it, m.
    """

    file: Path
    chosen: MeshCollision
    vertices: Array
    faces: Index

    @cached_property
    def off_m(self) -> float:
        """How far the farthest of many points on the hull is from the mesh; 0 of the mesh."""
        if self.chosen == "exact":
            return 0.0
        surface = trimesh.Trimesh(self.shape.vertices, self.shape.faces, process=False)
        points, _ = trimesh.sample.sample_surface(surface, _SAMPLES, seed=0)
        squares = igl.point_mesh_squared_distance(points, self.vertices, self.faces)[0]
        return math.sqrt(squares.max())

    @property
    def warning(self) -> str | None:
        """For a hull that is far off its mesh: what to choose instead."""
        if self.off_m <= _FAR:
            return None
        return (
            f"{self.link!r}: the convex hull of {self.file.name} is {self._millimeters} mm off "
            "the mesh, and fills what is hollow there: "
            '"exact" collides as the mesh is (mesh_collision_of under [robot])'
        )

    def __str__(self) -> str:
        if self.chosen == "hull":
            return (
                f"{self.link!r}: convex hull of {self.file.name}, up to {self._millimeters} mm off"
            )
        closed = trimesh.Trimesh(self.vertices, self.faces, process=False).is_watertight
        open_ = "" if closed else "; it is open: what is all inside it goes unnoticed"
        return f"{self.link!r}: {self.file.name}, as it is{open_}"

    @property
    def _millimeters(self) -> str:
        """How far it is off, rounded down to a tenth."""
        return f"{math.floor(1e4 * self.off_m) / 10:g}"


def mesh_body(
    link: str, joint: int, file: Path, vertices: Array, faces: Index, chosen: MeshCollision
) -> MeshBody:
    """What stands for a mesh, given in the frame of its joint, m.

    Raises:
        InputError: the mesh lies in a plane, so there is no hull of it.
    """
    exact = Shape("mesh", vertices=vertices, faces=faces)
    solid = exact if chosen == "exact" else convex_hull(vertices)
    if solid is None:
        message = "the mesh lies in a plane, so it has no hull: choose 'exact' for its link"
        raise InputError(str(file), None, message)
    own = _solid(solid)
    return MeshBody(link, joint, *own, file=file, chosen=chosen, vertices=vertices, faces=faces)


def _solid(solid: Shape) -> tuple[Array, Array, float, bool, Shape]:
    """What a body has of a hull or a mesh, with the capsule around the box that is around it."""
    corners = solid.corners
    middle, edges = corners.mean(axis=0), corners[[1, 2, 4]] - corners[0]
    across, thick, along = sorted(edges, key=np.linalg.norm)
    radius = float(np.hypot(np.linalg.norm(across), np.linalg.norm(thick))) / 2
    return middle - along / 2, middle + along / 2, radius, False, solid


def _round_bodies(
    link: str, joint: int, own: tuple[LinkShape, ...], placed: list[pin.SE3]
) -> list[Body]:
    """Bodies of a link's cylinders, spheres and capsules, placed in the frame of the joint.

    A cylinder with a sphere of its radius on both ends is a capsule.
    """
    shapes = list(zip(own, placed, strict=True))
    spheres = [
        (np.array(at.translation), shape.sizes[0]) for shape, at in shapes if shape.kind == "sphere"
    ]
    bodies = []
    for shape, at in shapes:
        if shape.kind not in ("capsule", "cylinder"):
            continue
        (radius, length), flat = shape.sizes, shape.kind == "cylinder"
        half = at.rotation[:, 2] * (length / 2)
        ends = at.translation - half, at.translation + half
        caps = [
            [
                number
                for number, (center, other) in enumerate(spheres)
                if max(abs(other - radius), float(np.linalg.norm(center - end))) < _SAME
            ]
            for end in ends
        ]
        if flat and all(caps):
            flat = False
            spheres = [each for k, each in enumerate(spheres) if k not in caps[0] + caps[1]]
        bodies.append(Body(link, joint, *ends, radius, flat))
    bodies.extend(Body(link, joint, at, at, radius, flat=False) for at, radius in spheres)
    return bodies


def place_shapes(
    whole: Urdf, model: pin.Model, files: RobotFiles, folder: Path
) -> tuple[Body, ...]:
    """Bodies of all links, base first.

    Args:
        whole: arm and tool as one tree.
        model: the joints that move, and a frame for each link.
        files: what stands for a link's mesh, and where packages are.
        folder: what the names of package folders are relative to.

    Raises:
        InputError: a mesh cannot be found or read.
    """
    for name in files.mesh_collision_of:
        if name not in whole.links or all(s.kind != "mesh" for s in whole.links[name].shapes):
            message = "no such link with a mesh for collisions"
            raise InputError(None, f"robot.mesh_collision_of.{name}", message)
    packages = [folder / name for name in files.package_folders]
    bodies: list[Body] = []
    for name, link in whole.links.items():
        frame = model.frames[model.getFrameId(name, pin.FrameType.BODY)]
        joint, placed = frame.parentJoint, [frame.placement * each.place for each in link.shapes]
        bodies += _round_bodies(name, joint, link.shapes, placed)
        for number, (shape, at) in enumerate(zip(link.shapes, placed, strict=True)):
            if shape.kind == "box":
                corners = trimesh.creation.box(shape.sizes).vertices
                solid = convex_hull(corners @ at.rotation.T + at.translation)
                assert solid is not None  # no side of it is 0
                bodies.append(Body(name, joint, *_solid(solid)))
            elif shape.kind == "mesh":
                place = f"link[{name}].collision[{number}].mesh"
                file = find_mesh(shape.mesh, link.file, place, link.folder, packages)
                vertices, faces = load_link_mesh(file, shape.sizes)
                chosen = files.mesh_collision_of.get(name, files.mesh_collision)
                own_mesh = (vertices @ at.rotation.T + at.translation, faces)
                bodies.append(mesh_body(name, joint, file, *own_mesh, chosen))
    return tuple(bodies)
