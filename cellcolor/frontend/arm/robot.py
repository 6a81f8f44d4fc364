"""The arm with its tool as plain arrays, taken from Pinocchio's reading of the URDF."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array, Index, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.assembly import Vector, fix_joints, mount, pinocchio_text
from cellcolor.frontend.arm.body import Body, StandIn
from cellcolor.frontend.arm.followers import (
    FollowingFrame,
    following_frames,
    hung_on,
    within_limits,
)
from cellcolor.frontend.arm.placed_shapes import Shapes, place_shapes
from cellcolor.frontend.arm.task_space import FREE_TURN, TaskSpace
from cellcolor.frontend.arm.urdf import CONTINUOUS, PRISMATIC, Follower, Urdf, load_urdf

_FIX = "give its position under [robot.fixed_joints], as {} = 0.0"
_NO_FORCE = "or leave the force constraint out: force = false under [constraints] of the setup"
_WAY_OUT = (
    "; with more the arm is redundant, has endlessly many configurations for one pose, and colors "
    "are not defined: make the joints that are too many fixed, at angles of your choice, under "
    "[robot.fixed_joints]"
)


@dataclass(frozen=True)
class Robot:
    """Joints in a row, a tool, and what collides. The world frame is the root link.

    Attributes:
        placement: (joints, 4, 4) fixed pose of each joint frame in the one before it.
        axis: (joints, 3) unit axis of each joint in its own frame.
        slides: (joints,) which joints are prismatic; the others turn.
        lower, upper: (joints,) joint limits in rad, infinite for continuous joints; in m of
            prismatic ones.
        velocity: (joints,) limits in rad/s or m/s, NaN where the file has none.
        effort: (joints,) limits of torques in N m or forces in N, NaN where the file has none.
        mass: (joints,) mass that each joint's frame carries, in kg; fixed links and tool included.
        center: (joints, 3) its center of mass in that frame, m.
        tip: (4, 4) pose of the tool tip in the frame of the last joint; the tool works along +z.
        bodies: collision shapes, base first.
        tested_pairs: pairs of bodies (indices) that self-collision looks at: all that do not
            belong to one link or to links next to each other.
        joint_names: names of the joints.
        warnings: what its files have that is probably not meant, a sentence each.
        model, geometry: Pinocchio's own, for those who want to compute independently; meshes and
            capsules are small spheres there, and followers stand at zero.
        stand_ins: what collides in the place of meshes.
        tool_links: the links of the tool that have a body.
        followers: frames beside the chain that move with its joints; bodies hang on them too.
        task: what it is asked to do with the tool; :func:`load_robot` leaves the turn free.
    """

    files: tuple[Path, Path]
    placement: Array
    axis: Array
    slides: Mask
    lower: Array
    upper: Array
    velocity: Array
    effort: Array
    mass: Array
    center: Array
    tip: Array
    bodies: tuple[Body, ...]
    tested_pairs: tuple[tuple[int, int], ...]
    joint_names: tuple[str, ...]
    warnings: tuple[str, ...]
    model: pin.Model = field(repr=False, compare=False)
    geometry: pin.GeometryModel = field(repr=False, compare=False)
    stand_ins: tuple[StandIn, ...] = ()
    task: TaskSpace = FREE_TURN
    followers: tuple[FollowingFrame, ...] = ()
    tool_links: frozenset[str] = frozenset()

    @property
    def joints(self) -> int:
        """How many there are between base and tip."""
        return len(self.axis)

    @property
    def turning(self) -> Index:
        """The joints that are not prismatic."""
        return np.flatnonzero(~self.slides)

    @property
    def has_solids(self) -> bool:
        """Whether bodies with flat faces are among the collision shapes."""
        return any(body.solid is not None for body in self.bodies)


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
        places = {f"link[{link}].inertial" for link in (tool.root, *tool.parent)}
        of_tool = any((fault.field or "").startswith(place) for place in places)
        message = f"{fault.message} ({_NO_FORCE})"
        raise InputError(str(tool_file if of_tool else arm_file), fault.field, message)
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
    bodies = hung_on(bodies, whole, frames, joints)
    tip = model.frames[model.getFrameId(tip_link, pin.FrameType.BODY)]
    names = tuple(model.names[1:])
    endless = np.array([whole.kinds[name] == CONTINUOUS for name in names], dtype=bool)
    return Robot(
        files=(arm_file, tool_file),
        placement=np.array([model.jointPlacements[i].homogeneous for i in range(1, joints + 1)]),
        axis=_axes(model),
        slides=np.array([whole.kinds[name] == PRISMATIC for name in names], dtype=bool),
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
        warnings=_warnings(whole),
        model=model,
        geometry=geometry,
        stand_ins=stand_ins,
        followers=frames,
        tool_links=frozenset(tool.shapes),
    )


def _check_chain(
    whole: Urdf, arm: Urdf, tool: Urdf, tip_link: str, wanted: tuple[int, int]
) -> None:
    """Hold the tree to so many turning and prismatic joints in a row to the tip, none elsewhere."""
    in_chain = [whole.joint_above[link] for link in whole.chain(tip_link)[1:]]

    def refuse(name: str, key: str, message: str) -> InputError:
        file = tool.file if name in tool.joint_above.values() else arm.file
        return InputError(str(file), f"joint[{name}]{key}", message)

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
    """An error about a joint of arm and tool as one tree, with the file that has the joint."""
    of_tool = any((error.field or "").startswith(f"joint[{n}]") for n in tool.joint_above.values())
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
            error = InputError(str(arm.file), f"joint[{name}].mimic", message)
            raise _in_its_file(error, arm, tool)


def _counted(joints: tuple[int, int]) -> str:
    """Numbers of turning and prismatic joints in words."""
    turning, sliding = joints
    return f"{turning} revolute joints" + (f" and {sliding} prismatic" if sliding else "")


def _where_given(limits: Array) -> Array:
    """Limits (joints,), NaN where the file has none; vendors write 0 as well."""
    return np.where(limits > 0, limits, np.nan)


def _warnings(urdf: Urdf) -> tuple[str, ...]:
    """What a user would want to know of the files."""
    found = []
    if not urdf.shapes:
        found.append("arm and tool have no collision shapes at all: nothing is ever hit")
    elif urdf.shapeless:
        found.append(f"no collision shape, so hits nothing: {_listed(urdf.shapeless)}")
    return tuple(found)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(map(repr, names))


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


def wider(robot: Robot, by: float) -> Robot:
    """The robot with all that is nearer than a distance (m) to its bodies.

    A cylinder stays one, longer and wider, so that it has a little more than that at its rims.
    """
    if by == 0.0:
        return robot
    return replace(robot, bodies=tuple([wider_body(body, by) for body in robot.bodies]))


def wider_body(body: Body, by: float) -> Body:
    """One of its bodies; see :func:`wider`."""
    if body.solid is not None:
        return replace(body, radius=body.radius + by, skin=body.skin + by)
    if not body.flat:
        return replace(body, radius=body.radius + by)
    along = by * (body.end - body.start) / body.length
    return replace(body, start=body.start - along, end=body.end + along, radius=body.radius + by)
