"""Whole builds whose tool stays off the surface, and is tilted off its normal, by Pinocchio."""

import numpy as np
import pytest
from bent_tools import tip_frame
from hypothesis import given, settings
from hypothesis import strategies as st
from turned_scenes import SHIPPED, plate, setup

from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface

DOWN = np.array([0.0, 0.0, -1.0])
ANGLES = st.floats(-0.4, 0.4)


@pytest.mark.parametrize("kinematics", ["ur", "eaik"])
def test_the_tip_link_is_off_the_surface(kinematics: str) -> None:
    setup_ = setup(None).varied(robot={"kinematics": kinematics}, task={"stand_off_m": 0.07})
    result = build_surface(plate(setup_))
    valid = np.argwhere(result.reasons == VALID)
    assert len(valid) > 10
    for vertex, branch in valid[::9]:
        pose = tip_frame(result.robot.model, result.configurations[vertex, branch])
        above = result.surface.vertices[vertex] - 0.07 * DOWN
        assert np.abs(pose.translation - above).max() < 1e-8
        assert np.abs(pose.rotation[:, 2] - DOWN).max() < 1e-8


@settings(max_examples=4)
@given(off=st.floats(0.0, 0.1), tilt=ANGLES, lead=ANGLES)
def test_the_tool_is_tilted_about_the_axes_of_its_turn(
    off: float, tilt: float, lead: float
) -> None:
    task = {"stand_off_m": off, "tilt_rad": tilt, "lead_rad": lead}
    result = build_surface(plate(setup({"along": (1.0, 0.0, 0.0)}).varied(task=task)))
    # On the surface x is the world's, z points down, and so y is against the world's y.
    contact = np.diag([1.0, -1.0, -1.0])
    (cx, sx), (cy, sy) = ((np.cos(angle), np.sin(angle)) for angle in (tilt, lead))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    for vertex, branch in np.argwhere(result.reasons == VALID)[::9]:
        pose = tip_frame(result.robot.model, result.configurations[vertex, branch])
        assert np.abs(pose.rotation - contact @ about_y @ about_x).max() < 1e-8
        touched = pose.translation + off * pose.rotation[:, 2]
        assert np.abs(touched - result.surface.vertices[vertex]).max() < 1e-8


@pytest.mark.parametrize(
    ("task", "field", "says"),
    [
        ({"stand_off_m": -0.01}, "task.stand_off_m", "greater than or equal to 0"),
        ({"stand_off_m": 150.0}, "task.stand_off_m", "less than or equal to 10"),
        ({"stand_off_m": float("nan")}, "task.stand_off_m", "finite"),
        ({"tilt_rad": 15.0}, "task.tilt_rad", "degrees"),
        ({"lead_rad": 1.4}, "task.lead_rad", "1.2"),
        ({"lead_rad": 0.1}, "task", "task.turn"),
    ],
)
def test_what_is_no_stand_off_is_refused(task: dict[str, float], field: str, says: str) -> None:
    with pytest.raises(InputError) as refused:
        SHIPPED.varied(task=task)
    assert refused.value.field == field and says in refused.value.message
