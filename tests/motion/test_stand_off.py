"""A motion of a tilted tool that stays off the surface, and the judge on what it claims."""

import pytest
from turned_scenes import plate, setup

import cellcolor
from cellcolor.door.shipped import find_file
from cellcolor.frontend import Scene, build_surface
from cellcolor.trajectory_checker.check import check_trajectory

pytestmark = pytest.mark.second


def test_a_tilted_tool_off_the_surface_is_planned_and_its_distance_judged() -> None:
    motion = Scene.read(find_file("wok")).setup.motion
    task = {"stand_off_m": 0.05, "tilt_rad": 0.2, "normal_force_n": 0.0}
    given = setup({"along": (1.0, 0.0, 0.0)}).varied(task=task, motion=motion)
    part = {"size_x_m": 0.12, "size_y_m": 0.2}
    scene = plate(given).varied(object=part)
    planned = cellcolor.plan(scene, spacing_m=0.03)
    assert planned.verdict.valid
    for key, value, fault in (("stand_off_m", 0.055, "off surface"), ("tilt_rad", 0.3, "tilted")):
        built = build_surface(scene.varied(setup=given.varied(task={key: value})))
        kinds = {fault.kind for fault in check_trajectory(built, planned.trajectory).faults}
        assert fault in kinds
