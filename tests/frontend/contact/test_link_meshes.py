"""Links with meshes: verdicts of the planner's engine, coal, and of the judge's, python-fcl."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from assembled import load_robot
from meshed_arm import write_package
from shipped import ROBOTS
from world import KINDS, standing

from cellcolor.arrays import Array
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, Pair, pairs_of, pairs_with
from cellcolor.frontend.contact.obstacle import BoxObstacle, CylinderObstacle, SphereObstacle
from cellcolor.frontend.parts.shapes import CapObject
from cellcolor.frontend.scene import Ground
from cellcolor.trajectory_checker.validity import touching

pytestmark = pytest.mark.second

GROUND, EXEMPT = -0.05, ("base_link", "shoulder_link")
ASIDE = (0.35, -0.1, 0.35)
OBSTACLES = [
    BoxObstacle(size_m=(0.1, 0.4, 0.2), position_m=ASIDE),
    SphereObstacle(radius_m=0.2, position_m=ASIDE),
    CylinderObstacle(radius_m=0.1, height_m=0.5, position_m=ASIDE),
]
# So small that it can be inside a link, which no surface notices.
BEAD = SphereObstacle(radius_m=0.004, position_m=ASIDE)


@pytest.fixture(scope="module", params=["hull", "exact"])
def meshed(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Robot:
    package = write_package(tmp_path_factory.mktemp(request.param), "toy_description")
    return load_robot(
        package / "urdf" / "arm.urdf",
        "wrist_3_link",
        ROBOTS / "polishing_tool.urdf",
        "tool_tip",
        mesh_collision=request.param,
    )


def check(robot: Robot, pairs: Sequence[Pair], joints: Array) -> None:
    """Both engines say the same, and each verdict is given now and then."""
    found = Contacts(pairs, robot)(joints)
    by_fcl = touching(list(pairs), forward(robot, joints))
    assert 0.01 < found.mean() < 0.97
    # The distances of fcl are rough: beside what touches, it never errs by more than 0.6 mm.
    rough = 0.0006 if any(margin for _, _, margin in pairs) else 0.0
    surely = Contacts([(one, other, margin - rough) for one, other, margin in pairs], robot)(joints)
    assert not (surely & ~by_fcl).any() and not (by_fcl & ~found).any()


@pytest.mark.parametrize("count", [250, pytest.param(2000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("margin", [0.0, 0.006])
def test_verdicts_agree(meshed: Robot, tmp_path: Path, margin: float, count: int) -> None:
    joints = np.random.default_rng(11).uniform(-np.pi, np.pi, (count, 6))
    check(meshed, pairs_of(meshed, margin), joints)
    others = [standing(kind, np.array(ASIDE), tmp_path)[0] for kind in KINDS]
    for obstacle in (*OBSTACLES, *others):
        check(meshed, pairs_with(meshed, [obstacle.solid()], margin), joints)
    near = np.linalg.norm(forward(meshed, joints).tip - ASIDE, axis=1) < 0.35
    check(meshed, pairs_with(meshed, [BEAD.solid()], margin), joints[near])
    ground = Ground(height_m=GROUND).half_space
    free = [body for body in meshed.bodies if body.link not in EXEMPT]
    check(meshed, [(body, ground, margin) for body in free], joints)
    cap = CapObject(
        radius_m=0.3, half_angle_rad=1.2, target_vertices=400, jitter=0.2, seed=3
    ).surface()
    shell = Shape("mesh", vertices=cap.vertices + np.array([0.45, 0.0, 0.1]), faces=cap.faces)
    check(meshed, pairs_with(meshed, [shell], margin), joints)
