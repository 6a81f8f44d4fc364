"""Each shipped scene's own candidates and target poses against EAIK, Pinocchio and coal.

The slow ones print what they counted: ``pytest -m slow -n 0 -s -k five_thousand tests/frontend``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import coal
import numpy as np
import pinocchio as pin
import pytest
from independent import (
    CONTACT,
    Eaik,
    arm_reason,
    clearances,
    possible_reasons,
    regular,
    set_distance,
)
from reasons import Reason
from shipped import shipped
from world import World

from cellcolor.arrays import Array
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.arm.kinematics import (
    forward,
    gravity_torques,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.contact.obstacle import CylinderObstacle
from cellcolor.frontend.prepared import PreparedScene, prepare

pytestmark = pytest.mark.second

NAMES = ["hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square"]


def check_inverse(name: str, vertices: int, count: int) -> None:
    """EAIK has the same solutions, modulo 2 pi and both ways, for poses of the scene.

    Solutions next to a singularity would be left out on both sides, since rounding decides
    whether there are two of them or none. No scene has any.
    """
    prepared = prepare(shipped(name, vertices))
    random = np.random.default_rng([17, NAMES.index(name)])
    rows = random.choice(len(prepared.surface.vertices), count, replace=False)
    points, directions = prepared.surface.vertices[rows], -prepared.surface.normals[rows]
    found = prepared.arm.inverse(points, directions)
    solved = ~np.isnan(found[:, :, 0])
    eaik = Eaik(prepared.robot)
    apart, left_out = [], 0
    for point, direction, all_, there in zip(points, directions, found, solved, strict=True):
        ours = all_[there][:, :5]
        theirs = eaik.solutions(point, direction, random.uniform(0, 2 * np.pi))
        kept = [regular(prepared.robot, each) for each in (ours, theirs)]
        left_out += len(ours) + len(theirs) - len(kept[0]) - len(kept[1])
        apart.append(set_distance(*kept))
    number = solved.sum(axis=1)
    print(
        f"\n{name}: {count} poses, {number.sum()} solutions, {(number == 0).sum()} poses without"
        f" and {((number > 0) & (number < 8)).sum()} with some of the eight;"
        f" {(np.array(apart) > 1e-6).sum()} sets differ, farthest {max(apart):.1e} rad;"
        f" {left_out} solutions left out as singular"
    )
    assert max(apart) < 1e-6
    assert left_out == 0


@dataclass
class Contacts:
    """Verdicts of one test against coal's distances, over all candidates."""

    verdicts: list[bool] = field(default_factory=list)
    distances: list[float] = field(default_factory=list)

    def differing(self) -> Array:
        """The distances at which the verdicts differ."""
        verdicts, distances = np.array(self.verdicts), np.array(self.distances)
        return distances[verdicts != (distances <= 0)]

    def close(self) -> int:
        """How many candidates are so near to contact that the verdicts might differ."""
        return int((np.abs(np.array(self.distances)) <= CONTACT).sum())


def check_kinematics(prepared: PreparedScene, joints: Array) -> dict[str, float]:
    """Largest differences from Pinocchio, one configuration at a time."""
    robot = prepared.robot
    poses = forward(robot, joints)
    linear, angular = tip_jacobian(poses)
    torques = gravity_torques(robot, poses, np.array(prepared.setup.task.gravity_m_per_s2))
    measure = manipulability(linear)
    determinant = task_determinant(linear, angular, poses.tool_axis)
    model, data = robot.model, robot.model.createData()
    tip = model.getFrameId("tool_tip")
    worst = dict.fromkeys(("poses", "Jacobian", "gravity", "conditioning"), 0.0)

    def differ(name: str, ours: Array, theirs: Array) -> None:
        worst[name] = max(worst[name], float(np.abs(ours - theirs).max()))

    for row, q in enumerate(joints):
        jacobian = pin.computeFrameJacobian(
            model, data, q, tip, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        pin.framesForwardKinematics(model, data, q)
        for frame in range(7):
            differ("poses", poses.origin[row, frame], data.oMi[frame].translation)
            differ("poses", poses.rotation[row, frame], data.oMi[frame].rotation)
        differ("poses", poses.tip[row], data.oMf[tip].translation)
        differ("poses", poses.tool_axis[row], data.oMf[tip].rotation[:, 2])
        differ("Jacobian", linear[row], jacobian[:3])
        differ("Jacobian", angular[row], jacobian[3:])
        differ("gravity", torques[row], pin.computeGeneralizedGravity(model, data, q))
        volume = np.linalg.svd(jacobian[:3, :5], compute_uv=False).prod()
        own = pin.computeFrameJacobian(model, data, q, tip, pin.ReferenceFrame.LOCAL)
        differ("conditioning", measure[row], volume)
        differ("conditioning", determinant[row], abs(np.linalg.det(own[:5, :5])))
    return worst


def check_candidates(name: str, vertices: int, count: int) -> None:
    """Candidates that the scene has a configuration for: kinematics, contacts, first reason."""
    scene = shipped(name, vertices)
    prepared, result = prepare(scene), build_surface(scene)
    joints, codes = drawn(result, count, [3, NAMES.index(name)])

    worst = check_kinematics(prepared, joints)
    print(f"\n{name}: {count} candidates; " + str({k: f"{v:.0e}" for k, v in worst.items()}))
    assert max(worst.values()) < 1e-9

    obstacles = []
    for obstacle in prepared.scene.obstacle:
        assert isinstance(obstacle, CylinderObstacle) and obstacle.rpy_rad == (0.0, 0.0, 0.0)
        pose = coal.Transform3s(np.eye(3), np.array(obstacle.position_m))
        obstacles.append((coal.Cylinder(obstacle.radius_m, obstacle.height_m), pose))
    assert prepared.scene.ground is not None
    ground = prepared.scene.ground.height_m
    place = prepared.workplace
    # Each test on every candidate, not only on what the ones before it have left.
    verdicts = {
        Reason.GROUND: place.with_ground(joints),
        Reason.SELF_COLLISION: place.with_itself(joints),
        Reason.OBJECT_COLLISION: place.with_object(joints),
    }
    if obstacles:
        verdicts[Reason.OBSTACLE_COLLISION] = place.with_obstacles(joints)
    contacts = {reason: Contacts() for reason in verdicts}
    world = World(prepared.robot, prepared.surface.vertices, prepared.surface.faces)
    wrong = unclear = 0
    for row, (q, code) in enumerate(zip(joints, codes, strict=True)):
        distances = clearances(world, prepared.setup, ground, q, obstacles)
        for reason, distance in distances.items():
            contacts[reason].verdicts.append(bool(verdicts[reason][row]))
            contacts[reason].distances.append(distance)
        expected = possible_reasons(arm_reason(prepared.robot, prepared.setup, q), distances)
        wrong += Reason(code) not in expected
        unclear += len(expected) > 1
    for reason, contact in contacts.items():
        off = contact.differing()
        print(
            f"  {reason.text}: {sum(contact.verdicts)} hits, {len(off)} verdicts differ,"
            f" farthest {1000 * np.abs(off).max(initial=0.0):.4f} mm from contact;"
            f" {contact.close()} within {1000 * CONTACT} mm"
        )
    print(f"  reasons: {wrong} wrong, {unclear} too close to call")
    for contact in contacts.values():
        off = contact.differing()
        assert np.abs(off).max(initial=0.0) <= CONTACT
        assert len(off) < 0.01 * count
    assert wrong == 0
    # Few enough that being too close to call is no way out; a small sample may have some more.
    assert unclear < 0.01 * count + 5
    # Self-collision and the object have hits in every scene, the ground not.
    for reason in (Reason.SELF_COLLISION, Reason.OBJECT_COLLISION):
        assert 0.02 * count < sum(contacts[reason].verdicts) < 0.98 * count


def drawn(result: BuildResult, count: int, seed: list[int]) -> tuple[Array, Array]:
    """Configurations (count, 6) and their codes."""
    joints, codes = result.configurations.reshape(-1, 6), result.reasons.reshape(-1)
    solved = np.flatnonzero(codes != Reason.NO_SOLUTION)
    assert np.isnan(np.delete(joints, solved, axis=0)).all()
    rows = np.random.default_rng(seed).choice(solved, count, replace=False)
    return joints[rows], codes[rows]


@pytest.mark.parametrize("name", NAMES)
def test_some_target_poses_against_eaik(name: str) -> None:
    check_inverse(name, vertices=300, count=200)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_five_thousand_target_poses_against_eaik(name: str) -> None:
    check_inverse(name, vertices=5200, count=5000)


@pytest.mark.parametrize("name", NAMES)
def test_some_candidates_against_pinocchio_and_coal(name: str) -> None:
    check_candidates(name, vertices=120, count=120)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_five_thousand_candidates_against_pinocchio_and_coal(name: str) -> None:
    check_candidates(name, vertices=1000, count=5000)
