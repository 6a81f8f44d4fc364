"""A motion of a tilted tool that stays off the surface, and the judge on what it claims."""

import numpy as np
import pytest
from turned_scenes import plate, setup

import cellcolor
from cellcolor.door.installed import find_file
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


def test_a_tool_that_stands_off_goes_straight_on_before_and_after_its_stroke() -> None:
    """So it passes the ends of the stroke at full feed; a tool that touches has no such way."""
    motion = Scene.read(find_file("wok")).setup.motion
    task = {"stand_off_m": 0.05, "normal_force_n": 0.0}
    given = setup({"along": (1.0, 0.0, 0.0)}).varied(task=task, motion=motion)
    scene = plate(given).varied(object={"size_x_m": 0.12, "size_y_m": 0.2})
    keys = {"spacing_m": 0.03, "pattern": "back-and-forth:0,1,0", "speed_m_per_s": 0.1}
    plain, led = (cellcolor.plan(scene, lead_m=lead, **keys) for lead in (0.0, 0.04))
    for planned, moving in ((plain, False), (led, True)):
        assert planned.verdict.valid, planned.verdict.faults
        trajectory = planned.trajectory
        ((first, after),) = trajectory.strokes
        speeds = np.linalg.norm(np.diff(trajectory.points, axis=0), axis=1)
        speeds /= np.diff(trajectory.times)
        for step in (first, after - 2):
            assert bool(speeds[step] > 0.09) is moving
        if moving:
            # The leads are straight on, at the height of the surface, by 40 mm.
            for inner, outer in ((first, slice(0, first)), (after - 1, slice(after, None))):
                way = trajectory.points[outer] - trajectory.points[inner]
                flat = np.abs(way[:, 2]) < 1e-6
                assert np.linalg.norm(way[flat], axis=1).max() == pytest.approx(0.04, abs=0.002)
    with pytest.raises(cellcolor.InputError, match=r"motion\.lead_m"):
        cellcolor.plan("wok", lead_m=0.01)
