"""Links that move because their joint follows another one (``<mimic>``), beside the chain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.urdf import CONTINUOUS, PRISMATIC, Follower, Urdf, check_follower


@dataclass(frozen=True)
class FollowingFrame:
    """A frame that moves against another one as a joint does that follows one of the chain.

    With the follower at zero both frames are the same.

    Attributes:
        link: the link behind the follower.
        parent: the frame that carries it: 0 is the world, then those behind the joints, then the
            followers in their order.
        placement: (4, 4) pose of the follower in that frame.
        axis: (3,) its unit axis in its own frame.
        slides: whether it is prismatic; otherwise it turns.
        leader: the joint of the chain that it follows, 0 the first.
        multiplier, offset: its position is ``multiplier`` times the leader's plus ``offset``.
    """

    link: str
    parent: int
    placement: Array
    axis: Array
    slides: bool
    leader: int
    multiplier: float
    offset: float

    def position(self, configurations: Array) -> Array:
        """Of the follower in configurations (n, joints) of the chain, (n,) in rad or m."""
        return np.asarray(self.multiplier * configurations[:, self.leader] + self.offset)


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
        check_follower(urdf.file, name, joints[name], own.kind)
        frame = model.frames[model.getFrameId(name, pin.FrameType.FIXED_JOINT)]
        parent = _carrier(urdf, urdf.parent[link], number, int(frame.parentJoint))
        axis = joints[name].find("axis")
        along = "1 0 0" if axis is None else axis.get("xyz", "1 0 0")
        number[link] = model.njoints + len(found)
        found.append(
            FollowingFrame(
                link,
                parent,
                np.array(frame.placement.homogeneous),
                np.array([float(part) for part in along.split()]),
                own.kind == PRISMATIC,
                names.index(own.leader),
                own.multiplier,
                own.offset,
            )
        )
    return tuple(found)


def hung_on(
    bodies: tuple[Body, ...], urdf: Urdf, frames: tuple[FollowingFrame, ...], joints: int
) -> tuple[Body, ...]:
    """The bodies, those behind a follower on its frame; where they are at zero stays the same."""
    number = {frame.link: joints + 1 + index for index, frame in enumerate(frames)}
    return tuple(
        replace(body, joint=_carrier(urdf, body.link, number, body.joint)) for body in bodies
    )


def _carrier(urdf: Urdf, link: str, number: Mapping[str, int], joint: int) -> int:
    """The frame of the last follower before a link, as far as it is not before a moving joint."""
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
        InputError: there is no position of a leader where its follower is inside, or the follower
            is in several places for one angle of the leader, which is told from no other then.
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
