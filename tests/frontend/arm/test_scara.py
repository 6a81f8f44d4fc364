"""SCARAs whose prismatic joint moves: solutions, measures, limits, a scene by hand, refusals."""

from __future__ import annotations

import re
from functools import partial

import numpy as np
import pinocchio as pin
import pytest
from bent_tools import tip_frame, tip_frames
from hypothesis import given
from hypothesis import strategies as st
from refused_setups import refused_setup
from scaras import (
    ORDERS,
    WITHOUT_TURN,
    configurations,
    distance,
    newton_solutions,
    scara,
    sets_apart,
)
from shipped import ROBOTS, TOP

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import BuildResult, Scene, Setup, build_surface
from cellcolor.frontend.arm.inverse import KINEMATICS, InverseKinematics
from cellcolor.frontend.arm.kinematics import (
    forward,
    gravity_torques,
    manipulability,
    static_torques,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.planar import Scara, ScaraWithoutTurn
from cellcolor.frontend.arm.robot import FREE_TURN, Robot
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.reach.continuity import stays_in_limits
from cellcolor.frontend.reach.smooth import Measure
from cellcolor.frontend.reach.validity import turned_into_limits
from cellcolor.frontend.setup import RobotFiles, Turn
from cellcolor.motion.posture import color_costs
from cellcolor.pictures.arm import draw_arm
from examples import examples

pytestmark = pytest.mark.second

FILES = RobotFiles(arm_urdf="<", flange_link="flange", tool_urdf="<", tip_link="tool_tip")
SCENE = TOP / "instances" / "planar" / "cobra600_pipe.toml"
EVERY = (*ORDERS, *WITHOUT_TURN)
seeds = st.integers(0, 2**32 - 1)


def solved(robot: Robot, joints: Array) -> Array:
    """All solutions of the poses of configurations (n, joints)."""
    tips, directions, across = tip_frames(robot.model, joints)
    if robot.joints == 4:
        kinematics = TurnedKinematics(Scara, robot, FILES, Turn(along=(1, 0, 0)))
        return kinematics.solve_pose(tips, directions, across)
    return ScaraWithoutTurn(robot, FILES).solve(tips, directions)


# --- solutions ----------------------------------------------------------------------------------


@given(st.sampled_from(EVERY), seeds)
@examples(30)
def test_every_configuration_is_among_the_solutions_of_its_pose(order: str, seed: int) -> None:
    """Poses are Pinocchio's, and both solutions reach them."""
    robot = scara(order, seed)
    joints = configurations(robot, 1, seed)
    found, pose = solved(robot, joints)[0], tip_frame(robot.model, joints[0])
    assert found.shape == (2, robot.joints) and not np.isnan(found).any()
    # At a straight elbow both branches meet, and half of the digits are lost.
    assert min(distance(robot, each, joints[0]) for each in found) < 1e-6
    for each in found:
        reached = tip_frame(robot.model, each)
        assert np.abs(reached.translation - pose.translation).max() < 1e-9
        turned = np.abs(reached.rotation - pose.rotation)
        # With three joints the turn follows; the tool is upright all the same.
        assert turned[:, :2].max() < (1e-9 if robot.joints == 4 else 2.1)
        assert turned[:, 2].max() < 1e-9


@pytest.mark.parametrize("order", EVERY)
def test_the_same_solutions_as_by_newton_from_many_starts(order: str) -> None:
    """On Pinocchio's Jacobian."""
    robot = scara(order, 3)
    joints = configurations(robot, 30, 5)
    for row, ours in enumerate(solved(robot, joints)):
        theirs = newton_solutions(
            robot, tip_frame(robot.model, joints[row]), configurations(robot, 16, row)
        )
        assert len(ours) == 2 and sets_apart(robot, ours, theirs) < 1e-6


@pytest.mark.parametrize("order", EVERY)
def test_poses_jacobians_and_torques_are_pinocchios(order: str) -> None:
    robot = scara(order, 8)
    q, gravity = configurations(robot, 20, 1), np.array([0.3, -1.0, -9.81])
    poses = forward(robot, q)
    linear, angular = tip_jacobian(poses)
    held = gravity_torques(robot, poses, gravity)
    pressed = static_torques(robot, poses, linear, gravity, 20.0)
    model, data = robot.model, robot.model.createData()
    model.gravity.linear = gravity
    frame = model.getFrameId("tool_tip")
    for row, joints in enumerate(q):
        own = pin.computeFrameJacobian(
            model, data, joints, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        pin.framesForwardKinematics(model, data, joints)
        there = data.oMf[frame]
        assert np.abs(poses.tip[row] - there.translation).max() < 1e-12
        assert np.abs(poses.tool_axis[row] - there.rotation[:, 2]).max() < 1e-12
        assert np.abs(np.vstack([linear[row], angular[row]]) - own).max() < 1e-12
        still = pin.computeGeneralizedGravity(model, data, joints)
        assert np.abs(held[row] - still).max() < 1e-9
        push = own[:3].T @ (20.0 * there.rotation[:, 2])
        assert np.abs(pressed[row] - still - push).max() < 1e-9
        # Volumes of what the asked-for rows of Pinocchio's Jacobian span.
        rows = [0, 1, 2, 5][: robot.joints]
        determinant = task_determinant(linear, angular, poses.tool_axis, robot.task)[row]
        assert determinant == pytest.approx(abs(np.linalg.det(own[rows])), abs=1e-12)
        sizes = np.linalg.svd(own[:3], compute_uv=False)
        assert manipulability(linear, robot.task)[row] == pytest.approx(sizes.prod(), abs=1e-9)


def test_the_measures_of_an_arm_twice_as_large_are_four_times_as_large() -> None:
    """So shares of the square of the reach mean the same for both."""
    small, large = scara("RRPR", 4), scara("RRPR", 4)
    for each in (large.placement, large.tip[None]):
        each[:, :3, 3] *= 2
    q = configurations(small, 20, 2)
    twice = np.where(small.slides, 2 * q, q)
    for robot, joints, factor in ((small, q, 4.0), (large, twice, 1.0)):
        poses = forward(robot, joints)
        linear, angular = tip_jacobian(poses)
        own = task_determinant(linear, angular, poses.tool_axis, robot.task)
        measured = factor * np.array([own, manipulability(linear, robot.task)])
        if robot is small:
            expected = measured
    assert measured == pytest.approx(expected)


# --- limits and steps in m ------------------------------------------------------------------------


def test_only_turning_joints_are_modulo_full_circles() -> None:
    robot = scara("RRPR", 3)
    robot.lower[:], robot.upper[:] = [-1, -1, 0.0, -1], [6, 6, 0.2, 6]
    q = np.array([[-2.0, 7.0, -0.1, 0.0], [0.0, 0.0, 0.3, -6.0]])
    turned = turned_into_limits(robot, q)
    assert turned[:, 2].tolist() == [-0.1, 0.3]
    assert turned[0] == pytest.approx([2 * np.pi - 2, 7 - 2 * np.pi, -0.1, 0])

    def fits(low: float, high: float, start: float = 0.1) -> bool:
        at, one = np.array([0.0, 0.0, start, 0.0]), np.array([0.0, 0.0, 1.0, 0.0])
        limits = robot.lower, robot.upper
        return bool(stays_in_limits(*limits, at, low * one, high * one, robot.slides))

    assert fits(-0.1, 0.1) and not fits(-0.11, 0.0) and not fits(0.0, 0.11)
    assert not fits(0.0, 0.0, start=0.1 + 2 * np.pi)


def test_a_slide_as_far_as_the_reach_counts_as_a_radian() -> None:
    policy = Setup.read(ROBOTS / "cobra600_dispensing.toml").continuity
    slides = np.array([False, True])
    measure = Measure(policy, 0.1, 0.0, slides, reach=0.5)
    first, second = np.array([[0.1, 7.0]]), np.array([[0.1 + 2 * np.pi, 0.0]])
    assert measure.step(first, second) == pytest.approx([7.0 / 0.5])
    assert measure.step(first, first + np.array([0.3, 0.1])) == pytest.approx([0.3])


# --- the shipped arm ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def built() -> BuildResult:
    return build_surface(Scene.read(SCENE).varied(object={"target_vertices": 300}))


def expected(points: Array, share: float) -> dict[str, Array]:
    """Where each elbow gets, by trigonometry; NaN where rounding or thresholds could decide.

    Arms of 325 and 275 mm; joint 1 turns by 50 degrees to either side, joint 2 by 88. Twice the
    triangle of shoulder, elbow and tip, the task determinant, is at least a share of the square of
    the reach.
    """
    out, around = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    cosine = (out**2 - 0.325**2 - 0.275**2) / (2 * 0.325 * 0.275)
    bend = np.arccos(np.clip(cosine, -1, 1))
    ahead = np.arctan2(0.275 * np.sin(bend), 0.325 + 0.275 * np.cos(bend))
    area = 0.325 * 0.275 * np.sin(bend)
    found = {}
    for name, side in (("elbow-left", 1.0), ("elbow-right", -1.0)):
        # An elbow on the left is ahead of the tip, seen turning to the left.
        room = np.minimum(np.radians(50) - np.abs(around + side * ahead), np.radians(88) - bend)
        room = np.where(np.abs(cosine) < 1, np.minimum(room, area - share * 0.36), -1.0)
        found[name] = np.where(np.abs(room) < 1e-9, np.nan, (room > 0).astype(float))
    return found


def test_where_each_elbow_gets_is_what_trigonometry_says(built: BuildResult) -> None:
    points = built.surface.vertices
    known = expected(points, 0.02)
    for branch, name in enumerate(built.branches):
        sure = ~np.isnan(known[name])
        valid = built.reasons[:, branch] == VALID
        assert sure.sum() > 290 and np.array_equal(valid[sure], known[name][sure] == 1)
        assert 0 < valid.sum() < len(points)
    valid = np.argwhere(built.reasons == VALID)
    slides = built.configurations[:, :, 2][tuple(valid.T)]
    assert np.ptp(slides) > 0.07  # the joint does move, up and down with the part
    assert slides == pytest.approx(0.387 - 0.1 - points[valid[:, 0], 2], abs=1e-12)
    for vertex, branch in valid[::11]:
        pose = tip_frame(built.robot.model, built.configurations[vertex, branch])
        assert np.abs(pose.translation - points[vertex]).max() < 1e-9
        assert np.abs(pose.rotation - np.diag([1, -1, -1])).max() < 1e-9  # x along x, z down


def test_two_segments_since_each_end_is_for_one_elbow(built: BuildResult) -> None:
    """By hand: 0.23 m to either side, 0.45 m in front, is one elbow's; in the middle both get.

    Of the first the tip is 505 mm away, at 27.1 degrees, and the elbow 29.8 ahead: 57 to one side,
    where joint 1 ends at 50, and 3 to the other.
    """
    known = expected(np.array([[0.45, 0.23, 0.1], [0.45, -0.23, 0.1], [0.45, 0.0, 0.1]]), 0.02)
    assert {name: each.tolist() for name, each in known.items()} == {
        "elbow-left": [0.0, 1.0, 1.0],
        "elbow-right": [1.0, 0.0, 1.0],
    }
    found = cellcolor.solve(built)
    assert found.optimal and found.solution.proved_for_surface and found.segments == 2
    assert built.surface.cracks == ()


def test_what_the_stroke_does_not_reach_fails_its_limits() -> None:
    """From 77 to 287 mm above the base: 387 less the tool's 100, less the stroke of 210."""
    scene = Scene.read(SCENE).varied(object={"target_vertices": 200})
    for lift in (0.12, -0.11):
        place = scene.placement.position_m
        moved = build_surface(scene.moved(position_m=(place[0], place[1], place[2] + lift)))
        heights = moved.surface.vertices[:, 2]
        beyond = (heights > 0.287) | (heights < 0.077)
        assert 0 < beyond.sum() < len(heights)
        solutions = moved.reasons != 1
        names = moved.reason_names
        assert (moved.reasons[beyond][solutions[beyond]] == names.index("joint limits")).all()
        assert (moved.reasons[~beyond] == VALID).any()


def test_position_only_takes_the_arm_without_its_last_joint(built: BuildResult) -> None:
    """The same elbows and slides at the same places; the tool's turn follows."""
    scene = built.scene
    robot = {"kinematics": "scara-rrp", "fixed_joints": {"joint_4": 0.3}}
    other = build_surface(scene.with_setup(scene.setup.varied(robot=robot, task={"turn": None})))
    assert np.array_equal(other.reasons != 1, built.reasons[:, :, None][..., 0] != 1)
    assert np.allclose(
        other.configurations, built.configurations[..., :3], atol=1e-9, equal_nan=True
    )
    assert cellcolor.solve(other).segments == 2
    assert other.robot.task.dimensions == 3 and built.robot.task.dimensions == 4


def test_the_tool_comes_from_outside_whatever_the_normal(built: BuildResult) -> None:
    prepared = prepare(built.scene)
    point = np.array([[0.45, 0.1, 0.15]])
    for degrees, there in ((0, True), (60, True), (89, True), (91, False), (180, False)):
        tilt = np.radians(degrees)
        direction = np.array([[np.sin(tilt), 0, -np.cos(tilt)]])
        assert np.isnan(prepared.kinematics.solve(point, direction)).all() != there
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
    vertex = int(np.flatnonzero(reached)[0])
    joints[vertex, 2] += 0.01
    off = oracle.judge(cellcolor.JointPlan(joints))
    assert len(off.problems) == 1 and "10 mm off the vertex" in off.problems[0]
    assert re.search(r"joints \(\S+, \S+, \S+ m, \S+\) rad$", off.problems[0])
    joints[vertex, 2] += 2 * np.pi - 0.01
    far = oracle.judge(cellcolor.JointPlan(joints))
    assert "6283 mm off the vertex" in far.problems[0]


def test_it_is_painted_and_drawn_with_its_units(built: BuildResult) -> None:
    found = cellcolor.solve(built)
    painted = cellcolor.paint(built, found)
    verdict = cellcolor.Oracle(painted.surface).judge(painted.plan)
    assert verdict.problems == () and verdict.segments == 2
    costs = color_costs(built.robot, built.stages.candidates)
    valid = built.reasons == VALID
    assert (costs[~valid] == 1).all() and (costs[valid] < 1).all()
    vertex, branch = np.argwhere(valid)[0]
    q = built.configurations[vertex, branch]
    picture = draw_arm(built, int(vertex), int(branch))
    assert any(f"{1000 * q[2]:.1f} mm" in note for note in picture.notes)


# --- refusals -----------------------------------------------------------------------------------

refused = partial(refused_setup, SCENE)


def test_four_joints_and_a_free_turn_are_redundant() -> None:
    error = refused(task={"turn": None})
    assert error.field == "robot.kinematics" and "redundant" in error.message
    assert "task.turn" in error.message and "'scara-rrp' for 'scara'" in error.message


def test_a_given_turn_is_more_than_three_joints_can_do() -> None:
    error = refused(robot={"kinematics": "scara-rrp", "fixed_joints": {"joint_4": 0.0}})
    assert error.field == "task.turn" and "4 dimensions" in error.message


def test_joints_of_the_wrong_kind_are_counted() -> None:
    error = refused(robot={"fixed_joints": {"joint_3": 0.1}})
    assert "needs 3 revolute joints and 1 prismatic in a row" in error.message
    assert "has 3 revolute joints" in error.message and "redundant" not in error.message
    error = refused(robot={"kinematics": "scara-rrp"}, task={"turn": None})
    assert "has 3 revolute joints and 1 prismatic; with more the arm is redundant" in error.message
    error = refused(robot={"kinematics": "planar-3r"})
    assert error.field == "joint[joint_3].type" and "as 'scara'" in error.message


def test_thresholds_in_cubic_meters_are_refused() -> None:
    error = refused(thresholds={"min_manipulability": None, "min_manipulability_m3": 0.01})
    assert error.field == "thresholds.min_manipulability_m3" and "m^2" in error.message


def test_an_axis_that_is_not_parallel_is_refused() -> None:
    text = (ROBOTS / "cobra600.urdf").read_text()
    bent = text.replace(
        '<axis xyz="0 0 1"/>\n    <limit lower="0"', '<axis xyz="0 1 0"/>\n    <limit lower="0"'
    )
    assert bent != text
    error = refused(robot={"arm_urdf": bent})
    assert error.field == "joint[joint_3]" and "not parallel" in error.message


def test_a_family_with_a_prismatic_joint_needs_names(monkeypatch: pytest.MonkeyPatch) -> None:
    class Nameless(ScaraWithoutTurn):
        branches = ()  # type: ignore[assignment]

    monkeypatch.setattr(KINEMATICS, "find", lambda _: Nameless)
    error = refused(robot={"fixed_joints": {"joint_4": 0.0}}, task={"turn": None})
    assert error.field == "robot.kinematics" and "need names" in error.message


def test_a_last_joint_that_only_turns_the_tool_is_redundant(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of somebody's own family of fewer than six joints, whose task leaves the turn free."""

    class Own(Scara):
        free_turn = FREE_TURN

    monkeypatch.setattr(KINEMATICS, "find", lambda _: Own)
    error = refused(task={"turn": None})
    assert error.field == "joint[joint_4]" and "redundant" in error.message
    assert "joint_4 = 0.0" in error.message


def test_a_turn_cannot_be_given_where_the_last_joint_slides_across() -> None:
    robot = scara("RRRP", 3)
    robot.axis[3] = [1.0, 0.0, 0.0]
    with pytest.raises(InputError, match="slides across") as caught:
        TurnedKinematics(Scara, robot, FILES, Turn(along=(1, 0, 0)))
    assert caught.value.field == "joint[j4]"


def test_reach_is_what_no_configuration_exceeds() -> None:
    for order in EVERY:
        robot = scara(order, 6)
        kinematics: InverseKinematics = (
            TurnedKinematics(Scara, robot, FILES, Turn(along=(1, 0, 0)))
            if robot.joints == 4
            else ScaraWithoutTurn(robot, FILES)
        )
        q = configurations(robot, 20_000, 2)
        poses, first = forward(robot, q), int(robot.turning[0])
        far = np.hypot(*(poses.tip - poses.origin[:, first + 1])[:, :2].T).max()
        assert 0.98 * kinematics.reach < far <= kinematics.reach + 1e-12
