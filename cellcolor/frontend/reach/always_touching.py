"""Links that overlap whatever the arm does: their shapes are larger than the links are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import Poses, forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import body_ends, hits_itself, segment_distance

_TRIED = 100  # configurations
_HARDLY_ANY = 0.9  # of them overlap

_Pairs = dict[tuple[str, str], list[tuple[int, int]]]


def always_touching(robot: Robot) -> tuple[tuple[str, str], ...]:
    """Pairs of links that self-collision looks at and that overlap in all of 100 configurations.

    These are drawn from the joint limits, always the same ones; a joint without limits turns by a
    full circle.
    """
    poses = forward(robot, _tried(robot))
    ends = body_ends(robot, poses)
    return tuple(
        links for links, own in _pairs(robot).items() if _touch(robot, own, ends, poses).all()
    )


def check_capsules(robot: Robot, home: tuple[float, ...] | None = None) -> str | None:
    """Refuse capsules around meshes that leave the arm no configuration free of itself.

    Args:
        robot: with the distances that its links have to keep, if any.
        home: a configuration that has to be free, tried besides the 100 of
            :func:`always_touching` and the one with all joints at zero.

    Returns:
        a warning where hardly any is left.

    Raises:
        InputError: each of them has an overlap in which such a capsule takes part; names the links
            that overlap most often.
    """
    fitted = {each.link for each in robot.stand_ins if each.chosen == "capsules"}
    pairs = {links: own for links, own in _pairs(robot).items() if fitted & set(links)}
    if not pairs:
        return None
    zero = np.zeros((1, robot.joints))
    within = ((robot.lower <= zero) & (zero <= robot.upper)).all(axis=1)
    also = np.array([home] if home is not None and len(home) == robot.joints else [])
    tried = np.concatenate([_tried(robot), zero[within], also.reshape(-1, robot.joints)])
    poses = forward(robot, tried)
    ends = body_ends(robot, poses)
    touch = {links: _touch(robot, own, ends, poses) for links, own in pairs.items()}
    hit = np.any(list(touch.values()), axis=0)
    if hit.mean() < _HARDLY_ANY:
        return None
    worst = max(touch, key=lambda links: int(touch[links].sum()))
    message = (
        f"the capsules around meshes are too wide: {worst[0]!r} and {worst[1]!r} overlap in "
        f"{touch[worst].sum()} of {len(tried)} configurations"
        f"{_depth(robot, pairs[worst], ends[:, :, touch[worst]])}, and {len(tried) - hit.sum()} "
        'are free of overlaps of such capsules. Choose "exact" or "hull" for these links, or write '
        "their shapes into the URDF by hand; may_touch is for links that overlap as they are"
    )
    if hit.all():
        raise InputError(None, "robot.mesh_collision", message)
    return message


def _tried(robot: Robot) -> Array:
    lower = np.where(np.isinf(robot.lower), -np.pi, robot.lower)
    upper = np.where(np.isinf(robot.upper), np.pi, robot.upper)
    return np.random.default_rng(0).uniform(lower, upper, (_TRIED, robot.joints))


def _pairs(robot: Robot) -> _Pairs:
    """The pairs of bodies that self-collision looks at, by their links."""
    pairs: _Pairs = {}
    for i, j in robot.tested_pairs:
        pairs.setdefault((robot.bodies[i].link, robot.bodies[j].link), []).append((i, j))
    return pairs


def _touch(robot: Robot, pairs: list[tuple[int, int]], ends: Array, poses: Poses) -> Mask:
    return hits_itself(replace(robot, tested_pairs=tuple(pairs)), ends, poses)


def _depth(robot: Robot, pairs: list[tuple[int, int]], ends: Array) -> str:
    """How much two links overlap, in words; empty if one of them is not round."""
    bodies = [robot.bodies[index] for pair in pairs for index in pair]
    if any(body.flat or body.solid is not None for body in bodies):
        return ""
    depths = [
        robot.bodies[i].radius + robot.bodies[j].radius - segment_distance(*ends[i], *ends[j])
        for i, j in pairs
    ]
    low, high = (1e3 * at(np.max(depths, axis=0)) for at in (np.min, np.max))
    return f", by {low:.1f} to {high:.1f} mm"
