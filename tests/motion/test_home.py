"""The home position: refused before the long work, with what touches there and a free one."""

from __future__ import annotations

import re

import numpy as np
import pinocchio as pin
import pytest
from shipped import shipped

import cellcolor
from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.motion.limits import home_of, motion_of

HEIGHT = 0.44  # m; of a ground that the arm at home reaches into


def lowest(prepared: PreparedScene, joints: list[float]) -> dict[str, float]:
    """How low each link comes, m, by Pinocchio: the bodies of this arm are capsules."""
    model, found = prepared.robot.model, {}
    data = model.createData()
    pin.forwardKinematics(model, data, np.array(joints))
    for body in prepared.robot.bodies:
        ends = [data.oMi[body.joint].act(np.array(end)) for end in (body.start, body.end)]
        low = min(end[2] for end in ends) - body.radius
        found[body.link] = min(low, found.get(body.link, np.inf))
    return found


def refused(prepared: PreparedScene) -> tuple[str, list[float]]:
    """What a refusal says, and the position that it proposes."""
    with pytest.raises(InputError) as caught:
        home_of(prepared, motion_of(prepared))
    assert caught.value.field == "motion.home_rad"
    assert str(prepared.setup.file) in str(caught.value)
    (proposed,) = re.findall(r"free is, for example, \[(.*)\]", caught.value.message)
    return caught.value.message, [float(angle) for angle in proposed.split(",")]


def test_links_in_the_ground_are_named_and_the_position_proposed_is_above_it() -> None:
    scene = shipped("wok", 100).varied(ground={"height_m": HEIGHT})
    standing = ("base_link", "shoulder_link", "upper_arm_link")
    setup = scene.setup.varied(robot={"may_touch_ground": standing}, file=scene.setup.file)
    prepared = prepare(scene.with_setup(setup))
    exempt = prepared.setup.robot.may_touch_ground
    low = lowest(prepared, list(motion_of(prepared).home_rad))
    in_the_way = {link for link, z in low.items() if z < HEIGHT and link not in exempt}
    assert in_the_way == {"wrist_3_link", "tool_body"}  # forearm and the other wrists are higher
    said, proposed = refused(prepared)
    assert set(re.findall(r"(\w+) and the ground", said)) == in_the_way | {"tip"}
    clearance = motion_of(prepared).clearance_m
    for link, z in lowest(prepared, proposed).items():
        assert link in exempt or z >= HEIGHT + clearance - 1e-9


@pytest.mark.parametrize("far", [0.0, 0.0075])
def test_an_object_at_the_tool_is_named(far: float) -> None:
    """The dome is moved so that its crown is at the tip of the tool at home, or a little below.

    The tip counts as a ball of 5 mm, and 5 mm more are asked for: there it is near, and no more.
    """
    scene = shipped("wok", 100)
    prepared = prepare(scene)
    model = prepared.robot.model
    data = model.createData()
    pin.forwardKinematics(model, data, np.array(motion_of(prepared).home_rad))
    tip: Array = pin.updateFramePlacement(model, data, model.getFrameId("tool_tip")).translation
    radius = scene.object.radius_m
    moved = prepare(scene.moved(position_m=(tip - [0, 0, radius + far]).tolist()))
    assert motion_of(moved).clearance_m == moved.setup.task.contact_radius_m == 0.005
    said, proposed = refused(moved)
    assert "and the object" in said
    assert ("touch;" in said) == (far == 0)
    home_of(moved, motion_of(moved).varied(home_rad=proposed))  # passes its own advice


def test_it_is_refused_before_colors_are_computed() -> None:
    stages: list[str] = []
    scene = shipped("wok").varied(ground={"height_m": HEIGHT})
    with pytest.raises(InputError, match=r"motion\.home_rad"):
        cellcolor.plan(scene, progress=stages.append)
    assert stages == ["preparation"]
