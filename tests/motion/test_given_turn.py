"""A planned motion of a tool that may have two turns: each contact has one of them."""

from __future__ import annotations

import numpy as np
import pytest
from bent_tools import tip_frame
from shipped import TOP
from turned_scenes import plate, setup

import cellcolor
from cellcolor.errors import InputError
from cellcolor.frontend import Scene
from cellcolor.frontend.prepared import prepare
from cellcolor.motion.limits import motion_of


@pytest.mark.second
def test_a_motion_with_two_turns_is_valid_and_lifts_off_to_change_them() -> None:
    """Joint 6 has so little room that no turn will do for the whole plate."""
    goal = np.array([0.3, 0.0, 0.5])
    rule = {"towards_m": tuple(goal), "turns_deg": (0.0, 90.0)}
    scene = plate(setup(rule, limits=(-1.2, 0.2)), 150)
    motion = cellcolor.plan(scene.varied(object={"size_x_m": 0.12, "size_y_m": 0.4}))
    trajectory, surface = motion.trajectory, motion.built.surface
    assert trajectory.lift_offs == motion.solution.lift_offs >= 1
    assert motion.verdict.valid, motion.verdict.faults
    numbers = []
    for first, after in trajectory.strokes:
        turns = set()
        for sample in range(first, after, 40):
            pose = tip_frame(motion.built.robot.model, trajectory.joints[sample])
            x, y, z = pose.rotation.T
            assert np.abs(z - [0, 0, -1]).max() < 1e-6
            flat = (goal - pose.translation) * [1, 1, 0]
            flat /= np.linalg.norm(flat)
            # Turned by 0 or by 90 degrees about z: the way to the point is along x, or against y.
            turns |= {0} if x @ flat > 1 - 1e-6 else {90} if -y @ flat > 1 - 1e-6 else {None}
        numbers.append(turns)
    assert set().union(*numbers) == {0, 90}
    assert all(len(turns) == 1 for turns in numbers)
    assert {name.split("°")[0] for name in surface.colors} == {"turn 0", "turn 90"}


def test_motions_of_a_planar_arm_are_refused() -> None:
    """It cannot retract: what would have to move stands still."""
    scene = Scene.read(TOP / "instances" / "planar" / "kr6_r700_z200_plate.toml")
    with pytest.raises(InputError, match="does not lift its tool off") as caught:
        motion_of(prepare(scene.varied(object={"target_vertices": 20})))
    assert caught.value.field == "robot.kinematics" and "\n" not in str(caught.value)
