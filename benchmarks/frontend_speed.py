"""Microseconds per candidate of the front end, against a straightforward loop, in one run.

    python benchmarks/frontend_speed.py [SCENE.toml] [--vertices N …] [--sample N] [-o TABLE.csv]

The loop takes one candidate at a time: Pinocchio for kinematics, Jacobian and gravity, python-fcl
with objects built beforehand for collisions, the tests in the front end's order, and the first
failure ends it. Inverse kinematics is not counted there. It runs on a random sample of the
candidates, and its time is that of all of them in proportion; verdicts are compared. Printed are
the times of the best of three builds.
"""

from __future__ import annotations

import argparse
import os
import resource
import shlex
import sys
import time
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import fcl
import numpy as np
import pinocchio as pin

from cellcolor.arrays import Array
from cellcolor.frontend import BuildResult, Scene, build_surface
from cellcolor.frontend.contact.fcl_bodies import body_shape
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.lab.runs.table import TableFile
from cellcolor.lab.runs.timings import Timing, timing
from cellcolor.processes import Ended

SCENE = Path(__file__).parents[1] / "instances" / "scenes" / "hemisphere_flat.toml"
BUILDS = 3
NOT_IN_THE_LOOP = (
    "preparation",
    "inverse kinematics",
    "continuity",
    "validity between vertices",
    "colors and cracks",
)


class Loop:
    """The tests once more, one configuration at a time."""

    def __init__(self, prepared: PreparedScene) -> None:
        robot, surface = prepared.robot, prepared.surface
        self.prepared, self.model, self.data = prepared, robot.model, robot.model.createData()
        self.tip = self.model.getFrameId(prepared.setup.robot.tip_link)
        self.gravity = np.array(prepared.setup.task.gravity_m_per_s2)
        self.shapes = [fcl.CollisionObject(body_shape(body)) for body in robot.bodies]
        self.local = []
        for body in robot.bodies:
            z = (body.end - body.start) / body.length if body.length else np.array([0.0, 0, 1])
            x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
            x /= np.linalg.norm(x)
            turn = np.column_stack([x, np.cross(z, x), z])
            self.local.append(pin.SE3(turn, (body.start + body.end) / 2))
        mesh = fcl.BVHModel()
        mesh.beginModel(len(surface.faces), len(surface.vertices))
        mesh.addSubModel(surface.vertices, surface.faces)
        mesh.endModel()
        self.object = fcl.CollisionObject(mesh)
        self.obstacles = []
        for obstacle in prepared.scene.obstacle:
            assert obstacle.kind == "cylinder" and obstacle.rpy_rad == (0.0, 0.0, 0.0)
            shape = fcl.Cylinder(obstacle.radius_m, obstacle.height_m)
            at = fcl.Transform(np.array(obstacle.position_m))
            self.obstacles.append(fcl.CollisionObject(shape, at))
        self.request = fcl.CollisionRequest()
        # The shipped tool's body ends 10 mm above the tip, on the axis.
        radius, length = prepared.setup.task.contact_radius_m, 0.01
        self.region = fcl.CollisionObject(fcl.Capsule(radius, length))
        self.in_region = pin.SE3(np.eye(3), np.array([0.0, 0.0, -length / 2]))

    def touch(self, a: fcl.CollisionObject, b: fcl.CollisionObject) -> bool:
        return bool(fcl.collide(a, b, self.request, fcl.CollisionResult()))

    def tip_blocked(self, pose: pin.SE3) -> bool:
        region, ground = self.prepared.setup.task.contact_radius_m, self.prepared.scene.ground
        if ground is not None:
            behind = pose.act(2 * self.in_region.translation)
            if min(pose.translation[2], behind[2]) - region < ground.height_m:
                return True
        middle = pose * self.in_region
        self.region.setTransform(fcl.Transform(middle.rotation, middle.translation))
        return any(self.touch(obstacle, self.region) for obstacle in self.obstacles)

    def __call__(self, q: Array) -> str:
        prepared, robot = self.prepared, self.prepared.robot
        thresholds, task = prepared.setup.thresholds, prepared.setup.task
        if (q < robot.lower).any() or (q > robot.upper).any():
            return "joint limits"
        pose = pin.framesForwardKinematics(self.model, self.data, q) or self.data.oMf[self.tip]
        if self.tip_blocked(pose):
            return "tip blocked"
        jacobian = pin.computeFrameJacobian(
            self.model, self.data, q, self.tip, pin.ReferenceFrame.LOCAL
        )
        torque = pin.computeGeneralizedGravity(self.model, self.data, q)
        if (np.abs(torque + task.normal_force_n * jacobian[2]) > robot.effort).any():
            return "torque"
        linear = jacobian[:3, :5]
        if np.sqrt(max(np.linalg.det(linear @ linear.T), 0)) < thresholds.min_manipulability_m3:
            return "manipulability"
        if abs(np.linalg.det(jacobian[:5, :5])) < thresholds.min_task_determinant_m3:
            return "task determinant"
        pin.forwardKinematics(self.model, self.data, q)
        poses = [self.data.oMi[body.joint] * at
                 for body, at in zip(robot.bodies, self.local, strict=True)]  # fmt: skip
        if prepared.scene.ground is not None:
            for body, pose in zip(robot.bodies, poses, strict=True):
                if body.link in prepared.setup.robot.may_touch_ground:
                    continue
                up = abs(pose.rotation[2, 2])
                around = body.radius * (np.sqrt(max(1 - up**2, 0)) if body.flat else 1)
                if (
                    pose.translation[2] - up * body.length / 2 - around
                    < prepared.scene.ground.height_m
                ):
                    return "ground"
        for shape, pose in zip(self.shapes, poses, strict=True):
            shape.setTransform(fcl.Transform(pose.rotation, pose.translation))
        if any(self.touch(self.shapes[i], self.shapes[j]) for i, j in robot.tested_pairs):
            return "self collision"
        moving = [s for s, b in zip(self.shapes, robot.bodies, strict=True) if b.joint][::-1]
        for obstacle in self.obstacles:
            if any(self.touch(obstacle, shape) for shape in moving):
                return "obstacle collision"
        if any(self.touch(self.object, shape) for shape in moving):
            return "object collision"
        return "valid"


def measure(scene: Path, vertices: int, sample: int) -> Iterator[Timing]:
    """Print the figures of one number of vertices; a row for each time."""
    varied = Scene.read(scene).varied(object={"target_vertices": vertices})
    runs = []
    for repetition in range(BUILDS):
        clocks = time.perf_counter(), time.process_time()
        result = build_surface(varied)
        ended = ended_since(clocks)
        runs.append((ended.seconds, result))
        size = len(result.reasons)
        yield row("front end, whole build", "cellcolor", repetition, ended, size)
        tests = Ended("done", seconds=tests_of(result), load=ended.load, peak_mb=ended.peak_mb)
        yield row("front end, validity tests", "cellcolor", repetition, tests, size)
    prepared = prepare(varied)
    total, result = min(runs, key=lambda run: run[0])
    candidates = result.reasons.size
    print(f"{scene.stem}: {len(result.reasons)} vertices, {candidates} candidates, {total:.2f} s")
    for name, seconds in result.report.seconds.items():
        print(f"  {name:<26} {1e6 * seconds / candidates:7.2f} us a candidate  {seconds:6.2f} s")

    loop = Loop(prepared)
    rows = np.random.default_rng(0).choice(candidates, min(sample, candidates), replace=False)
    joints, expected = (
        result.configurations.reshape(-1, 6)[rows],
        np.array(result.reason_names)[result.reasons.flat[rows]],
    )
    solved = expected != "no solution"
    clocks = time.perf_counter(), time.process_time()
    found = [loop(q) for q in joints[solved]]
    ended = ended_since(clocks)
    whole = candidates / len(rows)
    ended = replace(ended, seconds=ended.seconds * whole, cpu_seconds=ended.cpu_seconds * whole)
    yield row("front end, validity tests", "one candidate at a time", 0, ended, len(result.reasons))
    differ = sum(int(a != b) for a, b in zip(found, expected[solved], strict=True))
    fast, slow = tests_of(result), ended.seconds
    print(
        f"  all tests {1e6 * fast / candidates:.1f} us a candidate, loop"
        f" {1e6 * slow / candidates:.1f} us:"
        f" {slow / fast:.1f} times; {differ} of {len(found)} verdicts differ"
    )


def tests_of(result: BuildResult) -> float:
    """Seconds of the tests that the loop makes too."""
    return sum(s for name, s in result.report.seconds.items() if name not in NOT_IN_THE_LOOP)


def ended_since(clocks: tuple[float, float]) -> Ended:
    """What this process has taken since both clocks were read."""
    return Ended(
        "done",
        seconds=time.perf_counter() - clocks[0],
        cpu_seconds=time.process_time() - clocks[1],
        peak_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        load=os.getloadavg()[0],
    )


def row(subject: str, way: str, repetition: int, ended: Ended, vertices: int) -> Timing:
    """One time as a row of a table."""
    command = shlex.join(["python", "benchmarks/frontend_speed.py", *sys.argv[1:]])
    return timing(subject, way, repetition, ended, command, vertices, "vertices")


def main() -> None:
    """Measure, print, and keep the rows."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("scene", nargs="?", type=Path, default=SCENE)
    parser.add_argument("--vertices", nargs="+", type=int, default=[8000])
    parser.add_argument("--sample", type=int, default=6000, help="candidates for the loop")
    parser.add_argument("-o", "--output", type=Path, help="a table for cellcolor bench summary")
    arguments = parser.parse_args()
    output = arguments.output
    with nullcontext() if output is None else TableFile(output, Timing) as table:
        for vertices in arguments.vertices:
            for one in measure(arguments.scene, vertices, arguments.sample):
                if table is not None:
                    table.append(one)


if __name__ == "__main__":
    main()
