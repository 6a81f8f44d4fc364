"""A SCARA is planned, driven and judged; drives forged at its prismatic joint are refused."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from honest_drives import Honest
from joint_paths import MOTION, SLIDE, driven_scara, scara_scene

import cellcolor
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.trajectory_checker.check import check_trajectory

pytestmark = pytest.mark.second

NAME = "joint_3"


@pytest.fixture(scope="module")
def prepared() -> PreparedScene:
    return prepare(scara_scene())


@pytest.fixture(scope="module")
def honest(prepared: PreparedScene) -> Honest:
    made = driven_scara()
    assert made.solution.segments == 2
    return Honest(prepared, made.trajectory, 1)


def judged(prepared: PreparedScene, trajectory: Trajectory) -> TrajectoryVerdict:
    built = replace(driven_scara().built, prepared=prepared)
    return check_trajectory(built, trajectory, minimum_lift_offs=1)


def moved(honest: Honest, slide: np.ndarray) -> Trajectory:
    """The drive with the slide elsewhere, and the tips that belong to it."""
    joints = honest.trajectory.joints.copy()
    joints[:, SLIDE] = slide
    return replace(
        honest.trajectory, joints=joints, points=forward(honest.prepared.robot, joints).tip
    )


def test_a_slide_over_its_speed_is_refused(honest: Honest) -> None:
    """Only the slide is: the joints that turn may go a hundred times as fast."""
    motion = MOTION.model_copy(
        update={
            "joint_velocities_rad_per_s": (300.0, 300.0, 0.15, 600.0),
            "joint_accelerations_rad_per_s2": (8e4, 8e4, 2e4, 16e4),
            "speed_m_per_s": 10.0,
        }
    )
    slower = prepare(scara_scene(motion))
    trajectory = honest.trajectory
    assert judged(slower, trajectory).valid
    fast = judged(slower, replace(trajectory, times=np.asarray(trajectory.times) / 1.2))
    assert set(fast.fault_counts) == {"velocity"}
    assert {fault.joint for fault in fast.faults} == {NAME}
    assert re.search(r"moves at 0\.1[6-8]\d* m/s, allowed: 0\.15$", fast.faults[0].text)


def test_a_slide_beyond_its_limit_is_refused(honest: Honest) -> None:
    """Its range is from 0 to 0.21 m; on the way, where no surface says where the tip has to be."""
    trajectory = honest.trajectory
    row = trajectory.strokes[0][1] + 20
    assert not trajectory.contact[row]
    slide = trajectory.joints[:, SLIDE].copy()
    slide[row] = -0.0125
    verdict = judged(honest.prepared, moved(honest, slide))
    (fault,) = verdict.of_kind("joint limit")
    assert fault.joint == NAME
    assert "is at -0.01250 m, 12.5 mm beyond its limits of 0.00000 and 0.21000" in fault.text


def test_an_arm_for_the_position_only_is_driven_as_well() -> None:
    """Three joints, the slide among them; the turn of the tool follows."""
    scene = scara_scene(
        MOTION.model_copy(
            update={
                "joint_velocities_rad_per_s": (3.0, 3.0, 0.15),
                "joint_accelerations_rad_per_s2": (8.0, 8.0, 2.0),
            }
        )
    )
    robot = {"kinematics": "scara-rrp", "fixed_joints": {"joint_4": 0.3}}
    made = cellcolor.plan(scene.with_setup(scene.setup.varied(robot=robot, task={"turn": None})))
    assert made.verdict.valid and made.verdict.lift_offs == 1
    assert np.ptp(made.trajectory.joints[:, SLIDE]) > 0.05


def test_a_home_of_a_slide_is_in_meters() -> None:
    with pytest.raises(InputError, match="outside the limits of 'joint_3', in m") as caught:
        cellcolor.plan(scara_scene(MOTION.model_copy(update={"home_rad": (0.0, 0.5, 0.3, 0.0)})))
    assert caught.value.field == "motion.home_rad[2]"
