"""What a setup says about motions, checked against the arm."""

from __future__ import annotations

import math

import numpy as np

from cellcolor.data.wording import looks_like_degrees
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.likely_units import check_motion
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.timing import Speeds


def motion_of(prepared: PreparedScene) -> Motion:
    """The table of a setup that a motion needs.

    Raises:
        InputError: there is none, or a list has another number of joints than the arm, the home
            position is outside the limits, a length is larger than the part or the arm's reach, the
            tool retracts less than it has to keep clear, a tool that touches is asked for leads, or
            the arm is planar.
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
