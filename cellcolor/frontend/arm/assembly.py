"""Arm and tool as one tree: the tool on the flange, the joints beside the chain fixed.

The tree is written so that Pinocchio reads all of it (:func:`pinocchio_text`). Continuous joints
become revolute ones, which have one position each. Joints get the efforts and velocities that the
reader asks for, links lose inertials that cannot be used, and pictures are left out. A mesh or a
capsule becomes a small sphere in the same place.
"""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf import CONTINUOUS, PRISMATIC, Urdf, axis_of, check_urdf

_FLANGES = ("tool0", "flange", "ee_link", "tool_flange", "wrist_3_link", "link_6")  # of vendors

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
        flange: the name of that link.
        position: of the tool's root link in the frame of the flange link, m.
        rpy: its angles there, rad, extrinsic x, y, z.

    Raises:
        InputError: the arm has no such link, or arm and tool share a name.
    """
    if flange != arm.root and flange not in arm.parent:
        usual = [name for name in _FLANGES if name in arm.parent]
        ends = [name for name in arm.parent if name not in arm.parent.values()]
        known = ", ".join(map(repr, dict.fromkeys([*usual, *ends])))
        message = f"the flange link is not in the arm, which has {known}"
        raise InputError(str(arm.file), f"link[{flange}]", message)
    xml = ET.Element("robot", {"name": arm.xml.get("name", "arm")})
    xml.extend(list(arm.xml))
    taken = {(element.tag, element.get("name")) for element in arm.xml}
    for element in tool.xml:
        if element.tag in ("link", "joint") and (element.tag, element.get("name")) in taken:
            field = f"{element.tag}[{element.get('name')}]"
            raise InputError(str(tool.file), field, f"{arm.file.name} has that name too")
        xml.append(element)
    joint = ET.SubElement(xml, "joint", {"name": "tool_mount", "type": "fixed"})
    ET.SubElement(joint, "parent", {"link": flange})
    ET.SubElement(joint, "child", {"link": tool.root})
    if any((*position, *rpy)):
        _set_origin(joint, np.array(position), rpy)
    followers = {**arm.followers, **tool.followers}
    return check_urdf(arm.file, arm.folder, xml, arm.locked + tool.locked, followers)


def fix_joints(urdf: Urdf, positions: Mapping[str, float]) -> Urdf:
    """The same tree with some joints fixed, and with them those that follow these.

    Args:
        positions: of the joints by their names, rad, or m of prismatic ones. Other names are left
            alone: they may be in another tree.

    Raises:
        InputError: a position is outside the limits of its joint; names the joint in the setup.
    """
    xml = copy.deepcopy(urdf.xml)
    joints = {joint.get("name", ""): joint for joint in xml.findall("joint")}
    locked = list(urdf.locked)
    for name, position in positions.items():
        if name in urdf.kinds:
            _check_limits(joints[name], urdf.kinds[name], name, position)
            _fix(joints[name], urdf.kinds[name], position)
    for name, position in _following(urdf, positions).items():
        _fix(joints[name], urdf.followers[name].kind, position)
        if name in locked:
            locked.remove(name)
    return check_urdf(urdf.file, urdf.folder, xml, tuple(locked), urdf.followers)


def _following(urdf: Urdf, positions: Mapping[str, float]) -> dict[str, float]:
    """The positions of all followers that are given one, or whose leader has one."""
    found: dict[str, float] = {}
    for name in urdf.followers:
        path = [name]
        while path[-1] not in positions and path[-1] in urdf.followers:
            leader = urdf.followers[path[-1]].leader
            if leader in path:
                break
            path.append(leader)
        if path[-1] in positions:
            position = positions[path[-1]]
            for each in reversed(path[:-1]):
                position = urdf.followers[each].multiplier * position + urdf.followers[each].offset
            found[name] = position
    return found


def _check_limits(joint: ET.Element, kind: str, name: str, position: float) -> None:
    limit = joint.find("limit")
    if kind == CONTINUOUS or limit is None:
        return
    lower, upper = (float(limit.get(end, "nan")) for end in ("lower", "upper"))
    if not lower <= position <= upper:
        message = f"{position:g} is outside the joint's limits, {lower:g} to {upper:g}"
        if kind != PRISMATIC and abs(position) > 2 * np.pi:
            message += f": {looks_like_degrees(position)}"
        raise InputError(None, f"robot.fixed_joints.{name}", message)


def _fix(joint: ET.Element, kind: str, position: float) -> None:
    """Make a joint a fixed one in the pose that it has in a position."""
    joint.set("type", "fixed")
    if position == 0.0:
        return
    along, origin = _numbers(axis_of(joint)), joint.find("origin")
    xyz, rpy = (
        _numbers("0 0 0" if origin is None else origin.get(key, "0 0 0")) for key in ("xyz", "rpy")
    )
    turn = Rotation.from_euler("xyz", rpy)
    if kind == PRISMATIC:
        _set_origin(joint, xyz + turn.apply(position * along), tuple(rpy))
        return
    whole = (turn * Rotation.from_rotvec(position * along)).as_euler("xyz")
    _set_origin(joint, xyz, tuple(whole))


def _set_origin(joint: ET.Element, xyz: np.ndarray, rpy: tuple[float, ...]) -> None:
    origin = joint.find("origin")
    if origin is None:
        origin = ET.SubElement(joint, "origin")
    origin.set("xyz", " ".join(repr(float(value)) for value in xyz))
    origin.set("rpy", " ".join(repr(float(value)) for value in rpy))


def _numbers(text: str) -> np.ndarray:
    return np.array([float(part) for part in text.split()])


_NO_LIMIT = 1e6  # rad; for those who ask the model itself


def pinocchio_text(urdf: Urdf) -> str:
    """The XML as one string."""
    xml = ET.Element("robot", dict(urdf.xml.attrib))
    faulty = {error.field for error in urdf.weightless}
    for element in urdf.xml:
        if element.tag == "joint":
            xml.append(_joint(element))
        elif element.tag == "link":
            xml.append(_link(element, faulty))
    return ET.tostring(xml, encoding="unicode")


def _joint(given: ET.Element) -> ET.Element:
    joint = copy.deepcopy(given)
    continuous = joint.get("type") == CONTINUOUS
    if continuous:
        joint.set("type", "revolute")
    limit = joint.find("limit")
    if joint.get("type") == "fixed":
        if limit is not None:  # of a joint that stands still now; it may be incomplete
            joint.remove(limit)
    else:
        if limit is None:
            limit = ET.SubElement(joint, "limit")
        for attribute in ("effort", "velocity"):
            limit.set(attribute, limit.get(attribute, "0"))
        if continuous:
            limit.set("lower", str(-_NO_LIMIT))
            limit.set("upper", str(_NO_LIMIT))
    return joint


def _link(given: ET.Element, faulty: set[str | None]) -> ET.Element:
    link = copy.deepcopy(given)
    for visual in link.findall("visual"):
        link.remove(visual)
    inertial = link.find("inertial")
    field = f"link[{link.get('name')}].inertial"
    if inertial is not None and any((f or "").startswith(field) for f in faulty):
        link.remove(inertial)
    for collision in link.findall("collision"):
        geometry = collision.find("geometry")
        assert geometry is not None  # checked
        if geometry[0].tag in ("mesh", "capsule"):
            geometry[:] = [ET.Element("sphere", {"radius": "0.001"})]
    return link
