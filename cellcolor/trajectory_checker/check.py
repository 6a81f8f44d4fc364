"""The verdict on a trajectory (docs/judging-trajectories.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import CoveredArea, StrokeFeed, TrajectoryVerdict
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.trajectory_checker.area import judge_area
from cellcolor.trajectory_checker.contact import (
    contact_of,
    judge_contact,
    judge_cracks,
    judge_dragged,
    judge_turn,
)
from cellcolor.trajectory_checker.dense import densified, poses_of
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.feed import judge_feed, judge_tool_speeds
from cellcolor.trajectory_checker.fine_mesh import refined
from cellcolor.trajectory_checker.joint_motion import JointLimits, judge_joints
from cellcolor.trajectory_checker.stated import judge_lift_offs, judge_poses
from cellcolor.trajectory_checker.tolerances import OFF_SURFACE
from cellcolor.trajectory_checker.validity import judge_validity

_FINE = 0.25  # spacings; the edges of the triangles that area is measured with
_WITHOUT_SPACING = 0.005  # m; the same where the setup has no spacing


def check_trajectory(
    built: BuildResult,
    trajectory: Trajectory,
    *,
    timed: bool = True,
    minimum_lift_offs: int | None = None,
    silent: bool = False,
    deadline: Deadline = NEVER,
    progress: Callable[[str], None] | None = None,
) -> TrajectoryVerdict:
    """Judge a trajectory by its scene alone, whatever made it.

    Args:
        built: the scene and its labelled surface: the area that has a color has to be covered.
        timed: whether its times mean anything; without them velocities are not judged.
        minimum_lift_offs: what its lift-offs are compared with.
        silent: whether it cannot say what it leaves out, as a table cannot.

    Raises:
        InputError: the trajectory is of another arm, or the setup's velocities are.
        TooLarge: surface or trajectory would not fit into memory.
    """
    report, prepared = progress or (lambda _: None), built.prepared
    robot, motion = prepared.robot, prepared.scene.setup.motion
    direction, touches = robot.task.direction, not prepared.setup.task.stand_off_m
    _check_arm(prepared, trajectory)
    notes: list[str] = []
    report("joints")
    tips, axes = poses_of(robot, trajectory.joints, deadline)
    faults = FaultList(trajectory, tips, timed)
    joint_limits = _joint_limits(prepared, timed, notes)
    jumps = judge_joints(joint_limits, faults)
    skip = jumps.copy()
    skip[[sample for sample in trajectory.unplanned if sample < len(skip)]] = True
    dense = densified(trajectory, robot, tips, axes, skip, deadline)
    feeds: tuple[StrokeFeed, ...] = ()
    if timed and motion is not None:
        judge_tool_speeds(dense, skip, motion, touches, faults)
        feeds = judge_feed(dense, joint_limits, motion, faults)
    judge_poses(robot, axes, faults)
    judge_lift_offs(minimum_lift_offs, faults)
    report("validity")
    judge_validity(prepared, dense, deadline, faults)
    report("contact")
    fine_edge = _WITHOUT_SPACING if motion is None else _FINE * motion.spacing_m
    fine = refined(prepared.surface, fine_edge, deadline)
    if not direction:  # the place tells; the tool, whether it is on this side of a thin sheet
        fine = replace(fine, away=OFF_SURFACE)
    contact = contact_of(prepared, trajectory, dense, fine, deadline)
    touching = judge_contact(contact, direction, faults)
    if touches:
        judge_dragged(dense, fine, deadline, faults)
    judge_turn(prepared, contact, deadline, faults)
    judge_cracks(built, contact, fine, faults)
    covered: CoveredArea | None = None
    if motion is None:
        notes.append("The setup has no [motion], so coverage is not judged.")
    else:
        report("area")
        deadline.check()
        on_it = contact.take(touching)
        covered = judge_area(built, on_it, fine, motion, silent, faults, deadline)
        notes += _given_up(built)
    lift_offs, claimed = trajectory.lift_offs, len(trajectory.extra_lift_offs)
    minimum = minimum_lift_offs
    return TrajectoryVerdict(
        valid=not faults.counts,
        name=trajectory.name,
        samples=len(trajectory.times),
        tested=len(dense),
        timed=timed,
        seconds=trajectory.seconds if timed else None,
        strokes=len(trajectory.strokes),
        lift_offs=lift_offs,
        claimed_extra=claimed,
        minimum_lift_offs=minimum,
        unclaimed_extra=None if minimum is None else max(0, lift_offs - minimum - claimed),
        fault_counts=dict(faults.counts),
        faults=tuple(faults.faults),
        covered=covered,
        notes=tuple(notes),
        feeds=feeds,
    )


def _given_up(built: BuildResult) -> list[str]:
    """What the shares covered do not speak of."""
    areas, slivers = built.surface.vertex_areas, built.slivers
    alone = [vertex for vertex in built.surface.given_up if not slivers[vertex]]
    return [
        f"Shares covered are of the area with a color; {share:.1%} of the surface has none because "
        f"{why}."
        for where, why in (
            (slivers, "the sliver policy gave it up"),
            (alone, "it is left alone on purpose"),
        )
        if (share := areas[where].sum() / areas.sum())
    ]


def _check_arm(prepared: PreparedScene, trajectory: Trajectory) -> None:
    names = prepared.robot.joint_names
    if trajectory.joint_names != names:
        message = f"must be {', '.join(names)}, are {', '.join(trajectory.joint_names)}"
        raise InputError(None, "joint_names", message)
    for member in ("unplanned", "extra_lift_offs", "repeated"):
        for number, entry in enumerate(getattr(trajectory, member)):
            sample = entry if isinstance(entry, int) else entry.sample
            if not 0 <= sample < len(trajectory.times):
                raise InputError(None, f"{member}[{number}]", f"there is no sample {sample}")


def _joint_limits(prepared: PreparedScene, timed: bool, notes: list[str]) -> JointLimits:
    robot, setup, motion = prepared.robot, prepared.scene.setup, prepared.scene.setup.motion
    lower, upper = robot.lower, robot.upper
    if not setup.constraints.collision:
        lower, upper = np.full(robot.joints, -np.inf), np.full(robot.joints, np.inf)
        notes.append("The setup leaves out collisions and joint limits.")
    velocity = robot.velocity
    acceleration: Array | None = None
    jerk: Array | None = None
    if not timed:
        notes.append("There are no times, so velocities and accelerations are not judged.")
    elif motion is None:
        notes.append("The setup has no [motion], so accelerations are not judged.")
    if motion is not None:
        for key in ("velocities_rad_per_s", "accelerations_rad_per_s2", "jerks_rad_per_s3"):
            given = getattr(motion, f"joint_{key}")
            if given is not None and len(given) != robot.joints:
                message = f"needs {robot.joints} numbers, has {len(given)}"
                raise InputError(setup.file, f"motion.joint_{key}", message)
        acceleration = np.array(motion.joint_accelerations_rad_per_s2)
        if motion.joint_jerks_rad_per_s3 is not None:
            jerk = np.array(motion.joint_jerks_rad_per_s3)
        if motion.joint_velocities_rad_per_s is not None:
            velocity = np.fmin(velocity, motion.joint_velocities_rad_per_s)
    if timed and np.isnan(velocity).any():
        names = [robot.joint_names[joint] for joint in np.flatnonzero(np.isnan(velocity))]
        notes.append(f"Without a limit, so velocities are not judged: {', '.join(names)}.")
        velocity = np.where(np.isnan(velocity), np.inf, velocity)
    return JointLimits(lower, upper, velocity, acceleration, jerk, robot.slides)
