"""Whether a tool points out of the arm: where its tip is, and where the tip's axis goes."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array

_NEAR = 1e-3  # m; a tip or a flange so near to where it is seen from shows no direction
_BACK = -0.5  # the cosine of 120 degrees; bent tools and tools that stand aside are less turned


def notes_on_tool(model: pin.Model, root: str, tip_link: str, axes: Array) -> tuple[str, ...]:
    """A sentence if the tip's z axis, which goes into the part, points back to the arm.

    Or if all of the tool does, since it is mounted the wrong way round.

    Args:
        model: arm and tool.
        root: the tool's root link, at the flange.
        tip_link: the tool's tip.
        axes: (joints, 3) of the joints, each in its own frame.
    """
    at = {}
    for link in (root, tip_link):
        frame = model.frames[model.getFrameId(link, pin.FrameType.BODY)]
        if frame.parentJoint != model.njoints - 1:
            return ()  # the flange is not at the end of the chain
        at[link] = frame.placement
    flange, tip = np.array(at[root].translation), np.array(at[tip_link].translation)
    along, z = tip - flange, np.array(at[tip_link].rotation)[:, 2]
    length = float(np.linalg.norm(along))
    if length > _NEAR and z @ along < _BACK * length:
        off = np.degrees(np.arccos(np.clip(z @ along / length, -1, 1)))
        return (
            f"the z axis of the tip link {tip_link!r} points back to the flange, {off:.0f} degrees "
            "off the way from there to the tip: it has to point out of the tool, into the part",
        )
    outward = _outward(model, flange, axes)
    if outward is not None and z @ outward < _BACK and along @ outward < _BACK * length + _NEAR:
        return (
            f"the tool goes from the flange back into the arm, its tip link {tip_link!r} "
            f"{length:g} m behind the flange: robot.mount_rpy_rad turns it",
        )
    return ()


def _outward(model: pin.Model, flange: Array, axes: Array) -> Array | None:
    """The last joint's axis (3,) in its own frame, from the wrist to the flange."""
    if len(axes) < 2:
        return None
    last, before = model.jointPlacements[model.njoints - 1].inverse(), axes[-2]
    u, p = last.rotation @ before, np.array(last.translation)
    axis, cosine = axes[-1], float(axes[-1] @ u)
    sine = 1.0 - cosine**2
    if sine < _NEAR:
        return None
    wrist = (p @ axis - cosine * (p @ u)) / sine  # on the axis, nearest to the one before
    ahead = float(flange @ axis) - wrist
    return None if abs(ahead) < _NEAR else np.asarray(axis * np.sign(ahead))
