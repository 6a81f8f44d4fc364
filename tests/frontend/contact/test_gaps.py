"""Gaps between bodies: never more than a distance, and what they leave fcl to decide."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from meshed_arm import link_meshes, write_package
from scipy.spatial.transform import Rotation
from shipped import ROBOTS

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import forward, turned
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.polyhedron import Polyhedron, box
from cellcolor.frontend.arm.robot import Robot, wider
from cellcolor.frontend.contact import collision, fcl_bodies
from cellcolor.frontend.contact.collision import body_ends, gap_between, hits_itself
from examples import examples


@pytest.fixture(scope="module")
def meshed(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    package = write_package(tmp_path_factory.mktemp("arm"), "toy_description")
    files = (ROBOTS / "polishing_tool.urdf", "tool_tip")
    return load_robot(package / "urdf" / "arm.urdf", "wrist_3_link", *files)


@pytest.fixture(scope="module")
def clouds(meshed: Robot) -> list[Array]:
    """Points of each body's surface in the frame of its joint, (k, 3), from the mesh as made."""
    found = []
    for body in meshed.bodies:
        mesh = link_meshes().get(body.link)
        if mesh is None:
            axis = np.array([body.start, body.end])
            mesh = trimesh.creation.cylinder(radius=body.radius, segment=axis, sections=64)
        on_faces = trimesh.sample.sample_surface(mesh, 200, seed=1)[0]
        found.append(np.concatenate([mesh.vertices, on_faces]))
    return found


@examples(25)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_two_points_are_nearer_than_the_gap(
    meshed: Robot, clouds: list[Array], seed: int
) -> None:
    joints = np.random.default_rng(seed).uniform(-np.pi, np.pi, (1, 6))
    poses = forward(meshed, joints)
    ends = body_ends(meshed, poses)
    placed = [
        turned(poses.rotation[:, body.joint], points.T)[0].T + poses.origin[0, body.joint]
        for body, points in zip(meshed.bodies, clouds, strict=True)
    ]
    for i, j in meshed.tested_pairs:
        gap = gap_between(meshed, (i, j), ends, poses, np.array([0]))[0]
        away = np.linalg.norm(placed[i][:, None] - placed[j][None], axis=2).min()
        assert gap <= away + 1e-6


def test_gaps_by_hand(meshed: Robot) -> None:
    """Boxes and round bodies 30 mm apart, whose capsules overlap; skins and radii count."""
    cube = Polyhedron(*box((0.1, 0.1, 0.1)))
    at = np.array([0.13, 0.0, 0.0])
    beside = Polyhedron(cube.vertices + at, cube.faces)
    zero = np.zeros(3)
    first = Body("first", 0, zero, zero, 0.09, False, cube, 0.004)
    up = np.array([0.0, 0.0, 0.05])
    others = [
        (Body("box", 0, at, at, 0.09, False, beside), 0.026),
        (Body("capsule", 0, at - up, at + up, 0.05, False), 0.026),
        (Body("cylinder", 0, at - up, at + up, 0.05, True), 0.026),
        # Seen from its end a cylinder reaches as far as its axis, and a capsule farther.
        (Body("on end", 0, at - up[[2, 1, 0]], at + up[[2, 1, 0]], 0.09, True), 0.026),
    ]
    poses = forward(meshed, np.zeros((2, 6)))
    for other, expected in others:
        robot = replace(meshed, bodies=(first, other))
        ends = body_ends(robot, poses)
        for pair in ((0, 1), (1, 0)):
            found = gap_between(robot, pair, ends, poses, np.array([1]))
            assert found == pytest.approx([expected], abs=1e-9), other.link


@pytest.mark.parametrize("margin", [0.0, 0.006])
def test_fcl_is_spared_and_says_the_same(
    meshed: Robot, margin: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Against verdicts with fcl asked wherever capsules overlap."""
    robot = wider(meshed, margin)
    joints = np.random.default_rng(3).uniform(-np.pi, np.pi, (1000, 6))
    poses = forward(robot, joints)
    ends = body_ends(robot, poses)
    asked: list[int] = []
    touch = fcl_bodies.bodies_touch

    def counted(first: Body, at: tuple[Array, Array], *second: object) -> Mask:
        asked.append(len(at[1]))
        return touch(first, at, *second)  # type: ignore[arg-type]

    monkeypatch.setattr(collision, "bodies_touch", counted)
    hit = hits_itself(robot, ends, poses)
    spared = sum(asked)
    asked.clear()
    monkeypatch.setattr(collision, "gap_between", lambda *_: np.zeros(len(_[-1])))
    assert (hits_itself(robot, ends, poses) == hit).all()
    assert 0 < hit.sum() < len(hit)
    assert spared < 0.7 * sum(asked)


@examples(40)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_motion_past_a_solid_is_judged_as_place_by_place(seed: int) -> None:
    """Two boxes with skins of 5 mm, of which one is turned and moved in 60 small steps."""
    rng = np.random.default_rng(seed)
    cube = Polyhedron(*box((0.1, 0.06, 0.2)))
    body = Body("box", 0, np.zeros(3), np.zeros(3), 0.2, False, cube, 0.005)
    share = np.linspace(0.0, 1.0, 60)[:, None]
    one, other = rng.uniform(-0.3, 0.3, (2, 3))
    origins = one + share * (other - one)
    turns = Rotation.from_rotvec(share * rng.uniform(-2.0, 2.0, 3)).as_matrix()
    still = np.tile(np.eye(3), (60, 1, 1)), np.zeros((60, 3))
    found = fcl_bodies.bodies_touch(body, still, body, (turns, origins))
    alone = [
        fcl_bodies.bodies_touch(
            body,
            (still[0][k : k + 1], still[1][k : k + 1]),
            body,
            (turns[k : k + 1], origins[k : k + 1]),
        )[0]
        for k in range(60)
    ]
    assert found.tolist() == alone


def test_a_motion_that_stays_away_is_hardly_asked_about(monkeypatch: pytest.MonkeyPatch) -> None:
    """A box that moves by 1 m in 500 steps, never nearer than 0.4 m to another one."""
    cube = Polyhedron(*box((0.1, 0.1, 0.1)))
    body = Body("box", 0, np.zeros(3), np.zeros(3), 0.09, False, cube, 0.005)
    origins = np.column_stack([np.linspace(-0.5, 0.5, 500), np.full(500, 0.5), np.zeros(500)])
    still = np.tile(np.eye(3), (500, 1, 1)), np.zeros((500, 3))
    asked: list[float] = []
    distance = fcl_bodies._distance

    def counted(*objects: Any) -> float:
        asked.append(distance(*objects))
        return asked[-1]

    monkeypatch.setattr(fcl_bodies, "_distance", counted)
    assert not fcl_bodies.bodies_touch(body, still, body, (still[0], origins)).any()
    assert len(asked) < 10
