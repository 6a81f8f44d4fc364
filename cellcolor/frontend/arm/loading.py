"""Arm and tool from their URDFs as one arm: mounted, joints fixed, checked, as plain arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import Body, place_shapes
from cellcolor.frontend.arm.notes import notes_on_tool
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import FIXED, PRISMATIC, Joint, Urdf, pose
from cellcolor.frontend.setup import RobotFiles
from cellcolor.frontend.tables import Vector

_FLANGES = ("tool0", "flange", "ee_link", "tool_flange", "wrist_3_link", "link_6")  # of vendors
_FASTEST = 60.0  # rad/s
_MOST_DEGREES = 800.0  # per second; beyond, as 1000, a velocity means that there is no limit
_NO_FORCE = "or leave the force constraint out: force = false under [constraints] of the setup"
_WAY_OUT = (
    "; with more the arm is redundant, has endlessly many configurations for one pose, and colors "
    "are not defined: make the joints that are too many fixed, at angles of your choice, under "
    "[robot.fixed_joints]"
)
_FIX = "give its position under [robot.fixed_joints], as {} = 0.0"  # a joint that may not move


def load_robot(
    arm: Urdf,
    tool: Urdf,
    files: RobotFiles,
    joints: int = 6,
    prismatic: int = 0,
    *,
    folder: Path = Path(),
    force: bool = True,
) -> Robot:
    """Put the tool on the arm's flange.

    Args:
        files: how, which joints stand still, and what collides.
        joints: how many there are between base and tip, the prismatic ones included.
        folder: what the names of package folders are relative to.
        force: whether forces are asked for, so that masses and efforts have to be known.

    Raises:
        InputError: no such flange or tip link, not so many joints of either kind between base and
            tip, one elsewhere that moves, one that follows it, or a mesh that cannot be found or
            read.
    """
    for name in files.fixed_joints:
        joint = arm.joints.get(name, tool.joints.get(name))
        if joint is None or joint.kind == FIXED:
            message = "no such joint in arm and tool, or a fixed one"
            raise InputError(None, f"robot.fixed_joints.{name}", message)
    if files.tip_link not in tool.links:
        message = "the tip link is not in the tool"
        raise InputError(str(tool.file), f"link[{files.tip_link}]", message)
    whole = mount(arm, files.flange_link, tool, files.mount_position_m, files.mount_rpy_rad)
    whole = settled(whole, files.fixed_joints)
    _check_chain(whole, tool, files.tip_link, (joints - prismatic, prismatic))
    for fault in weight_faults(whole) if force else ():
        raise InputError(fault.file, fault.field, f"{fault.message} ({_NO_FORCE})")
    model = pinocchio_model(whole)
    bodies = place_shapes(whole, model, files, folder)
    tip = model.frames[model.getFrameId(files.tip_link, pin.FrameType.BODY)]
    own = [whole.joints[name] for name in model.names[1:]]
    robot = Robot(
        files=(arm.file, tool.file),
        placement=np.array([each.homogeneous for each in list(model.jointPlacements)[1:]]),
        axis=np.array([joint.axis for joint in own]).reshape(-1, 3),
        slides=np.array([joint.kind == PRISMATIC for joint in own], dtype=bool),
        lower=np.array([joint.lower for joint in own]),
        upper=np.array([joint.upper for joint in own]),
        velocity=np.array([joint.velocity for joint in own]),
        effort=np.array([joint.effort for joint in own]),
        mass=np.array([each.mass for each in list(model.inertias)[1:]]),
        center=np.array([each.lever for each in list(model.inertias)[1:]]),
        tip=np.array(tip.placement.homogeneous),
        bodies=bodies,
        tested_pairs=_tested_pairs(whole, bodies, files.may_touch),
        joint_names=tuple(joint.name for joint in own),
        warnings=_warnings(whole, own),
        model=model,
        tool_links=frozenset(link.name for link in tool.links.values() if link.shapes),
    )
    notes = notes_on_tool(robot, tool.root, files.tip_link)
    return replace(robot, warnings=robot.warnings + notes)


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
            fault = f"follows {leader.name!r}, which moves: {_FIX.format(name)}"
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


def _check_chain(whole: Urdf, tool: Urdf, tip_link: str, wanted: tuple[int, int]) -> None:
    """Require these numbers of turning and prismatic joints from base to tip, none elsewhere."""
    in_chain = [whole.above[link] for link in whole.chain(tip_link)[1:]]
    moving = whole.leading.values()
    for joint in moving:
        if joint.name in tool.joints:
            raise joint.refused(f"a tool may not move: {_FIX.format(joint.name)}")
        if joint not in in_chain:
            raise joint.refused(f"it moves beside the chain to the tip: {_FIX.format(joint.name)}")
        if joint.kind == PRISMATIC and not wanted[1]:
            message = (
                "prismatic, in arms of this family only turning joints may move: "
                f"{_FIX.format(joint.name)}, or name one whose arms have such a joint, as 'scara'"
            )
            raise joint.refused(message, ".type")
    sliding = sum(joint.kind == PRISMATIC for joint in moving)
    found = len(moving) - sliding, sliding
    if found != wanted:
        having = _counted(found) if max(wanted[1], sliding) else str(found[0])
        message = f"needs {_counted(wanted)} in a row to the tip, has {having}"
        way_out = _WAY_OUT if sum(found) > sum(wanted) else ""
        raise InputError(str(whole.file), "robot", message + way_out)


def _counted(joints: tuple[int, int]) -> str:
    """Numbers of turning and prismatic joints in words."""
    turning, sliding = joints
    return f"{turning} revolute joints" + (f" and {sliding} prismatic" if sliding else "")


def weight_faults(urdf: Urdf) -> list[InputError]:
    """What keeps the force constraint from being tested; what nothing moves may weigh anything.

    Args:
        urdf: with all joints fixed that stand still.
    """
    moving = urdf.leading.values()
    driven = {joint.child for joint in moving}
    owners = [(joint.file, joint.powerless) for joint in moving]
    owners += [
        (link.file, link.weightless)
        for name, link in urdf.links.items()
        if name in driven or (link.shapes and not driven.isdisjoint(urdf.chain(name)))
    ]
    return [fault.in_file(str(file)) for file, fault in owners if fault is not None]


_HERE = pin.SE3.Identity()


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


def _warnings(whole: Urdf, joints: list[Joint]) -> tuple[str, ...]:
    """What a user would want to know of the files: links without shapes, velocities in degrees.

    Args:
        joints: those that move.
    """
    moving = {joint.child for joint in joints}
    bare = [
        repr(name)
        for name, link in whole.links.items()
        if not link.shapes and (name in moving or link.real)
    ]
    found = []
    if not any(link.shapes for link in whole.links.values()):
        found.append("arm and tool have no collision shapes at all: nothing is ever hit")
    elif bare:
        found.append(f"no collision shape, so hits nothing: {', '.join(bare)}")
    fast = [
        f"{joint.name!r} {joint.velocity:g} rad/s"
        for joint in joints
        if joint.kind != PRISMATIC and _FASTEST < joint.velocity <= _MOST_DEGREES
    ]
    if fast:
        found.append(f"faster than arms turn; are these degrees per second? {', '.join(fast)}")
    return tuple(found)


def _tested_pairs(
    urdf: Urdf, bodies: tuple[Body, ...], may_touch: tuple[tuple[str, str], ...]
) -> tuple[tuple[int, int], ...]:
    """All pairs but of bodies that do not move against each other, or of links that may touch.

    So may neighbors, links with no solid link in between.
    """
    solid = [name for name, link in urdf.links.items() if link.shapes]
    for number, pair in enumerate(may_touch):
        for link in pair:
            if link not in solid:
                message = f"no link {link!r} with a collision shape"
                raise InputError(None, f"robot.may_touch[{number}]", message)
    allowed = {frozenset(pair) for pair in may_touch}
    for link in solid:
        above = [other for other in urdf.chain(link)[:-1] if other in solid]
        allowed.update(frozenset((link, other)) for other in above[-1:])
    return tuple(
        (i, j)
        for i, first in enumerate(bodies)
        for j, second in enumerate(bodies[i + 1 :], i + 1)
        if first.link != second.link
        and first.joint != second.joint
        and {first.link, second.link} not in allowed
    )


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
