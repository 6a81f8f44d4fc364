"""Whole builds with arms of other families than UR."""

from __future__ import annotations

import dh_arms
import numpy as np
import pytest
from arm_plates import plate

from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.inverse import KINEMATICS
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.signs import BRANCHES


@pytest.mark.parametrize("name", ["kr6", "irb120"])
def test_an_arm_with_a_spherical_wrist(name: str) -> None:
    result = build_surface(plate(dh_arms.urdf(name), "eaik"))
    assert result.branches == BRANCHES
    rows, columns = np.nonzero(result.reasons == VALID)
    assert len(rows) > 300
    poses = forward(result.robot, result.configurations[rows, columns])
    assert np.abs(poses.tip - result.surface.vertices[rows]).max() < 1e-9
    assert np.abs(poses.tool_axis - [0, 0, -1]).max() < 1e-9
    # Along no mesh edge a name is torn: what a branch reaches is all its colors' own.
    assert result.surface.cracks == ()
    for branch, name in enumerate(BRANCHES):
        own = [c.vertices for c in result.report.colors if c.branch == name]
        assert sum(own) == (result.reasons[:, branch] == VALID).sum()
        assert len(own) <= 2


def test_an_arm_with_seven_joints_is_refused_with_the_way_out() -> None:
    placements = [np.eye(4), *dh_arms.steps_of(dh_arms.ARMS["kr6"])]
    seven = dh_arms.urdf_of([*placements[:3], *placements[2:]])
    with pytest.raises(InputError, match="redundant") as caught:
        build_surface(plate(seven, "eaik"))
    assert caught.value.field == "robot" and "\n" not in str(caught.value)
    assert "has 7;" in caught.value.message and "fixed_joints" in caught.value.message


@pytest.mark.parametrize("turn", [None, {"along": (1.0, 0.0, 0.0)}])
def test_a_family_with_seven_joints_is_redundant_for_every_task(
    turn: dict[str, object] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody's own: whatever its solver returns, there are endlessly many more."""

    class Seven(EaikKinematics):
        joints = 7

    monkeypatch.setattr(KINEMATICS, "find", lambda *_: Seven)
    placements = [np.eye(4), *dh_arms.steps_of(dh_arms.ARMS["kr6"])]
    scene = plate(dh_arms.urdf_of([*placements[:3], *placements[2:]]), "seven")
    locked = 0.0 if turn is None else None
    setup = scene.setup.varied(task={"turn": turn}, robot={"locked_joint_6_rad": locked})
    with pytest.raises(InputError, match="redundant: 7 joints, at most 6") as caught:
        build_surface(scene.with_setup(setup))
    assert caught.value.field == "robot.kinematics" and "fixed_joints" in caught.value.message


def test_a_given_turn_takes_six_joints(monkeypatch: pytest.MonkeyPatch) -> None:
    class Five(EaikKinematics):
        joints = 5

    monkeypatch.setattr(KINEMATICS, "find", lambda *_: Five)
    five = dh_arms.urdf_of([np.eye(4), *dh_arms.steps_of(dh_arms.ARMS["kr6"])[1:]])
    scene = plate(five, "five")
    rule = {"turn": {"along": (1.0, 0.0, 0.0)}}
    setup = scene.setup.varied(task=rule, robot={"locked_joint_6_rad": None})
    with pytest.raises(InputError, match="6 dimensions") as caught:
        build_surface(scene.with_setup(setup))
    assert caught.value.field == "task.turn" and "have 5 joints" in caught.value.message
