"""Arm and tool as one tree: the tool on the flange, the joints that stand still, Pinocchio's model.

The tree is written so that Pinocchio reads all of it. Continuous joints become revolute ones, which
have one position each. Joints get the efforts and velocities that the reader asks for, links lose
inertials that cannot be used, and pictures are left out. A mesh or a capsule becomes a small sphere
in the same place.
"""

from __future__ import annotations

import copy
import math
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf import PRISMATIC, Urdf, axis_of, inertial_fault, limits_of

_FLANGES = ("tool0", "flange", "ee_link", "tool_flange", "wrist_3_link", "link_6")  # of vendors

FIX = "give its position under [robot.fixed_joints], as {} = 0.0"
"""What to do about a joint that may not move, by its name."""

Vector = tuple[float, float, float]


def mount(
    arm: Urdf,
    flange: str,
    tool: Urdf,
    position: Vector = (0.0, 0.0, 0.0),
    rpy: Vector = (0.0, 0.0, 0.0),
) -> Urdf:
    """The tool's tree fixed to the arm's flange link.

    Args:
        position: of the tool's root link in the frame of the flange link, m.
        rpy: its angles there, rad, extrinsic x, y, z.

    Raises:
        InputError: the arm has no such link, or arm and tool share a name.
    """
    if flange not in arm.links:
        usual = [name for name in _FLANGES if name in arm.parent]
        ends = [name for name in arm.parent if name not in arm.parent.values()]
        known = ", ".join(map(repr, dict.fromkeys([*usual, *ends])))
        message = f"the flange link is not in the arm, which has {known}"
        raise InputError(str(arm.file), f"link[{flange}]", message)
    for tag, own, others in (("link", tool.links, arm.links), ("joint", tool.joints, arm.joints)):
        for name in own:
            if name in others:
                message = f"{arm.file.name} has that name too"
                raise InputError(str(tool.file), f"{tag}[{name}]", message)
    name = "tool_mount"
    joint = ET.Element("joint", {"name": name, "type": "fixed"})
    ET.SubElement(joint, "parent", {"link": flange})
    ET.SubElement(joint, "child", {"link": tool.root})
    pose = {"xyz": " ".join(map(repr, position)), "rpy": " ".join(map(repr, rpy))}
    ET.SubElement(joint, "origin", pose)
    return replace(
        arm,
        links=arm.links | tool.links,
        joints=arm.joints | tool.joints | {name: joint},
        parent=arm.parent | tool.parent | {tool.root: flange},
        joint_above=arm.joint_above | tool.joint_above | {tool.root: name},
        kinds=arm.kinds | tool.kinds,
        shapes=arm.shapes | tool.shapes,
        followers=arm.followers | tool.followers,
    )


def settled(urdf: Urdf, positions: Mapping[str, float]) -> dict[str, float]:
    """The positions of all joints that stand still, rad, or m of prismatic ones.

    What follows such a joint stands still as well. A leader that is a fixed joint is at zero.

    Args:
        positions: of joints that are fixed.

    Raises:
        InputError: a joint follows one that moves, one that is not there, or itself.
    """
    standing = {name: at for name, at in positions.items() if name in urdf.kinds}
    for name in urdf.followers:
        leader, factor, offset, seen = name, 1.0, 0.0, {name}
        while leader in urdf.followers and leader not in positions:
            own = urdf.followers[leader]
            leader, offset = own.leader, offset + factor * own.offset
            factor *= own.multiplier
            if leader not in urdf.joints or leader in seen:
                fault = "follows itself" if leader in seen else f"no joint {leader!r}"
                raise InputError(None, f"joint[{name}].mimic", fault)
            seen.add(leader)
        if leader in urdf.kinds and leader not in positions and factor:
            fault = f"follows {leader!r}, which moves: {FIX.format(name)}"
            raise InputError(None, f"joint[{name}].mimic", fault)
        standing[name] = factor * positions.get(leader, 0.0) + offset
    return standing


def check_position(urdf: Urdf, name: str, position: float) -> None:
    """Refuse a position of a fixed joint outside of the joint's limits.

    Raises:
        InputError: names the joint in the setup.
    """
    lower, upper = limits_of(urdf.joints[name])
    if not lower <= position <= upper:
        message = f"{position:g} is outside the joint's limits, {lower:g} to {upper:g}"
        if urdf.kinds[name] != PRISMATIC and abs(position) > 2 * math.pi:
            message += f": {looks_like_degrees(position)}"
        raise InputError(None, f"robot.fixed_joints.{name}", message)


def pinocchio_models(
    urdf: Urdf, standing: Mapping[str, float]
) -> tuple[pin.Model, pin.GeometryModel]:
    """Pinocchio's model and collision shapes, without the joints that stand still.

    Args:
        standing: their positions, rad, or m of prismatic ones.

    Raises:
        InputError: Pinocchio cannot read it.
    """
    xml = ET.Element("robot", {"name": "arm"})
    xml.extend([_link(link) for link in urdf.links.values()])
    xml.extend([_joint(joint, name in urdf.kinds) for name, joint in urdf.joints.items()])
    text = ET.tostring(xml, encoding="unicode")
    try:
        model = pin.buildModelFromXML(text)
        geometry = pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)
    except (ValueError, RuntimeError) as error:
        raise InputError(str(urdf.file), "robot", f"Pinocchio refuses it: {error}") from error
    if not standing:
        return model, geometry
    q = np.zeros(model.nq)
    for name, position in standing.items():
        q[model.joints[model.getJointId(name)].idx_q] = position
    locked = [*map(model.getJointId, standing)]
    reduced: tuple[pin.Model, pin.GeometryModel] = pin.buildReducedModel(model, geometry, locked, q)
    return reduced


_AHEAD = 1e-3  # m; so far along the axis the flange is at least from what shows its sense


def last_axis(urdf: Urdf, flange: str, standing: Mapping[str, float]) -> tuple[Array, Array]:
    """The last axis (3,) before the flange, in its frame, and how far beside it the flange is, m.

    The axis points outward with all joints at zero.

    Args:
        standing: see :func:`pinocchio_models`.
    """
    model, _ = pinocchio_models(urdf, standing)
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.zeros(model.nq))
    at = {frame.name: data.oMf[number] for number, frame in enumerate(model.frames)}
    moving = urdf.leading.keys() - standing
    links = list(reversed(urdf.chain(flange)))
    last = next((k for k, link in enumerate(links) if urdf.joint_above.get(link) in moving), None)
    if last is None:
        return np.array([0.0, 0.0, 1.0]), np.zeros(3)
    name = urdf.joint_above[links[last]]
    own = np.array([float(part) for part in axis_of(urdf.joints[name]).split()])
    axis = at[flange].rotation.T @ data.oMi[model.getJointId(name)].rotation @ own
    ways = [at[flange].actInv(at[link]).translation for link in links[last:]]
    beside = (ways[0] @ axis) * axis - ways[0]
    ahead = next((far for way in ways if abs(far := -axis @ way) > _AHEAD), 1.0)
    return np.asarray(axis * np.sign(ahead)), np.asarray(beside)


_NO_LIMIT = 1e6  # rad; for those who ask the model itself


def _joint(given: ET.Element, moves: bool) -> ET.Element:
    joint = copy.deepcopy(given)
    for tag in ("mimic", "safety_controller", *(() if moves else ("limit",))):
        for element in joint.findall(tag):
            joint.remove(element)
    if moves:
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit")
        ends = (-_NO_LIMIT, _NO_LIMIT)
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
        elif given.find("mimic") is None:
            ends = limits_of(given)
        for end, value in zip(("lower", "upper"), ends, strict=True):
            limit.set(end, repr(min(max(value, -_NO_LIMIT), _NO_LIMIT)))
        for attribute in ("effort", "velocity"):
            limit.set(attribute, limit.get(attribute, "0"))
    return joint


def _link(given: ET.Element) -> ET.Element:
    link = copy.deepcopy(given)
    for visual in link.findall("visual"):
        link.remove(visual)
    inertial = link.find("inertial")
    if inertial is not None and inertial_fault(given):
        link.remove(inertial)
    for collision in link.findall("collision"):
        geometry = collision.find("geometry")
        assert geometry is not None  # checked
        if geometry[0].tag in ("mesh", "capsule"):
            geometry[:] = [ET.Element("sphere", {"radius": "0.001"})]
    return link
