"""What the files of an arm have that is probably not meant, in sentences for its user.

A tool may point back into the arm. Collision shapes may stand far from the arm that they belong to:
a calibration that was read raw moves the frames of two links along axes that are parallel, by
hundreds of meters, so that the tip moves as before and the shapes of a link are elsewhere. A mesh
in millimeters is a thousand times too large. Either way a contact of the link means nothing.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import looks_like_millimeters
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses, forward, nearest_points
from cellcolor.frontend.arm.robot import Robot

_NEAR = 1e-3  # m; a tip or a flange so near to where it is seen from shows no direction
_BACK = -0.5  # the cosine of 120 degrees; bent tools and tools that stand aside are less turned


def notes_on_tool(robot: Robot, root: str, tip_link: str) -> tuple[str, ...]:
    """A sentence if the tip's z axis, which goes into the part, points back to the arm.

    Or if all of the tool does, since it is mounted the wrong way round.

    Args:
        root: the tool's root link, at the flange.
        tip_link: the tool's tip.
    """
    flange = robot.frame_of(root)[:3, 3]
    along, z = robot.tip[:3, 3] - flange, robot.tip[:3, 2]
    length = float(np.linalg.norm(along))
    if length > _NEAR and z @ along < _BACK * length:
        off = np.degrees(np.arccos(np.clip(z @ along / length, -1, 1)))
        return (
            f"the z axis of the tip link {tip_link!r} points back to the flange, {off:.0f} degrees "
            "off the way from there to the tip: it has to point out of the tool, into the part",
        )
    outward = _outward(robot, flange)
    if outward is not None and z @ outward < _BACK and along @ outward < _BACK * length + _NEAR:
        return (
            f"the tool goes from the flange back into the arm, its tip link {tip_link!r} "
            f"{length:g} m behind the flange: robot.mount_rpy_rad turns it",
        )
    return ()


def _outward(robot: Robot, flange: Array) -> Array | None:
    """The last joint's axis (3,) in its own frame, from the wrist to the flange."""
    if robot.joints < 2:
        return None
    axis, back = robot.axis[-1], np.linalg.inv(robot.placement[-1])
    beside = back[:3, :3] @ robot.axis[-2]
    if 1.0 - float(axis @ beside) ** 2 < _NEAR:
        return None
    wrist = nearest_points(np.zeros(3), axis, back[:3, 3], beside)[0]
    ahead = float((flange - wrist) @ axis)
    return None if abs(ahead) < _NEAR else np.asarray(axis * np.sign(ahead))


_HUGE = 20.0  # times the arm; what stands before the first joint may be a hall's floor, no larger
_STRAY = 0.5  # of the arm; so far from all others no shape of a link belongs there


def notes_on_shapes(robot: Robot) -> tuple[str, ...]:
    """Sentences on links whose shapes are elsewhere, or too large.

    A shape may be as far from its joint as the arm is long, and half as far from the other shapes
    of its link. What stands before the first joint may be anywhere.
    """
    poses = forward(robot, np.zeros((1, robot.joints)))
    places, length = _axes_of(robot, poses)
    turn, origin = poses.rotation[0], poses.origin[0]
    middles = [origin[b.joint] + turn[b.joint] @ (b.start + b.end) / 2 for b in robot.bodies]
    far: dict[str, float] = {}
    stray: dict[str, float] = {}
    large: dict[str, float] = {}
    for body, middle in zip(robot.bodies, middles, strict=True):
        size = _size(body)
        if size > length * (1 if body.joint else _HUGE):
            large[body.link] = max(size, large.get(body.link, 0.0))
        elif body.joint:
            near = places[body.joint - 1 : body.joint + 1]
            off = float(np.linalg.norm(near - middle, axis=1).min()) - size
            gaps = [
                float(np.linalg.norm(there - middle)) - size - _size(other)
                for other, there in zip(robot.bodies, middles, strict=True)
                if other.link == body.link and other is not body
            ]
            if off > length:
                far[body.link] = max(off, far.get(body.link, 0.0))
            elif gaps and min(gaps) > _STRAY * length:
                stray[body.link] = min(gaps)
    long = f"and the arm is {length:.3g} m long"
    notes = []
    if far:
        named = ", ".join(f"{link!r} are {off:.3g} m from its joint" for link, off in far.items())
        notes.append(
            f"collision shapes of {named}, {long}: their contacts with the arm, the ground and the "
            "part mean nothing (a calibration that was not corrected moves frames so)"
        )
    notes += [
        f"a collision shape of {link!r} is {off:.3g} m from the link's others, {long}: is its "
        "origin right?"
        for link, off in stray.items()
    ]
    if large:
        link, size = next(iter(large.items()))
        more = f", and of {len(large) - 1} more links," if len(large) > 1 else ""
        notes.append(f"collision shapes of {link!r}{more} are {_in_words(size, length)}")
    return tuple(notes)


def too_large(robot: Robot, body: Body) -> str | None:
    """Why a body that stands still cannot be meant to be so large; None if it can."""
    _, length = _axes_of(robot, forward(robot, np.zeros((1, robot.joints))))
    size = _size(body)
    return f"is {_in_words(size, length)}" if size > _HUGE * length else None


def _size(body: Body) -> float:
    """Half of its length, m."""
    return body.radius + body.length / 2


def _in_words(size: float, length: float) -> str:
    wide = float(f"{2 * size:.3g}")
    return f"up to {wide:g} m large, and the arm is {length:.3g} m long: " + looks_like_millimeters(
        wide
    )


def _axes_of(robot: Robot, poses: Poses) -> tuple[Array, float]:
    """A point on each axis and the tip, and the arm's length: the way from axis to axis, m.

    Each point (joints + 1, 3) is the nearest to the one before, wherever on the axis the frame is.
    """
    origins, on_axes = poses.origin[0, 1:], [poses.origin[0, 1]]
    for origin, axis, slide in zip(origins[1:], poses.axis[0, 1:], robot.slides[1:], strict=True):
        along = 0.0 if slide else float((on_axes[-1] - origin) @ axis)
        on_axes.append(origin + along * axis)
    places = np.array([*on_axes, poses.tip[0]])
    return places, float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
