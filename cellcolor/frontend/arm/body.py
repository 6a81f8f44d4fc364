"""Collision shapes of arm and tool, as bodies that hang on the joints that carry them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, Index
from cellcolor.errors import InputError
from cellcolor.frontend.arm.capsules import capsule_around, capsules_around
from cellcolor.frontend.arm.link_mesh import find_mesh, load_link_mesh
from cellcolor.frontend.arm.polyhedron import Polyhedron, box, convex_hull
from cellcolor.frontend.arm.urdf import LinkShape, Urdf
from cellcolor.frontend.setup import MeshCollision

_SAME = 1e-6  # m; a sphere's center and a cylinder's end nearer than this are one point


@dataclass(frozen=True)
class Body:
    """A collision shape: all points within ``radius`` of a segment, or a flat-ended cylinder.

    ``start`` and ``end`` (3,) in m are in the frame of ``joint`` (0 is the world, the
    others are the frames behind the joints). A sphere is a capsule whose ends coincide.

    With a ``solid``, which hangs on the same frame, the body is instead all that is within ``skin``
    (m) of that, and the capsule is one around it.
    """

    link: str
    joint: int
    start: Array
    end: Array
    radius: float
    flat: bool
    solid: Polyhedron | None = None
    skin: float = 0.0

    @cached_property
    def length(self) -> float:
        """Distance between the ends in m."""
        return float(np.linalg.norm(self.end - self.start))


@dataclass(frozen=True)
class StandIn:
    """What collides in the place of a link's mesh.

    Attributes:
        link, file: the link, and the file of its mesh.
        chosen: hull, exact or capsules.
        vertices, faces: the mesh, in the frame of the joint that carries it, m.
        bodies: what collides.
    """

    link: str
    file: Path
    chosen: MeshCollision
    vertices: Array
    faces: Index
    bodies: tuple[Body, ...]


def mesh_bodies(
    link: str, joint: int, file: Path, vertices: Array, faces: Index, chosen: MeshCollision
) -> StandIn:
    """What stands for a mesh, given in the frame of its joint, m.

    Raises:
        InputError: the mesh lies in a plane, so there is no hull of it.
    """
    if chosen == "capsules":
        capsules = capsules_around(vertices, faces)
        bodies = tuple(Body(link, joint, *capsule, flat=False) for capsule in capsules)
    else:
        solid = convex_hull(vertices) if chosen == "hull" else Polyhedron(vertices, faces)
        if solid is None:
            message = "the mesh lies in a plane, so it has no hull: choose 'exact' for its link"
            raise InputError(str(file), None, message)
        bodies = (_polyhedral(link, joint, solid),)
    return StandIn(link, file, chosen, vertices, faces, bodies)


def _polyhedral(link: str, joint: int, solid: Polyhedron) -> Body:
    return Body(link, joint, *capsule_around(solid.vertices), flat=False, solid=solid)


def _round_bodies(
    link: str, joint: int, own: tuple[LinkShape, ...], placed: list[pin.GeometryObject]
) -> list[Body]:
    """Bodies of a link's cylinders, spheres and capsules, where Pinocchio has them.

    A cylinder with a sphere of its radius on both ends is a capsule.
    """
    shapes = [(shape, each.placement) for shape, each in zip(own, placed, strict=True)]
    spheres = [
        (np.array(at.translation), shape.sizes[0]) for shape, at in shapes if shape.kind == "sphere"
    ]
    bodies = []
    for shape, at in shapes:
        if shape.kind not in ("capsule", "cylinder"):
            continue
        radius, length = shape.sizes
        center, half = np.array(at.translation), np.array(at.rotation)[:, 2] * (length / 2)
        start, end = center - half, center + half
        round_ends = shape.kind == "capsule"
        if not round_ends:
            caps = [
                next((s for s in spheres if _is_cap(s, point, radius)), None)
                for point in (start, end)
            ]
            round_ends = caps[0] is not None and caps[1] is not None
            if round_ends:
                spheres = [sphere for sphere in spheres if not any(sphere is c for c in caps)]
        bodies.append(Body(link, joint, start, end, radius, flat=not round_ends))
    bodies.extend(Body(link, joint, at, at, radius, flat=False) for at, radius in spheres)
    return bodies


def _is_cap(sphere: tuple[Array, float], point: Array, radius: float) -> bool:
    center, own = sphere
    return abs(own - radius) < _SAME and float(np.linalg.norm(center - point)) < _SAME


@dataclass(frozen=True)
class Shapes:
    """How the meshes of links collide, and where they are.

    Attributes:
        chosen: what stands for a link's mesh.
        chosen_of: the same of some links by their names.
        package_folders: packages, or folders that have some, for ``package://``.
    """

    chosen: MeshCollision = "hull"
    chosen_of: Mapping[str, MeshCollision] = field(default_factory=dict)
    package_folders: tuple[Path, ...] = ()


def place_shapes(
    trees: tuple[Urdf, Urdf],
    whole: Urdf,
    model: pin.Model,
    geometry: pin.GeometryModel,
    shapes: Shapes,
) -> tuple[tuple[Body, ...], tuple[StandIn, ...]]:
    """Bodies of all links, base first, and what stands for the meshes among them.

    Args:
        trees: arm and tool, for the names and folders of their files.
        whole: both as one tree.
        model, geometry: as Pinocchio has read it, meshes as spheres.

    Raises:
        InputError: Pinocchio has read other shapes, or a mesh cannot be found or read.
    """
    meshed = {name for name, own in whole.shapes.items() if any(s.kind == "mesh" for s in own)}
    for name in shapes.chosen_of:
        if name not in meshed:
            message = "no such link with a mesh for collisions"
            raise InputError(None, f"robot.mesh_collision_of.{name}", message)
    read: dict[str, list[pin.GeometryObject]] = {}
    for each in geometry.geometryObjects:
        read.setdefault(model.frames[each.parentFrame].name, []).append(each)
    bodies: list[Body] = []
    stand_ins: list[StandIn] = []
    for link, own in whole.shapes.items():
        tree = trees[1] if link in trees[1].shapes else trees[0]
        placed = read.get(link, [])
        if len(placed) != len(own):
            message = f"Pinocchio read {len(placed)} of {len(own)} shapes"
            raise InputError(str(whole.file), f"link[{link}].collision", message)
        bodies += _round_bodies(link, int(placed[0].parentJoint), own, placed)
        for number, (shape, at) in enumerate(zip(own, placed, strict=True)):
            if shape.kind not in ("box", "mesh"):
                continue
            joint, turn = int(at.parentJoint), np.array(at.placement.rotation)
            center = np.array(at.placement.translation)
            if shape.kind == "box":
                corners, sides = box(shape.sizes)
                solid = Polyhedron(corners @ turn.T + center, sides)
                bodies.append(_polyhedral(link, joint, solid))
                continue
            place = f"link[{link}].collision[{number}].mesh"
            file = find_mesh(shape.file, tree.file, place, tree.folder, shapes.package_folders)
            vertices, faces = load_link_mesh(file, shape.sizes)
            chosen = shapes.chosen_of.get(link, shapes.chosen)
            own_mesh = (vertices @ turn.T + center, faces)
            stand_ins.append(mesh_bodies(link, joint, file, *own_mesh, chosen))
            bodies += stand_ins[-1].bodies
    return tuple(bodies), tuple(stand_ins)
