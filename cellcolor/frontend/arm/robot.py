"""The arm with its tool as plain arrays, taken from Pinocchio's reading of the URDF."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.urdf import Urdf, load_urdf, mount

__all__ = ["Body", "Robot", "load_robot"]

_SAME = 1e-6  # m; a sphere's center and a cylinder's end nearer than this are one point


@dataclass(frozen=True)
class Body:
    """A collision shape: all points within ``radius`` of a segment, or a flat-ended cylinder.

    ``start`` and ``end`` (3,) in m are in the frame of ``joint`` (0 is the world, the
    others are the frames behind the joints). A sphere is a capsule whose ends coincide.
    """

    link: str
    joint: int
    start: Array
    end: Array
    radius: float
    flat: bool

    @cached_property
    def length(self) -> float:
        """Distance between the ends in m."""
        return float(np.linalg.norm(self.end - self.start))


@dataclass(frozen=True)
class Robot:
    """Revolute joints in a row, a tool, and what collides. The world frame is the root link.

    Attributes:
        placement: (joints, 4, 4) fixed pose of each joint frame in the one before it.
        axis: (joints, 3) unit axis of each joint in its own frame.
        lower, upper: (joints,) joint limits in rad.
        effort: (joints,) torque limits in N m.
        mass: (joints,) mass that each joint's frame carries, in kg; fixed links and tool included.
        center: (joints, 3) its center of mass in that frame, m.
        tip: (4, 4) pose of the tool tip in the frame of the last joint; the tool works along +z.
        bodies: collision shapes, base first.
        tested_pairs: pairs of bodies (indices) that self-collision looks at: all that do not
            belong to one link or to links next to each other.
        joint_names: names of the joints.
        warnings: what its files have that is probably not meant, a sentence each.
        model: Pinocchio's own model, for those who want to compute independently.
    """

    files: tuple[Path, Path]
    placement: Array
    axis: Array
    lower: Array
    upper: Array
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

    @property
    def joints(self) -> int:
        """How many there are between base and tip."""
        return len(self.axis)


def load_robot(
    arm: Path | Urdf, flange_link: str, tool: Path | Urdf, tip_link: str, joints: int = 6
) -> Robot:
    """Put the tool on the arm's flange, both from files or as they have been read.

    Raises:
        InputError: a fault in either URDF (see :mod:`cellcolor.frontend.arm.urdf`), no such tip
            link, not so many joints between base and tip, one there that follows another, or
            Pinocchio read other collision shapes than the file has.
    """
    arm, tool = (given if isinstance(given, Urdf) else load_urdf(given) for given in (arm, tool))
    arm_file, tool_file = arm.file, tool.file
    if tool.moving:
        raise InputError(str(tool_file), f"joint[{tool.moving[0]}]", "a tool may not move")
    if tip_link != tool.root and tip_link not in tool.parent:
        raise InputError(str(tool_file), f"link[{tip_link}]", "the tip link is not in the tool")
    whole = mount(arm, flange_link, tool)
    in_chain = [whole.joint_above[link] for link in whole.chain(tip_link)[1:]]
    for name in in_chain:
        if name in whole.locked:
            raise InputError(
                str(tool_file if name in tool.locked else arm_file),
                f"joint[{name}].mimic",
                "a joint between base and tip may not follow another one",
            )
    moving = tuple(name for name in in_chain if name in whole.moving)
    if len(moving) != joints or len(whole.moving) != joints:
        raise InputError(
            str(arm_file),
            "robot",
            f"needs {joints} revolute joints in a row to the tip, has {len(moving)} there and "
            f"{len(whole.moving)} in all",
        )
    try:
        model = pin.buildModelFromXML(whole.text())
        geometry = pin.buildGeomFromUrdfString(model, whole.text(), pin.GeometryType.COLLISION)
    except (ValueError, RuntimeError) as error:
        raise InputError(str(arm_file), "robot", f"Pinocchio refuses it: {error}") from error
    bodies = _bodies(arm_file, whole, model, geometry)
    tip = model.frames[model.getFrameId(tip_link)]
    return Robot(
        files=(arm_file, tool_file),
        placement=np.array([model.jointPlacements[i].homogeneous for i in range(1, joints + 1)]),
        axis=_axes(model),
        lower=np.array(model.lowerPositionLimit),
        upper=np.array(model.upperPositionLimit),
        effort=np.array(model.effortLimit),
        mass=np.array([model.inertias[i].mass for i in range(1, joints + 1)]),
        center=np.array([model.inertias[i].lever for i in range(1, joints + 1)]),
        tip=np.array(tip.placement.homogeneous),
        bodies=bodies,
        tested_pairs=_tested_pairs(whole, bodies),
        joint_names=tuple(model.names[1:]),
        warnings=_warnings(whole),
        model=model,
        geometry=geometry,
    )


def _warnings(urdf: Urdf) -> tuple[str, ...]:
    """What a user would want to know of the files."""
    found = []
    if not urdf.shapes:
        found.append("arm and tool have no collision shapes at all: nothing is ever hit")
    elif urdf.shapeless:
        found.append(f"no collision shape, so hits nothing: {_listed(urdf.shapeless)}")
    if urdf.locked:
        found.append(f"follows another joint (<mimic>), so fixed at zero: {_listed(urdf.locked)}")
    return tuple(found)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(map(repr, names))


def _axes(model: pin.Model) -> Array:
    """Each joint's axis in its own frame, from the world Jacobian at zero."""
    data = model.createData()
    zero = np.zeros(model.nv)
    jacobian = pin.computeJointJacobians(model, data, zero)
    return np.array([data.oMi[i + 1].rotation.T @ jacobian[3:, i] for i in range(model.nv)])


def _bodies(
    file: Path, urdf: Urdf, model: pin.Model, geometry: pin.GeometryModel
) -> tuple[Body, ...]:
    shapes: dict[str, list[pin.GeometryObject]] = {}
    for shape in geometry.geometryObjects:
        shapes.setdefault(model.frames[shape.parentFrame].name, []).append(shape)
    for link, count in urdf.shapes.items():
        read = len(shapes.get(link, []))
        if read != count:
            raise InputError(
                str(file), f"link[{link}].collision", f"Pinocchio read {read} of {count} shapes"
            )
    return tuple(body for link in urdf.shapes for body in _of_link(link, shapes[link]))


def _of_link(link: str, shapes: list[pin.GeometryObject]) -> list[Body]:
    """Bodies of one link; a cylinder with a sphere of its radius on both ends is a capsule."""
    spheres: list[tuple[Array, float]] = []
    cylinders: list[tuple[Array, Array, float]] = []
    joint = int(shapes[0].parentJoint)
    for shape in shapes:
        center = np.array(shape.placement.translation)
        if hasattr(shape.geometry, "halfLength"):
            half = shape.placement.rotation[:, 2] * shape.geometry.halfLength
            cylinders.append((center - half, center + half, float(shape.geometry.radius)))
        else:
            spheres.append((center, float(shape.geometry.radius)))
    bodies = []
    for start, end, radius in cylinders:
        caps = [
            next((s for s in spheres if _is_cap(s, point, radius)), None) for point in (start, end)
        ]
        round_ends = caps[0] is not None and caps[1] is not None
        if round_ends:
            spheres = [sphere for sphere in spheres if not any(sphere is cap for cap in caps)]
        bodies.append(Body(link, joint, start, end, radius, flat=not round_ends))
    bodies.extend(Body(link, joint, at, at, radius, flat=False) for at, radius in spheres)
    return bodies


def _is_cap(sphere: tuple[Array, float], point: Array, radius: float) -> bool:
    center, own = sphere
    return abs(own - radius) < _SAME and float(np.linalg.norm(center - point)) < _SAME


def _tested_pairs(urdf: Urdf, bodies: tuple[Body, ...]) -> tuple[tuple[int, int], ...]:
    """All pairs but those within a link or between links with no solid link in between."""
    solid_above = {}
    for link in urdf.shapes:
        above = [other for other in urdf.chain(link)[:-1] if other in urdf.shapes]
        solid_above[link] = above[-1] if above else None
    return tuple(
        (i, j)
        for i, first in enumerate(bodies)
        for j, second in enumerate(bodies[i + 1 :], i + 1)
        if first.link != second.link
        and solid_above[first.link] != second.link
        and solid_above[second.link] != first.link
    )
