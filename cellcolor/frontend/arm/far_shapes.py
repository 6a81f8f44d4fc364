"""Collision shapes that stand far from the arm that they belong to.

A calibration that was read raw moves the frames of two links along axes that are parallel, by
hundreds of meters: the tip moves as before, and the shapes of a link are elsewhere. A mesh in
millimeters is a thousand times too large. Either way a contact of the link means nothing.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.wording import looks_like_millimeters
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot


def notes_on_shapes(robot: Robot) -> tuple[str, ...]:
    """A sentence on links that have shapes farther from their joint than the arm is long.

    Another on those whose shapes are larger. The arm is as long as the way from axis to axis,
    wherever on them the frames are. What stands before the first joint may be anything.
    """
    poses = forward(robot, np.zeros((1, robot.joints)))
    places = _on_axes(poses.origin[0, 1:], poses.axis[0], robot.slides, poses.tip[0])
    length = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    far: dict[str, float] = {}
    large: dict[str, float] = {}
    for body in robot.bodies:
        if not 0 < body.joint <= robot.joints:
            continue
        turn, origin = poses.rotation[0, body.joint], poses.origin[0, body.joint]
        middle = origin + turn @ (body.start + body.end) / 2
        size = body.radius + body.length / 2
        off = float(np.linalg.norm(places[body.joint - 1 : body.joint + 1] - middle, axis=1).min())
        if size > length:
            large[body.link] = max(2 * size, large.get(body.link, 0.0))
        elif off - size > length:
            far[body.link] = max(off - size, far.get(body.link, 0.0))
    notes = []
    if far:
        named = ", ".join(f"{link!r} are {off:.3g} m from its joint" for link, off in far.items())
        notes.append(
            f"collision shapes of {named}, and the arm is {length:.3g} m long: their contacts with "
            "the arm, the ground and the part mean nothing (a calibration that was not corrected "
            "moves frames so)"
        )
    if large:
        link, size = next(iter(large.items()))
        more = f", and of {len(large) - 1} more links," if len(large) > 1 else ""
        notes.append(
            f"collision shapes of {link!r}{more} are up to {size:.3g} m large, and the arm is "
            f"{length:.3g} m long: {looks_like_millimeters(size)}"
        )
    return tuple(notes)


def _on_axes(origins: Array, axes: Array, slides: Mask, tip: Array) -> Array:
    """A point (joints + 1, 3) on each joint's axis, the nearest to the one before, and the tip."""
    places = [origins[0]]
    for origin, axis, slide in zip(origins[1:], axes[1:], slides[1:], strict=True):
        along = 0.0 if slide else float((places[-1] - origin) @ axis)
        places.append(origin + along * axis)
    return np.array([*places, tip])
