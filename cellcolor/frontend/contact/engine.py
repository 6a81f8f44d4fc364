"""Contacts of many configurations at once, by Pinocchio's geometry model and coal.

A mesh that moves with a link is filled: what is wholly inside its surface touches it. One that
stands still is a shell. A body wholly inside a closed one does not touch that; it cannot happen
unnoticed to an arm whose bodies touch one another in a row and of which a part is outside.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Sequence

import coal
import igl
import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Body, Shape
from cellcolor.frontend.arm.kinematics import forward, frames_along
from cellcolor.frontend.arm.robot import Robot

Between = tuple[Body, Body, float]
"""Two bodies, and how near (m) they must not come."""
Pair = Between | tuple[Body, Shape, float]
"""The same, or a body and what stands still."""

_THREADS = min(len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1, 16)
_OWNER = os.getpid()  # OpenMP's threads do not survive a fork: a child has one
_PRECISE = True  # without contacts asked for, coal misses flat cylinders up to 0.4 mm inside a mesh
_TRIED = 100  # configurations, to see whether links touch whatever the arm does
_PRIMITIVES = {
    "box": coal.Box,
    "sphere": coal.Sphere,
    "cylinder": coal.Cylinder,
    "capsule": coal.Capsule,
    "cone": coal.Cone,
}


class Contacts:
    """Pairs of things, and in which configurations some of them touch or come too near."""

    def __init__(self, pairs: Sequence[Pair], robot: Robot | None = None) -> None:
        """Pairs in the order in which they are tested; ``robot`` carries the bodies.

        Without one the bodies hang on a frame of their own, the joint 1, which moves freely.
        """
        self._pairs, self._robot = pairs, robot
        model, geometry = _free_frame() if robot is None else robot.model, pin.GeometryModel()
        number: dict[int, int] = {}
        for first, second, _ in pairs:
            for each in (first, second):
                if id(each) not in number:
                    number[id(each)] = geometry.addGeometryObject(_placed(each))
            geometry.addCollisionPair(pin.CollisionPair(number[id(first)], number[id(second)]))
        self._pool = pin.GeometryPool(model, geometry, _THREADS)
        for data in self._pool.getGeometryDatas():
            for request, (_, _, margin) in zip(data.collisionRequests, pairs, strict=True):
                request.enable_contact, request.security_margin = _PRECISE, margin
        self._filled = [
            (holder, other)
            for first, second, _ in pairs
            for holder, other in ((first, second), (second, first))
            if isinstance(holder, Body) and holder.shape.kind == "mesh"
        ]

    def __bool__(self) -> bool:
        """Whether there is anything to touch."""
        return bool(self._pairs)

    def __call__(self, configurations: Array) -> Mask:
        """In which of configurations (n, joints) a pair touches, (n,).

        Without a robot these are the poses of the frame, see :func:`poses_along`.
        """
        hit = np.zeros(len(configurations), dtype=bool)
        if not self._pairs or not len(hit):
            return hit
        positions = np.asfortranarray(configurations.T)
        threads = _THREADS if os.getpid() == _OWNER else 1
        hit |= pin.computeCollisionsInParallel(threads, self._pool, positions, True)
        for holder, other in self._filled:
            rows = np.flatnonzero(~hit)
            hit[rows] = self._holds(holder, other, configurations[rows])
        return hit

    def touching(self, configuration: Array) -> list[Pair]:
        """All pairs that touch in one configuration (joints,)."""
        return [p for p in self._pairs if Contacts([p], self._robot)(configuration[None])[0]]

    def _holds(self, holder: Body, other: Body | Shape, configurations: Array) -> Mask:
        """Whether a part of another thing is wholly inside a filled mesh, (n,).

        After Jacobson, Kavan and Sorkine-Hornung, Robust inside-outside segmentation using
        generalized winding numbers, 2013: half a turn or more counts, either way round, so that
        small holes do no harm and a mesh may be inside out.
        """
        assert self._robot is not None  # no mesh hangs on a free frame
        poses, mesh = forward(self._robot, configurations), holder.shape
        shape = other.shape if isinstance(other, Body) else other
        points = shape.points @ shape.rotation.T + shape.origin
        points = np.broadcast_to(points, (len(configurations), *points.shape))
        if isinstance(other, Body):
            turn, origin = poses.rotation[:, other.joint], poses.origin[:, other.joint]
            points = points @ turn.swapaxes(1, 2) + origin[:, None]
        turn, origin = poses.rotation[:, holder.joint], poses.origin[:, holder.joint]
        local = (points - origin[:, None]) @ turn
        near = (local >= mesh.vertices.min(axis=0)) & (local <= mesh.vertices.max(axis=0))
        inside = near.all(axis=2)
        if inside.any():
            turns = igl.fast_winding_number(mesh.vertices, mesh.faces, local[inside])
            inside[inside] = np.abs(turns) >= 0.5
        return np.asarray(inside.any(axis=1))


def pairs_of(robot: Robot, margin: float = 0.0) -> list[Between]:
    """The pairs of bodies that self-collision looks at."""
    return [(robot.bodies[i], robot.bodies[j], margin) for i, j in robot.tested_pairs]


def pairs_with(robot: Robot, things: Iterable[Shape], margin: float = 0.0) -> list[Pair]:
    """All bodies that can move, from the tool to the base, with things that stand still."""
    moving = [body for body in reversed(robot.bodies) if body.joint > 0]
    return [(body, thing, margin) for thing in things for body in moving]


def always_touching(robot: Robot, pairs: Sequence[Between]) -> tuple[tuple[str, str], ...]:
    """Pairs of links whose bodies, among pairs of them, overlap in all of 100 configurations: their
    shapes are larger than the links are.

    These are drawn from the joint limits, always the same ones; a joint without limits turns by a
    full circle.
    """
    lower = np.where(np.isinf(robot.lower), -np.pi, robot.lower)
    upper = np.where(np.isinf(robot.upper), np.pi, robot.upper)
    tried = np.random.default_rng(0).uniform(lower, upper, (_TRIED, robot.joints))
    of_links: dict[tuple[str, str], list[Between]] = {}
    for pair in pairs:
        of_links.setdefault((pair[0].link, pair[1].link), []).append(pair)
    return tuple(links for links, own in of_links.items() if Contacts(own, robot)(tried).all())


def meet(first: Shape, second: Shape) -> bool:
    """Whether two things that stand still touch; a shell does not notice what is all inside it."""
    sides = [(_geometry(it), coal.Transform3s(it.rotation, it.origin)) for it in (first, second)]
    request = coal.CollisionRequest()
    request.enable_contact = _PRECISE
    return bool(coal.collide(*sides[0], *sides[1], request, coal.CollisionResult()))


def width(shape: Shape) -> float:
    """The second of its three extents, m: of a plate not how thick it is."""
    solid = _geometry(shape)
    solid.computeLocalAABB()
    around = solid.aabb_local
    return float(sorted([around.width(), around.height(), around.depth()])[1])


def poses_along(points: Array, directions: Array) -> Array:
    """Poses (k, 7) of a free frame: its origin on points, its z axis along unit vectors (k, 3)."""
    return np.column_stack([points, Rotation.from_matrix(frames_along(directions)).as_quat()])


def _free_frame() -> pin.Model:
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")
    return model


def _placed(thing: Body | Shape) -> pin.GeometryObject:
    shape, joint = (thing.shape, thing.joint) if isinstance(thing, Body) else (thing, 0)
    at = pin.SE3(shape.rotation, shape.origin)
    return pin.GeometryObject(str(id(thing)), joint, at, _geometry(shape))


def _geometry(shape: Shape) -> coal.CollisionGeometry:
    """The shape for coal, in its own frame; made once."""
    if "coal" not in shape.made:
        shape.made["coal"] = _made(shape)
    return shape.made["coal"]


def _made(shape: Shape) -> coal.CollisionGeometry:
    if shape.kind == "half-space":
        return coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
    if shape.kind == "cells":
        return coal.makeOctree(shape.points, shape.sizes[0])
    if shape.kind == "hull":
        points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        points.extend(shape.vertices)
        triangles.extend([coal.Triangle(*face) for face in shape.faces.tolist()])
        return coal.Convex(points, triangles)
    if shape.kind == "mesh":
        model = coal.BVHModelOBB()
        model.beginModel(len(shape.faces), len(shape.vertices))
        model.addVertices(np.ascontiguousarray(shape.vertices))
        model.addTriangles(shape.faces.astype(np.int32))
        model.endModel()
        return model
    return _PRIMITIVES[shape.kind](*shape.sizes)
