"""All collision shapes of arm and tool in the frames of the joints that carry them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import (
    Body,
    Primitive,
    StandIn,
    box_body,
    mesh_bodies,
    round_bodies,
)
from cellcolor.frontend.arm.link_mesh import find_mesh, load_link_mesh
from cellcolor.frontend.arm.link_shapes import LinkShape
from cellcolor.frontend.arm.urdf import Urdf
from cellcolor.frontend.setup import MeshCollision


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
        bodies += round_bodies(link, int(placed[0].parentJoint), _primitives(own, placed))
        for number, (shape, at) in enumerate(zip(own, placed, strict=True)):
            if shape.kind not in ("box", "mesh"):
                continue
            joint, turn = int(at.parentJoint), np.array(at.placement.rotation)
            center = np.array(at.placement.translation)
            if shape.kind == "box":
                bodies.append(box_body(link, joint, shape.sizes, turn, center))
                continue
            place = f"link[{link}].collision[{number}].mesh"
            file = find_mesh(shape.file, tree.file, place, tree.folder, shapes.package_folders)
            vertices, faces = load_link_mesh(file, shape.sizes)
            chosen = shapes.chosen_of.get(link, shapes.chosen)
            own_mesh = (vertices @ turn.T + center, faces)
            stand_ins.append(mesh_bodies(link, joint, file, *own_mesh, chosen))
            bodies += stand_ins[-1].bodies
    return tuple(bodies), tuple(stand_ins)


def _primitives(own: tuple[LinkShape, ...], placed: list[pin.GeometryObject]) -> list[Primitive]:
    """The round shapes of a link, as far as Pinocchio knows them with its numbers."""
    return [
        Primitive(
            shape.kind,
            np.array(at.placement.translation),
            np.array(at.placement.rotation),
            shape.sizes[0],
            shape.sizes[1] if len(shape.sizes) > 1 else 0.0,
        )
        for shape, at in zip(own, placed, strict=True)
        if shape.kind in ("capsule", "cylinder", "sphere")
    ]
