"""Arm and tool from their URDFs: checked as one chain, and read by Pinocchio."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.assembly import (
    FIX,
    Vector,
    check_position,
    mount,
    pinocchio_models,
    settled,
)
from cellcolor.frontend.arm.body import Body, Shapes, place_shapes
from cellcolor.frontend.arm.notes import notes_on_tool
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import (
    PRISMATIC,
    Urdf,
    effort_fault,
    inertial_fault,
    limits_of,
    load_urdf,
)

_FASTEST = 60.0  # rad/s
_MOST_DEGREES = 800.0  # per second; beyond, as 1000, a velocity means that there is no limit
_REAL = ("inertial", "visual")  # what a link has that is more than a frame
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
        force: whether forces are asked for, so that masses and efforts have to be known.

    Raises:
        InputError: a fault in either URDF (see :mod:`cellcolor.frontend.arm.urdf`), no such tip
            link, not so many joints of either kind between base and tip, one elsewhere that moves,
            one that follows it, a mesh that cannot be found or read, or Pinocchio read other
            collision shapes than the file has.
    """
    arm, tool = (given if isinstance(given, Urdf) else load_urdf(given) for given in (arm, tool))
    positions = fixed_joints or {}
    for name, position in positions.items():
        tree = arm if name in arm.kinds else tool
        if name not in tree.kinds:
            message = "no such joint in arm and tool, or a fixed one"
            raise InputError(None, f"robot.fixed_joints.{name}", message)
        if name not in tree.followers:
            check_position(tree, name, position)
    if tip_link not in tool.links:
        raise InputError(str(tool.file), f"link[{tip_link}]", "the tip link is not in the tool")
    whole = mount(arm, flange_link, tool, *mounted)
    with _naming_file(arm, tool):
        standing = settled(whole, positions)
        _check_chain(whole, standing, tool, tip_link, (joints - prismatic, prismatic))
        for fault in weight_faults(whole, standing) if force else ():
            raise InputError(None, fault.field, f"{fault.message} ({_NO_FORCE})")
        model, geometry = pinocchio_models(whole, standing)
    bodies, stand_ins = place_shapes((arm, tool), whole, model, geometry, shapes or Shapes())
    tip = model.frames[model.getFrameId(tip_link, pin.FrameType.BODY)]
    axes = _axes(model)
    names = tuple(model.names[1:])
    lower, upper = np.array([limits_of(whole.joints[name]) for name in names]).reshape(-1, 2).T
    slides = np.array([whole.kinds[name] == PRISMATIC for name in names], dtype=bool)
    return Robot(
        files=(arm.file, tool.file),
        placement=np.array([each.homogeneous for each in list(model.jointPlacements)[1:]]),
        axis=axes,
        slides=slides,
        lower=lower,
        upper=upper,
        velocity=_where_given(model.velocityLimit),
        effort=_where_given(model.effortLimit),
        mass=np.array([each.mass for each in list(model.inertias)[1:]]),
        center=np.array([each.lever for each in list(model.inertias)[1:]]),
        tip=np.array(tip.placement.homogeneous),
        bodies=bodies,
        tested_pairs=_tested_pairs(whole, bodies, may_touch),
        joint_names=names,
        warnings=_warnings(whole, standing)
        + _in_degrees(names, slides, model.velocityLimit)
        + notes_on_tool(model, tool.root, tip_link, axes),
        model=model,
        geometry=geometry,
        stand_ins=stand_ins,
        tool_links=frozenset(tool.shapes),
    )


@contextmanager
def _naming_file(arm: Urdf, tool: Urdf) -> Iterator[None]:
    """Give errors about a joint or link of arm and tool as one tree the file that has it."""
    try:
        yield
    except InputError as error:
        if error.file is not None:
            raise
        places = [f"joint[{name}]" for name in tool.joints] + [f"link[{n}]" for n in tool.links]
        of_tool = (error.field or "").startswith(tuple(places))
        raise error.in_file(str((tool if of_tool else arm).file)) from error


def _check_chain(
    whole: Urdf, standing: Mapping[str, float], tool: Urdf, tip_link: str, wanted: tuple[int, int]
) -> None:
    """Require these numbers of turning and prismatic joints from base to tip, none elsewhere."""
    in_chain = [whole.joint_above[link] for link in whole.chain(tip_link)[1:]]

    def refuse(name: str, key: str, message: str) -> InputError:
        return InputError(None, f"joint[{name}]{key}", message)

    kinds = {name: kind for name, kind in whole.leading.items() if name not in standing}
    for name, kind in kinds.items():
        if name in tool.kinds:
            raise refuse(name, "", f"a tool may not move: {FIX.format(name)}")
        if name not in in_chain:
            raise refuse(name, "", f"it moves beside the chain to the tip: {FIX.format(name)}")
        if kind == PRISMATIC and not wanted[1]:
            message = (
                "prismatic, in arms of this family only turning joints may move: "
                f"{FIX.format(name)}, or name one whose arms have such a joint, as 'scara'"
            )
            raise refuse(name, ".type", message)
    sliding = sum(kind == PRISMATIC for kind in kinds.values())
    found = len(kinds) - sliding, sliding
    if found != wanted:
        having = _counted(found) if max(wanted[1], sliding) else str(found[0])
        message = f"needs {_counted(wanted)} in a row to the tip, has {having}"
        way_out = _WAY_OUT if sum(found) > sum(wanted) else ""
        raise InputError(None, "robot", message + way_out)


def _counted(joints: tuple[int, int]) -> str:
    """Numbers of turning and prismatic joints in words."""
    turning, sliding = joints
    return f"{turning} revolute joints" + (f" and {sliding} prismatic" if sliding else "")


def weight_faults(urdf: Urdf, standing: Mapping[str, float]) -> list[InputError]:
    """What keeps the force constraint from being tested; what nothing moves may weigh anything.

    Args:
        standing: joints that stand still.
    """
    moving = [name for name in urdf.leading if name not in standing]
    driven = {link for link, name in urdf.joint_above.items() if name in moving}
    faults = [effort_fault(urdf.joints[name]) for name in moving]
    faults += [
        inertial_fault(link)
        for name, link in urdf.links.items()
        if name in driven or (name in urdf.shapes and not driven.isdisjoint(urdf.chain(name)))
    ]
    return [fault for fault in faults if fault is not None]


def _where_given(limits: Array) -> Array:
    """Limits (joints,), NaN where the file has none; vendors write 0 as well."""
    return np.where(limits > 0, limits, np.nan)


def _warnings(whole: Urdf, standing: Mapping[str, float]) -> tuple[str, ...]:
    """What a user would want to know of the files: links without shapes that are things."""
    if not whole.shapes:
        return ("arm and tool have no collision shapes at all: nothing is ever hit",)
    moving = whole.leading.keys() - standing
    bare = [
        name
        for name, link in whole.links.items()
        if name not in whole.shapes
        and (whole.joint_above.get(name) in moving or any(x.tag in _REAL for x in link))
    ]
    if bare:
        return (f"no collision shape, so hits nothing: {', '.join(map(repr, bare))}",)
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
