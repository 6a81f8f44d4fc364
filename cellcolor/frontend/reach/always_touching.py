"""Links that overlap whatever the arm does: their shapes are larger than the links are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import body_ends, hits_itself

__all__ = ["always_touching"]

_TRIED = 100  # configurations


def always_touching(robot: Robot) -> tuple[tuple[str, str], ...]:
    """Pairs of links that self-collision looks at and that overlap in all of 100 configurations.

    These are drawn from the joint limits, always the same ones; a joint without limits turns by a
    full circle.
    """
    lower = np.where(np.isinf(robot.lower), -np.pi, robot.lower)
    upper = np.where(np.isinf(robot.upper), np.pi, robot.upper)
    tried = np.random.default_rng(0).uniform(lower, upper, (_TRIED, robot.joints))
    poses = forward(robot, tried)
    ends = body_ends(robot, poses)
    pairs: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for i, j in robot.tested_pairs:
        pairs.setdefault((robot.bodies[i].link, robot.bodies[j].link), []).append((i, j))
    return tuple(
        links
        for links, own in pairs.items()
        if hits_itself(replace(robot, tested_pairs=tuple(own)), ends, poses).all()
    )
