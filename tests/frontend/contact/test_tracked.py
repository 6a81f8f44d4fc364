"""Points that say how far bodies move: none of a solid's points moves farther than they."""

from __future__ import annotations

import numpy as np
import pytest
from assembled import load_robot
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import link_meshes, write_package
from shipped import ROBOTS

from cellcolor.frontend.arm.kinematics import forward, turned
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.tip import tracked_points, tracked_steps
from examples import examples


@pytest.fixture(scope="module")
def meshed(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    package = write_package(tmp_path_factory.mktemp("arm"), "toy_description")
    files = (ROBOTS / "polishing_tool.urdf", "tool_tip")
    return load_robot(package / "urdf" / "arm.urdf", "wrist_3_link", *files)


@examples(15)
@given(seed=st.integers(0, 2**32 - 1), far=st.sampled_from([1e-3, 0.1, 3.0]))
def test_no_point_of_a_mesh_moves_farther_than_a_corner(
    meshed: Robot, seed: int, far: float
) -> None:
    random = np.random.default_rng(seed)
    start = random.uniform(-np.pi, np.pi, 6)
    joints = np.array([start, start + random.uniform(-far, far, 6)])
    poses = forward(meshed, joints)
    tracked = tracked_points(meshed, poses)
    moved = np.linalg.norm(tracked[:, 1] - tracked[:, 0], axis=1)
    first = 0
    for body in meshed.bodies:
        if body.joint == 0:
            continue
        count = len(body.outline)
        if body.solid is not None:
            points = np.array(link_meshes()[body.link].vertices)
            places = turned(poses.rotation[:, body.joint], points.T).transpose(0, 2, 1)
            places += poses.origin[:, body.joint, None]
            own = np.linalg.norm(places[1] - places[0], axis=1).max()
            assert own <= moved[first : first + count].max() + 1e-9
        first += count
    assert first == len(tracked) == len(tracked_steps(meshed, 0.0, 0.0))
