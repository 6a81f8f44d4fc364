"""Links that overlap whatever the arm does: their shapes are larger than the links are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Between, Contacts

_TRIED = 100  # configurations


def always_touching(robot: Robot, pairs: Sequence[Between]) -> tuple[tuple[str, str], ...]:
    """Pairs of links whose bodies, among pairs of them, overlap in all of 100 configurations.

    These are drawn from the joint limits, always the same ones; a joint without limits turns by a
    full circle.
    """
    lower = np.where(np.isinf(robot.lower), -np.pi, robot.lower)
    upper = np.where(np.isinf(robot.upper), np.pi, robot.upper)
    tried = np.random.default_rng(0).uniform(lower, upper, (_TRIED, robot.joints))
    of_links: dict[tuple[str, str], list[Between]] = {}
    for pair in pairs:
        of_links.setdefault((pair[0].link, pair[1].link), []).append(pair)
    return tuple(links for links, own in of_links.items() if Contacts(own, robot)(tried).all())
