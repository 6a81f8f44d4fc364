"""Whether every configuration passes the scene's tests: all in contact, contacts on the way.

Contacts of arm and tool are found by python-fcl: the planner's engine has no say here. One
configuration is tested after the other, where the balls around two things overlap.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import fcl
import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.body import Body, Shape
from cellcolor.frontend.arm.kinematics import Poses, forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.validity_tests import STANDARD_REASONS, Workplace
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import OFF_SURFACE

Pair = tuple[Body, Body | Shape, float]
"""A body, another one or what stands still, and how near (m) they must not come."""

_ROUGH = 0.0003  # m; python-fcl's distances of flat cylinders and cones are off by so much
_PRIMITIVES = {
    "box": fcl.Box,
    "sphere": fcl.Sphere,
    "cylinder": fcl.Cylinder,
    "capsule": fcl.Capsule,
    "cone": fcl.Cone,
}


def pairs_of(place: Workplace) -> dict[str, list[Pair]]:
    """What is tested, by the names of the tests."""
    robot, margins, exempt = place.robot, place.setup.margins, place.setup.robot.may_touch_ground
    ground = [] if place.ground is None else [place.ground]
    free = [body for body in robot.bodies if body.link not in exempt]
    moving = [body for body in robot.bodies if body.joint > 0]
    around = [*ground, *place.obstacles]
    return {
        "tip blocked": [(place.tip.body, thing, 0.0) for thing in around],
        "ground": [(body, thing, margins.to_ground_m) for thing in ground for body in free],
        "self collision": [
            (robot.bodies[i], robot.bodies[j], margins.between_links_m)
            for i, j in robot.tested_pairs
        ],
        "obstacle collision": [
            (body, thing, margins.to_obstacles_m) for thing in place.obstacles for body in moving
        ],
        "object collision": [(body, place.target, margins.to_object_m) for body in moving],
    }


def touching(pairs: list[Pair], poses: Poses) -> Mask:
    """Whether one of the pairs touches, in each of k configurations, (k,)."""
    hit = np.zeros(len(poses.tip), dtype=bool)
    for first, second, margin in pairs:
        rows = np.flatnonzero(~hit)
        some = poses.take(rows)
        one, other = _Placed.of(first, some), _Placed.of(second, some)
        if other.shape.kind == "half-space":
            up = other.rotation[0, :, 2] if len(rows) else np.zeros(3)
            hit[rows] = _lowest(one, up) - other.origin @ up <= margin
            continue
        hit[rows] = _touch(one, other, margin)
        for holder, placed, held in ((first, one, other), (second, other, one)):
            if isinstance(holder, Body) and placed.shape.kind == "mesh":
                hit[rows] |= _holds(placed, held)
    return hit


class _Placed(NamedTuple):
    """A shape and where it is: rotations (k, 3, 3) and origins (k, 3)."""

    shape: Shape
    rotation: Array
    origin: Array

    @classmethod
    def of(cls, thing: Body | Shape, poses: Poses) -> _Placed:
        """A body in the configurations of poses, or what stands still beside them."""
        shape, joint = (thing.shape, thing.joint) if isinstance(thing, Body) else (thing, 0)
        turn, at = poses.rotation[:, joint], poses.origin[:, joint]
        return cls(shape, turn @ shape.rotation, turn @ shape.origin + at)

    def points(self, own: Array) -> Array:
        """Points (p, 3) of the shape's own frame in the world, (k, p, 3)."""
        return np.asarray(own @ self.rotation.swapaxes(1, 2) + self.origin[:, None])


def _lowest(one: _Placed, up: Array) -> Array:
    """How far the lowest point of a body is along a direction (3,), (k,), m."""
    shape = one.shape
    if shape.kind in ("hull", "mesh"):
        return np.asarray((one.points(shape.vertices) @ up).min(axis=1))
    radius, length = (*shape.sizes, 0.0)[:2]
    along = np.abs(one.rotation[:, :, 2] @ up)
    across = np.sqrt(np.maximum(1 - along**2, 0.0)) if shape.kind == "cylinder" else 1.0
    return np.asarray(one.origin @ up - length / 2 * along - radius * across)


def _touch(one: _Placed, other: _Placed, margin: float) -> Mask:
    """Whether two things are no farther apart than a margin, (k,)."""
    # Seen from the other one, so that only the first has to be placed.
    back = other.rotation.swapaxes(1, 2)
    turns, places = back @ one.rotation, back @ (one.origin - other.origin)[:, :, None]
    # Boxes around the two that a face of either separates cannot touch.
    (middle, half), (there, half_there) = _box(one.shape), _box(other.shape)
    apart, spread = turns @ middle + places[:, :, 0] - there, np.abs(turns)
    most = margin + _ROUGH
    within = np.abs(apart) <= half_there + spread @ half + most
    within &= np.abs(apart[:, None] @ turns)[:, 0] <= half + half_there @ spread + most
    hit = np.asarray(within.all(axis=1))
    # A ball or capsule is made wider by the margin, which is exact.
    wider, rest = [0.0, 0.0], margin
    for number, shape in enumerate((one.shape, other.shape)):
        if rest and shape.kind in ("sphere", "capsule"):
            wider[number], rest = margin, 0.0
    a = fcl.CollisionObject(_geometry(one.shape, wider[0]), fcl.Transform())
    b = _everything(other.shape, wider[1])
    for row in np.flatnonzero(hit):
        a.setTransform(fcl.Transform(turns[row], places[row, :, 0]))
        met = fcl.CollisionData()
        b.collide(a, met, fcl.defaultCollisionCallback)
        hit[row] = met.result.is_collision
        if rest and not hit[row]:
            near = fcl.DistanceData()
            b.distance(a, near, fcl.defaultDistanceCallback)
            hit[row] = near.result.min_distance < rest - _ROUGH
    return hit


def _everything(shape: Shape, wider: float) -> fcl.DynamicAABBTreeCollisionManager:
    """A shape in its own frame, or all cells of one."""
    if shape.kind == "cells":
        cell = fcl.Box(*[shape.sizes[0]] * 3)
        parts = [fcl.CollisionObject(cell, fcl.Transform(at)) for at in shape.points]
    else:
        parts = [fcl.CollisionObject(_geometry(shape, wider), fcl.Transform())]
    manager = fcl.DynamicAABBTreeCollisionManager()
    manager.registerObjects(parts)
    manager.setup()
    return manager


def _geometry(shape: Shape, wider: float = 0.0) -> fcl.CollisionGeometry:
    """A shape for python-fcl, a ball or capsule made wider; others are made once."""
    if shape.kind in _PRIMITIVES:
        radius, *length = shape.sizes
        return _PRIMITIVES[shape.kind](radius + wider, *length)
    if "fcl" not in shape.made:
        if shape.kind == "hull":
            faces = np.insert(shape.faces, 0, 3, axis=1).ravel()
            made = fcl.Convex(shape.vertices, len(shape.faces), faces)
        else:
            made = fcl.BVHModel()
            made.beginModel(len(shape.faces), len(shape.vertices))
            made.addSubModel(shape.vertices, shape.faces)
            made.endModel()
        shape.made["fcl"] = made
    return shape.made["fcl"]


def _box(shape: Shape) -> tuple[Array, Array]:
    """Center (3,) and half of the sizes (3,) of a box around a shape in its own frame, m."""
    if not len(shape.vertices):
        radius, *rest = shape.sizes
        if shape.kind == "box":
            return np.zeros(3), np.asarray(shape.sizes) / 2
        return np.zeros(3), radius + np.array([0.0, 0.0, sum(rest) / 2])
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    cell = shape.sizes[0] if shape.kind == "cells" else 0.0
    return (low + high) / 2, (high - low) / 2 + 2 * cell


def _holds(holder: _Placed, held: _Placed) -> Mask:
    """Whether a part of one thing is wholly inside a link's mesh, (k,), by its solid angle.

    After Van Oosterom and Strackee, 1983; half of all directions or more counts.
    """
    mesh = holder.shape
    at = held.points(held.shape.points) - holder.origin[:, None]
    local = at @ holder.rotation
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    near = ((local >= low) & (local <= high)).all(axis=2)
    inside = np.zeros(len(local), dtype=bool)
    for row, part in np.argwhere(near).tolist():
        a, b, c = (mesh.vertices[mesh.faces[:, k]] - local[row, part] for k in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        dots = (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        turned = np.arctan2((a * np.cross(b, c)).sum(1), la * lb * lc + dots).sum()
        inside[row] |= abs(turned) >= np.pi
    return inside


_THIN = 1e-4  # m; radius of the axis of the tool's tip, which must not pass through the object


def judge_validity(
    prepared: PreparedScene, dense: Dense, deadline: Deadline, faults: FaultList
) -> None:
    """Note configurations that fail a test, and moves that were not planned.

    In contact all tests of the scene are asked. On the way between strokes only contacts are, of
    the arm and of the tool's tip; there the tip may not pass through the object either.
    """
    unplanned = np.zeros(len(faults.tips), dtype=bool)
    for sample in faults.trajectory.unplanned:
        unplanned[sample] = True
        faults.add("unplanned", "the move to the next sample was not planned", sample)
    contact = np.flatnonzero(dense.contact)
    names = prepared.judge.reason_names
    reasons = _reasons(prepared, dense.joints[contact], deadline)
    _note(dense, contact, reasons, names, faults)
    # What lies between two samples with no planned move is known to be nothing.
    on_the_way = np.flatnonzero(~dense.contact & ~(unplanned[dense.sample] & (dense.way > 0)))
    setup = prepared.setup.varied(constraints={"force": False, "conditioning": False})
    away = replace(prepared, arm=replace(prepared.arm, setup=setup)).asking(STANDARD_REASONS)
    reasons = _reasons(away, dense.joints[on_the_way], deadline, on_the_way=True)
    _note(dense, on_the_way, reasons, names, faults)


def _reasons(
    prepared: PreparedScene, joints: Array, deadline: Deadline, *, on_the_way: bool = False
) -> NDArray[np.uint8]:
    """The code (k,) of the first test that each configuration fails; contacts by an own engine."""
    names = prepared.judge.reason_names
    tests: dict[str, list[Pair]] = {}
    if prepared.setup.constraints.collision:
        tests = pairs_of(prepared)
        if on_the_way:
            tests["object collision"] += _through_object(prepared)
    others = prepared.asking(frozenset(names) - tests.keys()).judge
    reasons = np.zeros(len(joints), dtype=np.uint8)
    for rows in chunks(len(joints)):
        found = others(joints[rows], deadline).reasons
        poses = forward(prepared.robot, joints[rows])
        for name in sorted(tests, key=names.index):
            deadline.check()
            code = names.index(name)
            asked = np.flatnonzero((found == VALID) | (found > code))
            found[asked[touching(tests[name], poses.take(asked))]] = code
        reasons[rows] = found
    return reasons


def _through_object(place: Workplace) -> list[Pair]:
    """The tool's axis between the tip and the tool's body, which must not meet the object.

    The first millimeter from the tip is left out: the tip may lie on the object.
    """
    tip = place.tip.body
    if tip.length <= OFF_SURFACE:
        return []
    start = tip.start + OFF_SURFACE / tip.length * (tip.end - tip.start)
    return [(replace(tip, start=start, radius=_THIN), place.target, 0.0)]


def _note(
    dense: Dense,
    rows: Index,
    reasons: NDArray[np.uint8],
    names: tuple[str, ...],
    faults: FaultList,
) -> None:
    for code in sorted(set(reasons.tolist()) - {VALID}):
        name, failing = names[code], (reasons == code).astype(np.float64)

        def text(row: int, name: str = name) -> str:
            doing = "in contact" if dense.contact[rows[row]] else "on the way"
            return f"fails the test {name!r} {doing}"

        faults.add_rows("invalid", dense, rows, failing, 0.0, text, name)
