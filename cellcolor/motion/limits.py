"""What a setup says about motions, checked against the arm: limits, speeds, the home position."""

from __future__ import annotations

import math
from itertools import takewhile

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.likely_units import check_motion
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import joint_space
from cellcolor.motion.free_space import FreeSpace
from cellcolor.motion.timing import Speeds


def motion_of(prepared: PreparedScene) -> Motion:
    """The table of a setup that a motion needs.

    Raises:
        InputError: there is none, it does not fit the arm, the part or itself, or the arm is
            planar; names the key.
    """
    setup, robot = prepared.scene.setup, prepared.robot
    with naming(setup.file):
        if robot.task.plane:
            message = "a planar arm does not lift its tool off the part, so no motion is planned"
            raise InputError(None, "robot.kinematics", message)
        motion = setup.motion
        if motion is None:
            raise InputError(None, "motion", "planning a motion needs this table")
        for key, given in (
            ("joint_velocities_rad_per_s", motion.joint_velocities_rad_per_s),
            ("joint_accelerations_rad_per_s2", motion.joint_accelerations_rad_per_s2),
            ("joint_jerks_rad_per_s3", motion.joint_jerks_rad_per_s3),  # the judge needs them
            ("home_rad", motion.home),
        ):
            if given is not None and len(given) != robot.joints:
                message = f"has {len(given)} numbers for {robot.joints} joints"
                raise InputError(None, f"motion.{key}", message)
        for joint, at in enumerate(motion.home or ()):
            if not robot.lower[joint] <= at <= robot.upper[joint]:
                message = f"outside the limits of {robot.joint_names[joint]!r}"
                if robot.slides[joint]:
                    message += ", in m"
                elif abs(at) > 2 * math.pi:
                    message += f": {looks_like_degrees(at)}"
                raise InputError(None, f"motion.home_rad[{joint}]", message)
        check_motion(motion, prepared.surface, prepared.scene, prepared.arm.kinematics.reach)
        if motion.lead_m and not setup.task.stand_off_m:
            message = "only a tool that stands off (task.stand_off_m) goes on beyond its stroke"
            raise InputError(None, "motion.lead_m", message)
        if motion.lead_m and (motion.transfer_speed_m_per_s or np.inf) < motion.speed_m_per_s:
            message = "must not be below speed_m_per_s where there is motion.lead_m"
            raise InputError(None, "motion.transfer_speed_m_per_s", message)
        least = setup.task.contact_radius_m + motion.clearance_m
        if motion.retract_m <= least:
            message = f"must be above {least:g} m, contact radius and clearance together"
            raise InputError(None, "motion.retract_m", message)
    return motion


def speeds_of(motion: Motion, robot: Robot) -> Speeds:
    """The URDF's velocities, lowered where the setup says so, and the setup's accelerations.

    Raises:
        InputError: neither has the velocity of a joint.
    """
    velocities = robot.velocity
    if motion.joint_velocities_rad_per_s is not None:
        velocities = np.fmin(velocities, motion.joint_velocities_rad_per_s)
    if np.isnan(velocities).any():
        name = robot.joint_names[int(np.argmax(np.isnan(velocities)))]
        message = "is missing or 0; give motion.joint_velocities_rad_per_s in the setup"
        raise InputError(str(robot.files[0]), f"joint[{name}].limit.velocity", message)
    return Speeds(velocities, np.array(motion.joint_accelerations_rad_per_s2))


_TRIED = 256  # configurations at each distance
_FIRST = 0.1  # rad, or units of a slide
_FARTHER = 1.3  # the factor from one distance to the next
_ROOMS = (0.1, 0.03, 0.0)  # m, more than the clearance, that a position that is found keeps
_SHOWN = 3  # contacts
_DIGITS = 2  # of a proposed position, rad or m


def home_of(prepared: PreparedScene, motion: Motion) -> Array | None:
    """Where the arm begins and ends (joints,), rad or m; None if that does not matter.

    Raises:
        InputError: that position is not free, with the bodies that are in each other's way there
            and a free position near it; or ``free`` was asked for, and none was found.
    """
    if motion.home_rad is None:
        return None
    if motion.home is None:
        lower, upper = (np.clip(limit, -np.pi, np.pi) for limit in joint_space(prepared).limits)
        middle, near = np.round((lower + upper) / 2, _DIGITS), None
        for room in _ROOMS:
            near = free_near(FreeSpace(prepared, motion.clearance_m + room), middle)
            if near is not None:
                break
        if near is None:
            with naming(prepared.setup.file):
                raise InputError(None, "motion.home_rad", "no free position was found; give one")
        return np.array(near)
    home, free = np.array(motion.home), FreeSpace(prepared, motion.clearance_m)
    if free(home[None])[0]:
        return home
    how, found = "touch", FreeSpace(prepared, 0.0).touched(home)
    if not found:
        how, found = "are nearer than motion.clearance_m or a margin allows", free.touched(home)
    more = f" and {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
    shown = ", ".join(found[:_SHOWN]) + more
    near = free_near(free, home)
    proposed = (
        "; no free position was found near it"
        if near is None
        else f"; free is, for example, [{', '.join(f'{angle:g}' for angle in near)}]; "
        'home_rad = "free" finds one as well'
    )
    with naming(prepared.setup.file):
        message = f"the arm cannot stand there: {shown} {how}{proposed}"
        raise InputError(None, "motion.home_rad", message)


def free_near(free: FreeSpace, home: Array) -> list[float] | None:
    """A free configuration, the nearest of many drawn around home at growing distances."""
    drawn = np.random.default_rng(0).uniform(-1.0, 1.0, (_TRIED, len(home)))
    distances = (_FIRST * _FARTHER**step for step in range(100))
    for distance in takewhile(lambda far: far < np.pi, distances):
        tried = np.round(home + distance * free.space.units * drawn, _DIGITS)
        found = np.flatnonzero(free(tried))
        if len(found):
            nearest = np.argmin(free.space.largest(tried[found] - home))
            return [float(angle) for angle in tried[found[nearest]]]
    return None
