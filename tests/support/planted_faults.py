"""Faults planted in trajectories at random places, each with what a judge has to say of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import coal
import numpy as np
from world import World

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import Fault, FaultKind, TrajectoryVerdict
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene


@dataclass(frozen=True)
class Planted:
    """A trajectory with a fault, and the fault as it has to be found.

    Attributes:
        kind: its kind.
        joint: its joint, None if it is no joint's.
        samples: one of these is the first sample of the fault; empty if it has none.
        places: (k, 3) the fault's place is within 10 mm of one of these, if it has no sample.
    """

    trajectory: Trajectory
    kind: FaultKind
    joint: str | None = None
    samples: range = range(0)
    places: Array | None = None


def found(planted: Planted, verdict: TrajectoryVerdict) -> bool:
    """Whether the verdict has the fault with its kind, joint and time."""
    return any(_is_it(planted, fault) for fault in verdict.of_kind(planted.kind))


def _is_it(planted: Planted, fault: Fault) -> bool:
    if fault.joint != planted.joint:
        return False
    if planted.places is not None:
        apart = np.linalg.norm(planted.places - np.array(fault.place), axis=1)
        return bool(apart.min() < 0.01)
    if fault.sample not in planted.samples:
        return False
    return fault.time == planted.trajectory.times[fault.sample]


Random = np.random.Generator


def _sample(trajectory: Trajectory, random: Random) -> int:
    """A sample that is neither the first nor the last."""
    return int(random.integers(1, len(trajectory.times) - 1))


def jump(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:
    """From a sample on, one joint is a full circle farther."""
    sample, joint = _sample(trajectory, random), int(random.integers(prepared.robot.joints))
    joints = trajectory.joints.copy()
    joints[sample:, joint] += random.choice([-1, 1]) * 2 * math.pi
    name = trajectory.joint_names[joint]
    return Planted(replace(trajectory, joints=joints), "jump", name, range(sample - 1, sample))


def over_limit(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:
    """One joint is 0.1 degrees beyond its limit at one sample."""
    sample, joint = _sample(trajectory, random), int(random.integers(prepared.robot.joints))
    joints, over = trajectory.joints.copy(), math.radians(0.1)
    upper, lower = prepared.robot.upper[joint], prepared.robot.lower[joint]
    joints[sample, joint] = upper + over if random.random() < 0.5 else lower - over
    name = trajectory.joint_names[joint]
    return Planted(
        replace(trajectory, joints=joints), "joint limit", name, range(sample, sample + 1)
    )


def inside_obstacle(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:
    """At one sample the arm is turned about its base until it is 1 mm inside the obstacle."""
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)
    (obstacle,) = prepared.scene.obstacle
    content = obstacle.model_dump()
    shape = coal.Cylinder(content["radius_m"], content["height_m"])
    pose = coal.Transform3s(np.eye(3), np.array(content["position_m"]))
    sample = _sample(trajectory, random)
    joints = trajectory.joints.copy()

    def depth(turn: float) -> float:
        turned = joints[sample].copy()
        turned[0] += turn
        world.place(turned)
        return -world.to_solid(shape, pose)

    side = float(random.choice([-1, 1]))
    high = next(
        (s * k * 0.01 for s in (side, -side) for k in range(1, 300) if depth(s * k * 0.01) > 0.001),
        None,
    )
    assert high is not None, "the arm does not get there"
    low = high - math.copysign(0.01, high)
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if depth(middle) > 0.001 else (middle, high)
    joints[sample, 0] += high
    changed = replace(trajectory, joints=joints)
    poses = forward(prepared.robot, joints)
    changed = replace(changed, points=poses.tip, normals=-poses.tool_axis)
    return Planted(changed, "invalid", None, range(sample, sample + 1))


def left_out(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:  # noqa: ARG001
    """The samples of one segment are missing."""
    segment = int(random.choice(np.unique(trajectory.segment[trajectory.contact])))
    gone = trajectory.contact & (trajectory.segment == segment)
    return Planted(_of(trajectory, ~gone), "uncovered", places=trajectory.points[gone])


def twice(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:  # noqa: ARG001
    """A stretch of at least 80 mm is gone back and over again."""
    first, after = trajectory.strokes[int(random.integers(len(trajectory.strokes)))]
    length = int(random.integers(80, 200))
    begin = int(random.integers(first, after - length - 1))
    end = begin + length
    back, again = np.arange(end - 1, begin - 1, -1), np.arange(begin + 1, end + 1)
    rows = np.concatenate(
        [np.arange(end + 1), back, again, np.arange(end + 1, len(trajectory.times))]
    )
    step = float(np.diff(trajectory.times).max())
    changed = replace(_of(trajectory, rows), times=np.arange(len(rows)) * step)
    # It is seen as such some way after it has turned back.
    return Planted(changed, "repeated", None, range(end, end + 60))


def swapped(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:
    """Two columns of joints, of points or of normals are exchanged."""
    member = str(random.choice(["joints", "points", "normals"]))
    columns = getattr(trajectory, member).copy()
    i, j = sorted(random.choice(columns.shape[1], 2, replace=False).tolist())
    columns[:, [i, j]] = columns[:, [j, i]]
    changes: dict[str, Any] = {member: columns}
    changed = replace(trajectory, **changes)
    poses = forward(prepared.robot, changed.joints)
    apart = np.linalg.norm(changed.points - poses.tip, axis=1)
    turned = np.linalg.norm(changed.normals + poses.tool_axis, axis=1)
    (wrong,) = np.nonzero((apart > 1e-4) | (turned > math.radians(0.1)))
    joint = trajectory.joint_names[i] if member == "joints" else None
    return Planted(changed, "pose", joint, range(int(wrong[0]), int(wrong[0]) + 1))


def backwards(prepared: PreparedScene, trajectory: Trajectory, random: Random) -> Planted:  # noqa: ARG001
    """From a sample on, time begins again somewhat earlier."""
    sample, times = _sample(trajectory, random), trajectory.times.copy()
    times[sample:] -= times[sample] - times[sample - 1] + random.uniform(1e-3, 1.0)
    return Planted(replace(trajectory, times=times), "time", None, range(sample, sample + 1))


def _of(trajectory: Trajectory, rows: Array) -> Trajectory:
    """Some samples of a trajectory."""
    names = ("times", "joints", "points", "normals", "contact", "segment")
    return replace(trajectory, **{name: getattr(trajectory, name)[rows] for name in names})


Planter = Callable[[PreparedScene, Trajectory, Random], Planted]
PLANTERS: dict[str, Planter] = {
    "jump of 2π": jump,
    "0.1 degrees over a limit": over_limit,
    "1 mm inside an obstacle": inside_obstacle,
    "segment left out": left_out,
    "stretch twice": twice,
    "swapped columns": swapped,
    "time running back": backwards,
}
