"""Arm and tool from their URDFs: checked as one chain, and read by Pinocchio."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, Mask
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.assembly import Vector, fix_joints, mount, pinocchio_text
from cellcolor.frontend.arm.body import Body, Shapes, place_shapes
from cellcolor.frontend.arm.robot import FollowingFrame, Robot
from cellcolor.frontend.arm.tool_sense import notes_on_tool
from cellcolor.frontend.arm.urdf import (
    CONTINUOUS,
    PRISMATIC,
    Follower,
    Urdf,
    axis_of,
    check_follower,
    load_urdf,
)

_FASTEST = 60.0  # rad/s
_MOST_DEGREES = 800.0  # per second; beyond, as 1000, a velocity means that there is no limit
_FIX = "give its position under [robot.fixed_joints], as {} = 0.0"
_NO_FORCE = "or leave the force constraint out: force = false under [constraints] of the setup"
_WAY_OUT = (
    "; with more the arm is redundant, has endlessly many configurations for one pose, and colors "
    "are not defined: make the joints that are too many fixed, at angles of your choice, under "
    "[robot.fixed_joints]"
)


def load_robot(
    arm: Path | Urdf,
    flange_link: str,
    tool: Path | Urdf,
    tip_link: str,
    joints: int = 6,
    *,
    mounted: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    fixed_joints: Mapping[str, float] | None = None,
    shapes: Shapes | None = None,
    may_touch: tuple[tuple[str, str], ...] = (),
    force: bool = True,
    prismatic: int = 0,
) -> Robot:
    """Put the tool on the arm's flange, both from files or as they have been read.

    Args:
        mounted: position in m and angles in rad (extrinsic x, y, z) of the tool's root link in the
            frame of the flange link.
        fixed_joints: positions of joints that do not move, rad, or m of prismatic ones.
        shapes: how meshes collide; as hulls without it.
        may_touch: pairs of links that are not tested against each other.
        force: whether forces are asked for, so that masses and efforts have to be known.
        prismatic: how many of the joints are prismatic.

    Raises:
        InputError: a fault in either URDF (see :mod:`cellcolor.frontend.arm.urdf`), no such tip
            link, not so many joints of either kind between base and tip, one there that follows
            another, one elsewhere that moves, a mesh that cannot be found or read, or
            Pinocchio read other collision shapes than the file has.
    """
    arm, tool = (given if isinstance(given, Urdf) else load_urdf(given) for given in (arm, tool))
    positions = fixed_joints or {}
    for name in positions:
        if not any(name in tree.kinds or name in tree.followers for tree in (arm, tool)):
            message = "no such joint in arm and tool, or a fixed one"
            raise InputError(None, f"robot.fixed_joints.{name}", message)
    if positions:
        arm, tool = fix_joints(arm, positions), fix_joints(tool, positions)
    arm_file, tool_file = arm.file, tool.file
    if tip_link != tool.root and tip_link not in tool.parent:
        raise InputError(str(tool_file), f"link[{tip_link}]", "the tip link is not in the tool")
    whole = mount(arm, flange_link, tool, *mounted)
    try:
        moving, standing = whole.settled_followers()
    except InputError as error:
        raise _in_its_file(error, arm, tool) from error
    whole = fix_joints(whole, standing)
    _check_chain(whole, arm, tool, tip_link, (joints - prismatic, prismatic))
    if force and whole.weightless:
        fault = whole.weightless[0]
        message = f"{fault.message} ({_NO_FORCE})"
        raise _in_its_file(InputError(None, fault.field, message), arm, tool)
    if force:
        _check_weight(whole, moving, arm, tool)
    text = pinocchio_text(whole)
    try:
        model = pin.buildModelFromXML(text)
        geometry = pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)
    except (ValueError, RuntimeError) as error:
        raise InputError(str(arm_file), "robot", f"Pinocchio refuses it: {error}") from error
    bodies, stand_ins = place_shapes((arm, tool), whole, model, geometry, shapes or Shapes())
    limits = model.lowerPositionLimit, model.upperPositionLimit
    try:
        frames = following_frames(whole, moving, model)
        lower, upper = within_limits(whole, moving, frames, *limits)
    except InputError as error:
        raise _in_its_file(error, arm, tool) from error
    # Bodies behind a follower hang on its frame; where they are at zero stays the same.
    number = {frame.link: joints + 1 + index for index, frame in enumerate(frames)}
    bodies = tuple(
        replace(body, joint=_carrier(whole, body.link, number, body.joint)) for body in bodies
    )
    tip = model.frames[model.getFrameId(tip_link, pin.FrameType.BODY)]
    axes = _axes(model)
    names = tuple(model.names[1:])
    slides = np.array([whole.kinds[name] == PRISMATIC for name in names], dtype=bool)
    endless = np.array([whole.kinds[name] == CONTINUOUS for name in names], dtype=bool)
    return Robot(
        files=(arm_file, tool_file),
        placement=np.array([model.jointPlacements[i].homogeneous for i in range(1, joints + 1)]),
        axis=axes,
        slides=slides,
        lower=np.where(endless & (lower <= limits[0]), -np.inf, lower),
        upper=np.where(endless & (upper >= limits[1]), np.inf, upper),
        velocity=_where_given(model.velocityLimit),
        effort=_where_given(model.effortLimit),
        mass=np.array([model.inertias[i].mass for i in range(1, joints + 1)]),
        center=np.array([model.inertias[i].lever for i in range(1, joints + 1)]),
        tip=np.array(tip.placement.homogeneous),
        bodies=bodies,
        tested_pairs=_tested_pairs(whole, bodies, may_touch),
        joint_names=names,
        warnings=_warnings(whole)
        + _in_degrees(names, slides, model.velocityLimit)
        + notes_on_tool(model, tool.root, tip_link, axes),
        model=model,
        geometry=geometry,
        stand_ins=stand_ins,
        followers=frames,
        tool_links=frozenset(tool.shapes),
    )


def _check_chain(
    whole: Urdf, arm: Urdf, tool: Urdf, tip_link: str, wanted: tuple[int, int]
) -> None:
    """Require these numbers of turning and prismatic joints from base to tip, none elsewhere."""
    in_chain = [whole.joint_above[link] for link in whole.chain(tip_link)[1:]]

    def refuse(name: str, key: str, message: str) -> InputError:
        return _in_its_file(InputError(None, f"joint[{name}]{key}", message), arm, tool)

    for name in in_chain:
        if name in whole.locked:
            message = (
                f"a joint between base and tip may not follow another one (here "
                f"{whole.followers[name].leader!r}): no family of arms solves that"
            )
            raise refuse(name, ".mimic", message)
    for name, kind in whole.kinds.items():
        if name in tool.kinds:
            raise refuse(name, "", f"a tool may not move: {_FIX.format(name)}")
        if name not in in_chain:
            raise refuse(name, "", f"it moves beside the chain to the tip: {_FIX.format(name)}")
        if kind == PRISMATIC and not wanted[1]:
            message = (
                "prismatic, in arms of this family only turning joints may move: "
                f"{_FIX.format(name)}, or name one whose arms have such a joint, as 'scara'"
            )
            raise refuse(name, ".type", message)
    sliding = sum(kind == PRISMATIC for kind in whole.kinds.values())
    found = len(whole.kinds) - sliding, sliding
    if found != wanted:
        having = _counted(found) if max(wanted[1], sliding) else str(found[0])
        message = f"needs {_counted(wanted)} in a row to the tip, has {having}"
        way_out = _WAY_OUT if sum(found) > sum(wanted) else ""
        raise InputError(str(arm.file), "robot", message + way_out)


def _in_its_file(error: InputError, arm: Urdf, tool: Urdf) -> InputError:
    """An error about a joint or link of arm and tool as one tree, with the file that has it."""
    places = [f"joint[{name}]" for name in tool.joint_above.values()]
    places += [f"link[{name}]" for name in (tool.root, *tool.parent)]
    of_tool = (error.field or "").startswith(tuple(places))
    return InputError(str((tool if of_tool else arm).file), error.field, error.message)


def _check_weight(whole: Urdf, moving: Mapping[str, Follower], arm: Urdf, tool: Urdf) -> None:
    """Refuse followers with a mass: the force constraint has it where they are at zero."""
    heavy = {
        link.get("name", "")
        for link in whole.xml.findall("link")
        if link.find("inertial") is not None
    }
    for link in whole.parent:
        above = [whole.joint_above[each] for each in whole.chain(link)[1:]]
        for name in [each for each in above if each in moving and link in heavy]:
            message = f"the weight of what follows another joint is not known to move ({_NO_FORCE})"
            raise _in_its_file(InputError(None, f"joint[{name}].mimic", message), arm, tool)


def _counted(joints: tuple[int, int]) -> str:
    """Numbers of turning and prismatic joints in words."""
    turning, sliding = joints
    return f"{turning} revolute joints" + (f" and {sliding} prismatic" if sliding else "")


def _where_given(limits: Array) -> Array:
    """Limits (joints,), NaN where the file has none; vendors write 0 as well."""
    return np.where(limits > 0, limits, np.nan)


def _warnings(urdf: Urdf) -> tuple[str, ...]:
    """What a user would want to know of the files."""
    if not urdf.shapes:
        return ("arm and tool have no collision shapes at all: nothing is ever hit",)
    if urdf.shapeless:
        return (f"no collision shape, so hits nothing: {', '.join(map(repr, urdf.shapeless))}",)
    return ()


def _in_degrees(names: tuple[str, ...], slides: Mask, velocity: Array) -> tuple[str, ...]:
    """A warning of joints that turn faster than any: their velocity may be in degrees."""
    found = [
        f"{name!r} {limit:g} rad/s"
        for name, limit in zip(names, np.where(slides, 0.0, velocity).tolist(), strict=True)
        if _FASTEST < limit <= _MOST_DEGREES
    ]
    if not found:
        return ()
    return (f"faster than arms turn; are these degrees per second? {', '.join(found)}",)


def _axes(model: pin.Model) -> Array:
    """Each joint's axis in its own frame, from the world Jacobian at zero.

    A prismatic joint turns nothing, and all that it carries moves along its axis.
    """
    data = model.createData()
    zero = np.zeros(model.nv)
    jacobian = pin.computeJointJacobians(model, data, zero)
    linear, angular = jacobian[:3], jacobian[3:]
    axes = np.where(np.abs(angular).max(axis=0) > 0, angular, linear)
    return np.array([data.oMi[i + 1].rotation.T @ axes[:, i] for i in range(model.nv)])


def _tested_pairs(
    urdf: Urdf, bodies: tuple[Body, ...], may_touch: tuple[tuple[str, str], ...]
) -> tuple[tuple[int, int], ...]:
    """All pairs but of bodies that do not move against each other, or of links that may touch.

    So may neighbors, links with no solid link in between.
    """
    for number, pair in enumerate(may_touch):
        for link in pair:
            if link not in urdf.shapes:
                message = f"no link {link!r} with a collision shape"
                raise InputError(None, f"robot.may_touch[{number}]", message)
    allowed = {frozenset(pair) for pair in may_touch}
    solid_above = {}
    for link in urdf.shapes:
        above = [other for other in urdf.chain(link)[:-1] if other in urdf.shapes]
        solid_above[link] = above[-1] if above else None
    return tuple(
        (i, j)
        for i, first in enumerate(bodies)
        for j, second in enumerate(bodies[i + 1 :], i + 1)
        if first.link != second.link
        and first.joint != second.joint
        and {first.link, second.link} not in allowed
        and solid_above[first.link] != second.link
        and solid_above[second.link] != first.link
    )


def following_frames(
    urdf: Urdf, moving: Mapping[str, Follower], model: pin.Model
) -> tuple[FollowingFrame, ...]:
    """The frames of all followers that move, each behind the frame that carries it.

    Args:
        urdf: arm and tool as one tree, where followers are fixed at zero.
        moving: those of them that move.
        model: Pinocchio's reading of the tree.

    Raises:
        InputError: one has no usable axis or limits.
    """
    names = list(model.names[1:])
    joints = {joint.get("name", ""): joint for joint in urdf.xml.findall("joint")}
    below = {name: link for link, name in urdf.joint_above.items()}
    number: dict[str, int] = {}
    found: list[FollowingFrame] = []
    for name in sorted(moving, key=lambda name: len(urdf.chain(below[name]))):
        own, link = moving[name], below[name]
        with naming(urdf.file):
            check_follower(name, joints[name], own.kind)
        frame = model.frames[model.getFrameId(name, pin.FrameType.FIXED_JOINT)]
        parent = _carrier(urdf, urdf.parent[link], number, int(frame.parentJoint))
        number[link] = model.njoints + len(found)
        found.append(
            FollowingFrame(
                link=link,
                parent=parent,
                placement=np.array(frame.placement.homogeneous),
                axis=np.array([float(part) for part in axis_of(joints[name]).split()]),
                slides=own.kind == PRISMATIC,
                leader=names.index(own.leader),
                multiplier=own.multiplier,
                offset=own.offset,
            )
        )
    return tuple(found)


def _carrier(urdf: Urdf, link: str, number: Mapping[str, int], joint: int) -> int:
    """The frame of the last follower between a link and its moving joint, or of that joint."""
    for each in reversed(urdf.chain(link)):
        if each in number:
            return number[each]
        if urdf.joint_above.get(each) in urdf.kinds:
            break
    return joint


def within_limits(
    urdf: Urdf,
    moving: Mapping[str, Follower],
    frames: tuple[FollowingFrame, ...],
    lower: Array,
    upper: Array,
) -> tuple[Array, Array]:
    """Limits (joints,) of the chain in which its followers are inside of theirs as well.

    Raises:
        InputError: there is no position of a leader where its follower is inside, or the leader can
            turn by more than a circle and the follower is elsewhere after a full one.
    """
    lower, upper = lower.copy(), upper.copy()
    joints = {joint.get("name", ""): joint for joint in urdf.xml.findall("joint")}
    for frame in frames:
        name = urdf.joint_above[frame.link]
        limit = joints[name].find("limit")
        at, field = frame.leader, f"joint[{name}].mimic"
        if limit is not None and moving[name].kind != CONTINUOUS:
            ends = [float(limit.get(end, "nan")) for end in ("lower", "upper")]
            low, high = sorted((end - frame.offset) / frame.multiplier for end in ends)
            lower[at], upper[at] = max(lower[at], low), min(upper[at], high)
        if lower[at] >= upper[at]:
            message = "is inside its limits nowhere between those of the joint that it follows"
            raise InputError(str(urdf.file), field, message)
    for frame in frames:
        name = urdf.joint_above[frame.link]
        leader = moving[name].leader
        turns_with = not frame.slides and frame.multiplier == round(frame.multiplier)
        full = upper[frame.leader] - lower[frame.leader] > 2 * np.pi + 1e-9
        if urdf.kinds[leader] != PRISMATIC and full and not turns_with:
            message = (
                f"{leader!r} turns by more than a circle, and this joint is elsewhere then: give "
                "one of them narrower limits"
            )
            raise InputError(str(urdf.file), f"joint[{name}].mimic", message)
    return lower, upper
