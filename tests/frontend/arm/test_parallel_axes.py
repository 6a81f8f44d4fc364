"""Planar arms and SCARAs: solutions and measures against Pinocchio, shipped arms, refusals."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import dh_arms
import numpy as np
import pinocchio as pin
import pytest
from assembled import load_robot
from bent_tools import BENT, tip_frame, tip_frames
from dh_arms import FILES
from hypothesis import given
from hypothesis import strategies as st
from independent import kinematics_apart, wrapped
from shipped import ROBOTS, TOP
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import BuildResult, Scene, build_surface
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.planar import PlanarThree, PlanarTwo, Scara, ScaraWithoutTurn
from cellcolor.frontend.arm.robot import (
    FREE_IN_PLANE,
    FREE_TURN,
    GIVEN_IN_PLANE,
    POSITION,
    POSITION_AND_TURN,
    Robot,
)
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.setup import Turn
from examples import examples

COBRA = TOP / "instances" / "planar" / "cobra600_pipe.toml"
KR6 = TOP / "instances" / "planar" / "kr6_r700_z200_plate.toml"
FLIP = np.diag([1.0, -1.0, -1.0])
GIVEN = ("RRPR", "RRRP", "PRRR", "RPRR", "RRR")  # the tool's turn, too
FREE = ("RRP", "RPR", "PRR", "RR")
every_order = pytest.mark.parametrize("order", GIVEN + FREE)


def arm(order: str, seed: int) -> tuple[Robot, InverseKinematics]:
    """Parallel axes up or down, frames turned and shifted by chance, and the tool beside them."""
    random = np.random.default_rng(seed)
    steps, before, arms = [], np.eye(3), 0
    for kind in order:
        after = FLIP if random.integers(2) else np.eye(3)
        step = np.eye(4)
        turn = pin.utils.rotate("z", random.uniform(-3, 3))
        step[:3, :3] = before.T @ turn @ after
        # Arms of some length, and everything else nearly beside its joint.
        arms += kind == "R"
        far = random.uniform(0.2, 0.4) if kind == "R" and arms > 1 else random.uniform(0.0, 0.02)
        away = random.uniform(-np.pi, np.pi)
        step[:3, 3] = before.T @ [far * np.cos(away), far * np.sin(away), random.uniform(-0.1, 0.1)]
        steps.append(step)
        before = after
    last = np.eye(4)
    last[:3, :3] = before.T @ FLIP
    text = dh_arms.urdf_of([*steps, last])
    for number, kind in enumerate(order, 1):
        if kind == "P":
            text = text.replace(f'"j{number}" type="revolute"', f'"j{number}" type="prismatic"')
    slides, turn_given = "P" in order, order in GIVEN
    out = 0.05 if turn_given else random.uniform(0.2, 0.4)
    fixed = parse_urdf(dh_arms.tool_of(f"{out} -0.02 0.1", "0 0 0.8"), "tool.urdf")
    whole = parse_urdf(text, "arm.urdf")
    robot = load_robot(whole, "flange", fixed, "tool_tip", len(order), prismatic=int(slides))
    if turn_given:
        task, family = (POSITION_AND_TURN, Scara) if slides else (GIVEN_IN_PLANE, PlanarThree)
        robot = dataclasses.replace(robot, task=task)
        return robot, TurnedKinematics(family, robot, FILES, Turn(along=(1, 0, 0)))
    robot = dataclasses.replace(robot, task=POSITION if slides else FREE_IN_PLANE)
    return robot, ScaraWithoutTurn(robot, FILES) if slides else PlanarTwo(robot, FILES)


def configurations(robot: Robot, count: int, seed: int) -> Array:
    """Random ones (count, joints): angles all around, and slides of 0.3 m to either side."""
    most = np.where(robot.slides, 0.3, np.pi)
    return np.random.default_rng(seed).uniform(-most, most, (count, robot.joints))


@given(st.sampled_from(GIVEN + FREE), st.integers(0, 2**32 - 1))
@examples(60)
def test_solutions_are_the_configurations_of_a_pose_by_name(order: str, seed: int) -> None:
    """Poses are Pinocchio's; every configuration is found, and the elbow is where it is said."""
    robot, kinematics = arm(order, seed)
    joints = configurations(robot, 1, seed)
    tips, directions, across = tip_frames(robot.model, joints)
    if isinstance(kinematics, TurnedKinematics):
        found = kinematics.solve_pose(tips, directions, across)[0]
    else:
        found = kinematics.solve(tips, directions)[0]
    assert found.shape == (2, robot.joints) and not np.isnan(found).any()
    # At a straight elbow both branches meet, and half of the digits are lost.
    off = np.where(robot.slides, np.abs(found - joints), wrapped(found - joints))
    assert off.max(axis=1).min() < 1e-6
    pose, ends = tip_frame(robot.model, joints[0]), [int(k) + 1 for k in robot.turning]
    for name, each in zip(kinematics.branches, found, strict=True):
        reached = tip_frame(robot.model, each)
        assert np.abs(reached.translation - pose.translation).max() < 1e-9
        turned = np.abs(reached.rotation - pose.rotation)
        # Where the turn is free it follows; the tool is upright all the same.
        assert turned[:, :2].max() < (1e-9 if order in GIVEN else 2.1)
        assert turned[:, 2].max() < 1e-9
        data = robot.model.createData()
        pin.forwardKinematics(robot.model, data, each)
        shoulder, elbow, *wrist = (data.oMi[k].translation[:2] for k in ends)
        chord, beside = (*wrist, tips[0, :2])[0] - shoulder, elbow - shoulder
        left = chord[0] * beside[1] - chord[1] * beside[0]  # the tool comes from above
        assert abs(left) < 1e-6 or (left > 0) == (name == "elbow-left")


@every_order
def test_poses_jacobians_torques_and_measures_are_pinocchios(order: str) -> None:
    robot, _ = arm(order, 8)
    assert kinematics_apart(robot, configurations(robot, 20, 1)) < 1e-9


def test_only_points_in_the_plane_have_solutions() -> None:
    robot, kinematics = arm("RR", 1)
    tips, directions, _ = tip_frames(robot.model, configurations(robot, 1, 1))
    for off, there in ((0.9e-4, True), (-0.9e-4, True), (1.1e-4, False), (-1.1e-4, False)):
        found = kinematics.solve(tips + np.array([0, 0, off]), directions)
        assert np.isnan(found).all() != there
    for degrees, there in ((0.09, True), (0.11, False), (180.0, False)):
        tilted = np.array([[np.sin(np.radians(degrees)), 0, -np.cos(np.radians(degrees))]])
        assert np.isnan(kinematics.solve(tips, tilted)).all() != there
    assert np.isnan(kinematics.solve(tips + np.array([2.0, 0, 0]), directions)).all()


# --- the shipped arms -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def built() -> BuildResult:
    return build_surface(Scene.read(COBRA).varied(object={"target_vertices": 300}))


def test_the_kr6_is_solved_from_its_urdf_to_a_proven_minimum() -> None:
    """On a coarse mesh a search through all colorings of the vertices has the same minimum.

    Published: 425 and 275 mm, 700 in all; 170, 145 and 360 degrees; a stroke of 200 mm downwards.
    """
    result = build_surface(Scene.read(KR6).varied(object={"target_vertices": 60}))
    assert np.diff(forward(result.robot, np.zeros((1, 3))).origin[0, 1:, 0]) == pytest.approx(
        [0.425, 0.275]
    )
    assert np.degrees(result.robot.upper) == pytest.approx([170, 145, 360])
    found = cellcolor.solve(result)
    assert found.optimal and found.segments == vertex_minimum(result.surface) == 2


@pytest.mark.parametrize(
    ("file", "kinematics", "fixed"),
    [(COBRA, "scara-rrp", {"joint_4": 0.3}), (KR6, "planar-2r", {"joint_3": 0.16, "joint_4": 0.5})],
)
def test_a_free_turn_takes_the_arm_without_its_last_joint(
    file: Any, kinematics: str, fixed: dict[str, float]
) -> None:
    """The same elbows at the same places; the tool's turn follows from them."""
    whole = Scene.read(file).varied(object={"target_vertices": 60})
    robot = {"kinematics": kinematics, "fixed_joints": fixed}
    setup = whole.setup.varied(robot=robot, task={"turn": None})
    result, other = build_surface(whole.with_setup(setup)), build_surface(whole)
    assert np.array_equal(result.reasons == 1, other.reasons == 1)
    assert np.allclose(
        result.configurations, other.configurations[..., :-1], atol=1e-9, equal_nan=True
    )
    assert cellcolor.solve(result).segments == 2


def test_the_tool_comes_from_outside_whatever_the_normal(built: BuildResult) -> None:
    prepared = prepare(built.scene)
    point = np.array([[0.45, 0.1, 0.15]])
    for degrees, there in ((0, True), (60, True), (89, True), (91, False), (180, False)):
        tilt = np.radians(degrees)
        direction = np.array([[np.sin(tilt), 0, -np.cos(tilt)]])
        assert np.isnan(prepared.arm.kinematics.solve(point, direction)).all() != there
        # At 90 degrees the rule's vector is along the normal, and says all the same what it says.
        assert not prepared.arm.without_turn(point, direction).any()


def test_a_plan_in_joints_is_held_to_meters(built: BuildResult) -> None:
    own = np.where(built.reasons[:, 0] == VALID, 0, 1)
    joints = built.configurations[np.arange(len(own)), own].copy()
    reached = (built.reasons == VALID).any(axis=1)
    joints[~reached] = np.nan
    oracle = cellcolor.Oracle(built)
    verdict = oracle.judge(cellcolor.JointPlan(joints))
    assert verdict.problems == () and verdict.segments == 2
    vertex, slide = int(np.flatnonzero(reached)[0]), 2
    at = joints[vertex, slide]
    for step, said in ((0.01, "10 mm off the vertex"), (2 * np.pi, "6283 mm off the vertex")):
        joints[vertex, slide] = at + step
        (problem,) = oracle.judge(cellcolor.JointPlan(joints)).problems
        assert said in problem and re.search(r"joints \(\S+, \S+, \S+ m, \S+\) rad$", problem)


# --- refusals -----------------------------------------------------------------------------------


def refused(path: Any, **changes: dict[str, object]) -> InputError:
    """The one line in which a scene is refused once its setup is changed."""
    scene = Scene.read(path).varied(object={"target_vertices": 20})
    with pytest.raises(InputError) as caught:
        build_surface(scene.with_setup(scene.setup.varied(**changes)))
    assert "\n" not in str(caught.value)
    return caught.value


FREED: dict[str, Any] = {"task": {"turn": None}}
RRP: dict[str, Any] = {"kinematics": "scara-rrp"}
KINDS = "needs 3 revolute joints and 1 prismatic in a row.*has 3 revolute joints(?!.*redundant)"
MORE = "has 3 revolute joints and 1 prismatic; with more the arm is redundant"


@pytest.mark.parametrize(
    ("file", "changes", "field", "said"),
    [
        (COBRA, FREED, "robot.kinematics", "redundant.*'scara-rrp' for 'scara'"),
        (COBRA, {"robot": RRP | {"fixed_joints": {"joint_4": 0.0}}}, "task.turn", "4 dimensions"),
        (COBRA, {"robot": {"fixed_joints": {"joint_3": 0.1}}}, None, KINDS),
        (COBRA, {"robot": RRP, **FREED}, None, MORE),
        (COBRA, {"robot": {"kinematics": "planar-3r"}}, "joint[joint_3].type", "as 'scara'"),
        (KR6, FREED, "robot.kinematics", "redundant.*planar-2r"),
        (
            KR6,
            {"robot": {"kinematics": "planar-2r", "fixed_joints": {"joint_3": 0, "joint_4": 0.5}}},
            "task.turn",
            "2 joints.*3 dimensions|3 dimensions.*2 joints",
        ),
        (KR6, {"robot": {"fixed_joints": {}}}, "joint[joint_3].type", "fixed_joints"),
        (
            KR6,
            {"robot": {"fixed_joints": {"joint_3": 0.21}}},
            None,
            "outside the joint's limits, 0 to",
        ),
        *(
            (file, {table: {key: None, f"{key}_m3": 0.01}}, f"{table}.{key}_m3", key)
            for file in (COBRA, KR6)
            for table, key in (
                ("thresholds", "min_manipulability"),
                ("thresholds", "min_task_determinant"),
                ("continuity", "near_singular_determinant"),
            )
        ),
    ],
)
def test_setups_that_do_not_fit_the_arm(
    file: Any, changes: dict[str, Any], field: str | None, said: str
) -> None:
    error = refused(file, **changes)
    assert re.search(said, error.message), error.message
    assert field is None or error.field == field


def test_axes_that_are_not_parallel_and_links_without_length_are_refused() -> None:
    text = (ROBOTS / "cobra600.urdf").read_text()
    own = '<axis xyz="0 0 1"/>\n    <limit lower="0"'
    bent = text.replace(own, own.replace("0 0 1", "0 1 0"))
    error = refused(COBRA, robot={"arm_urdf": bent})
    assert error.field == "joint[joint_3]" and "not parallel" in error.message
    whole = parse_urdf(dh_arms.urdf_of([np.eye(4)] * 3), "arm.urdf")
    for at, said in (
        (BENT, "not parallel to the tool's z axis"),
        (("0 0 1", "0 0 0"), "no length"),
    ):
        with pytest.raises(InputError, match=said):
            PlanarTwo(
                load_robot(whole, "flange", parse_urdf(dh_arms.tool_of(*at), "t"), "tool_tip", 2),
                FILES,
            )


class Nameless(ScaraWithoutTurn):
    branches = ()  # type: ignore[assignment]


class FreeTurn(Scara):
    free_turn = FREE_TURN


@pytest.mark.parametrize(
    ("family", "fixed", "field", "said"),
    [
        (Nameless, {"joint_4": 0.0}, "robot.kinematics", "need names"),
        (FreeTurn, {}, "joint[joint_4]", "redundant.*joint_4 = 0.0"),
    ],
)
def test_somebodys_own_family_with_a_prismatic_joint(
    monkeypatch: pytest.MonkeyPatch, family: type, fixed: Any, field: str, said: str
) -> None:
    monkeypatch.setattr(KINEMATICS, "find", lambda *_: family)
    error = refused(COBRA, robot={"fixed_joints": fixed}, **FREED)
    assert error.field == field and re.search(said, error.message)


def test_a_turn_cannot_be_given_where_the_last_joint_slides_across() -> None:
    robot, _ = arm("RRRP", 3)
    robot.axis[3] = [1.0, 0.0, 0.0]
    with pytest.raises(InputError, match="slides across") as caught:
        TurnedKinematics(Scara, robot, FILES, Turn(along=(1, 0, 0)))
    assert caught.value.field == "joint[j4]"
