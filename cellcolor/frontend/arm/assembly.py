"""Arm and tool as one tree: mounted, with joints that stand still, and as Pinocchio's model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf import FIXED, PRISMATIC, Joint, Urdf, pose
from cellcolor.frontend.tables import Vector

_FLANGES = ("tool0", "flange", "ee_link", "tool_flange", "wrist_3_link", "link_6")  # of vendors

FIX = "give its position under [robot.fixed_joints], as {} = 0.0"
"""What to do about a joint that may not move, by its name."""


def mount(arm: Urdf, flange: str, tool: Urdf, position: Vector, rpy: Vector) -> Urdf:
    """The tool's tree fixed to the arm's flange link.

    Args:
        position: of the tool's root link in the frame of the flange link, m.
        rpy: its angles there, rad, extrinsic x, y, z.

    Raises:
        InputError: the arm has no such link, or arm and tool share a name.
    """
    if flange not in arm.links:
        usual = [name for name in _FLANGES if name in arm.above]
        carrying = {joint.parent for joint in arm.above.values()}
        ends = [name for name in arm.above if name not in carrying]
        known = ", ".join(map(repr, dict.fromkeys([*usual, *ends])))
        message = f"the flange link is not in the arm, which has {known}"
        raise InputError(str(arm.file), f"link[{flange}]", message)
    shared = [f"link[{name}]" for name in tool.links if name in arm.links]
    shared += [f"joint[{name}]" for name in tool.joints if name in arm.joints]
    if shared:
        raise InputError(str(tool.file), shared[0], f"{arm.file.name} has that name too")
    joint = Joint("", tool.file, flange, tool.root, pose(position, rpy))
    return replace(
        arm,
        links=arm.links | tool.links,
        joints=arm.joints | tool.joints,
        above=arm.above | tool.above | {tool.root: joint},
    )


def settled(urdf: Urdf, positions: Mapping[str, float]) -> Urdf:
    """The tree with all joints that stand still as fixed ones, so that none follows another one.

    What follows such a joint stands still as well. A leader that is a fixed joint is at zero.

    Args:
        positions: of joints that are fixed, rad, or m of prismatic ones.

    Raises:
        InputError: a position is outside of the joint's limits; or a joint follows one that moves,
            one that is not there, or itself.
    """
    joints, still = urdf.joints, {}
    for name, joint in joints.items():
        if name in positions:
            _check_position(joint, positions[name])
        leader, factor, offset, seen = joint, 1.0, 0.0, {name}
        while leader.follows is not None and leader.name not in positions:
            followed, multiplier, more = leader.follows
            if followed not in joints or followed in seen:
                fault = "follows itself" if followed in seen else f"no joint {followed!r}"
                raise joint.refused(fault, ".mimic")
            factor, offset = factor * multiplier, offset + factor * more
            leader = joints[followed]
            seen.add(followed)
        if leader.kind != FIXED and leader.name not in positions and factor:
            if leader is joint:
                continue
            fault = f"follows {leader.name!r}, which moves: {FIX.format(name)}"
            raise joint.refused(fault, ".mimic")
        place = joint.at(factor * positions.get(leader.name, 0.0) + offset)
        still[name] = replace(joint, kind=FIXED, place=place, follows=None)
    above = {link: still.get(joint.name, joint) for link, joint in urdf.above.items()}
    return replace(urdf, joints=joints | still, above=above)


def _check_position(joint: Joint, position: float) -> None:
    """Refuse a position of a fixed joint outside of the joint's limits; names the setup's key."""
    if not joint.lower <= position <= joint.upper:
        message = f"{position:g} is outside the joint's limits, {joint.lower:g} to {joint.upper:g}"
        if joint.kind != PRISMATIC and abs(position) > 2 * math.pi:
            message += f": {looks_like_degrees(position)}"
        raise InputError(None, f"robot.fixed_joints.{joint.name}", message)


def pinocchio_model(urdf: Urdf) -> pin.Model:
    """Pinocchio's model of the joints that move, with masses, and a frame for each link."""
    model, links = pin.Model(), [urdf.root]
    for name in links:  # which grows by the links that hang on this one
        links += [joint.child for joint in urdf.above.values() if joint.parent == name]
        link, above, number, place, over = urdf.links[name], urdf.above.get(name), 0, _HERE, 0
        if above is not None:
            over = model.getFrameId(above.parent, pin.FrameType.BODY)
            number = model.frames[over].parentJoint
            place = model.frames[over].placement * above.place
        if above is not None and above.kind != FIXED:
            slides = above.kind == PRISMATIC
            kind = pin.JointModelPrismaticUnaligned if slides else pin.JointModelRevoluteUnaligned
            number = model.addJoint(number, kind(above.axis), place, above.name)
            over, place = model.addJointFrame(number, over), _HERE
        # No inertia is asked for.
        inertia = pin.Inertia(link.mass, link.center, np.zeros((3, 3)))
        model.appendBodyToJoint(number, inertia, place)
        model.addBodyFrame(name, number, place, over)
    return model


_HERE = pin.SE3.Identity()
_AHEAD = 1e-3  # m; so far along the axis the flange is at least from what shows its sense


def last_axis(urdf: Urdf, flange: str) -> tuple[Array, Array]:
    """The last axis (3,) before the flange, in its frame, and how far beside it the flange is, m.

    The axis points outward with all joints at zero.
    """
    model = pinocchio_model(urdf)
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.zeros(model.nq))
    frame = model.frames[model.getFrameId(flange, pin.FrameType.BODY)]
    if not frame.parentJoint:
        return np.array([0.0, 0.0, 1.0]), np.zeros(3)
    joint = urdf.joints[model.names[frame.parentJoint]]
    axis = frame.placement.rotation.T @ joint.axis
    at = {each.name: data.oMf[number] for number, each in enumerate(model.frames)}
    before = urdf.chain(flange)[: urdf.chain(flange).index(joint.child) + 1]
    ways = [at[flange].actInv(at[link]).translation for link in reversed(before)]
    beside = (ways[0] @ axis) * axis - ways[0]
    ahead = next((far for way in ways if abs(far := -axis @ way) > _AHEAD), 1.0)
    return np.asarray(axis * np.sign(ahead)), np.asarray(beside)
