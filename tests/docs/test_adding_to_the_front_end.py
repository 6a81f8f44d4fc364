"""The guides that add to the front end, followed to the letter with a toy each."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from guides import followed
from shipped import TOP, shipped

from cellcolor.data.candidate_table import VALID, CandidateTable
from cellcolor.errors import InputError
from cellcolor.frontend import Scene, build_surface
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.reach.validity_tests import STANDARD_TESTS

pytestmark = pytest.mark.second

PARTS_AND_TESTS = "Parts, obstacles and validity tests"


def test_a_torus(tmp_path: Path) -> None:
    with followed("extend", PARTS_AND_TESTS, tmp_path) as names:
        result, scene = names["result"], names["scene"]
        vertices = result.surface.vertices - scene.placement.position_m
        from_ring = np.hypot(np.hypot(vertices[:, 0], vertices[:, 1]) - 0.12, vertices[:, 2])
        assert np.allclose(from_ring, 0.04)
        # 4 pi^2 R r, and less by the coarseness of the mesh.
        assert 0.94 < result.report.area_m2 / (4 * np.pi**2 * 0.12 * 0.04) < 1
        assert result.report.reachable > 100
        assert result.surface.meta["scene"]["object"]["kind"] == "torus"
        assert names["thicker"].object.tube_radius_m == 0.05
        with pytest.raises(InputError, match="greater") as caught:
            scene.varied(object={"tube_radius_m": -1.0})
        assert caught.value.field == "object.tube_radius_m"


def test_a_pyramid(tmp_path: Path) -> None:
    with followed("extend", PARTS_AND_TESTS, tmp_path) as names:
        result, free = names["result"], names["without_pyramid"]
        assert (result.reasons != free.reasons).any()
        lost = (free.reasons == VALID) & (result.reasons != VALID)
        reasons = {result.reason_names[code] for code in result.reasons[lost]}
        assert reasons == {"tip blocked", "obstacle collision"}
        # Inside of the pyramid no tip can be; in a section |x| + |y| is half its diagonal.
        x, y, z = result.surface.vertices.T
        inside = np.abs(x - 0.33) + np.abs(y - 0.1) < 0.06 * (0.4 - z) / 0.4
        assert inside.any() and not any(
            result.surface.vertex_colors[vertex] for vertex in np.flatnonzero(inside)
        )


def test_a_keep_out_zone(tmp_path: Path) -> None:
    with followed("extend", PARTS_AND_TESTS, tmp_path) as names:
        result, free, scene = names["result"], names["without_zone"], names["scene"]
        code = result.reason_names.index("keep-out zone")
        assert code == len(result.reason_names) - 1 == len(STANDARD_TESTS) + 2
        found = result.reasons == code
        assert (free.reasons[found] == VALID).all()
        assert (result.reasons[~found] == free.reasons[~found]).all()
        # By forward kinematics of each candidate: an end of a body's axis is in the zone.
        robot = prepare(scene).robot
        for candidates, expected in ((found, True), (result.reasons == VALID, False)):
            poses = forward(robot, result.configurations[candidates])
            ends = np.array(
                [
                    poses.origin[:, body.joint] + poses.rotation[:, body.joint] @ end
                    for body in robot.bodies
                    for end in (body.start, body.end)
                ]
            )
            inside = (np.abs(ends - [0.735, 0.0, 1.0]) <= [0.265, 1.0, 1.0]).all(axis=2)
            assert len(poses.tip) > 20 and (inside.any(axis=0) == expected).all()
        # The side file knows the new reason by its name.
        (tmp_path / "zone.npz").write_bytes(result.candidates.to_bytes())
        assert CandidateTable.read(tmp_path / "zone.npz") == result.candidates
        zone = scene.validity_test[0]
        twice = scene.varied(validity_test=(zone, zone.varied(highest_m=(0.5, 1.0, 2.0))))
        assert prepare(twice).judge.reason_names == result.reason_names


def test_an_arm_with_four_joints(tmp_path: Path) -> None:
    with followed("extend", "A family of arms", tmp_path) as names:
        result, scene = names["result"], names["scene"]
        assert result.branches == ("elbow-up", "elbow-down")
        assert result.configurations.shape == (len(result.surface.vertices), 2, 4)
        rows, branches = np.nonzero(result.reasons == VALID)
        assert len(rows) > 200
        poses = forward(prepare(scene).robot, result.configurations[rows, branches])
        assert np.allclose(poses.tip, result.surface.vertices[rows])
        assert np.allclose(poses.tool_axis, [0, 0, -1])
        # Elbow up: joint 3 above the line from joint 2 to joint 4.
        elbow = poses.origin[:, 3] - (poses.origin[:, 2] + poses.origin[:, 4]) / 2
        assert ((elbow[:, 2] > 0) == (branches == 0)).all()
        assert all(
            any(color.startswith(b) for b in result.branches) for color in result.surface.colors
        )


def test_an_own_arm_whose_solutions_have_no_names(tmp_path: Path) -> None:
    with followed("extend", "A family of arms", tmp_path) as names:
        named, scene = names["result"].report, names["scene"]
        sys.modules["pitch_arm"].PitchArm.branches = ()
        result = build_surface(scene)
        assert result.branches == ("sheet-1", "sheet-2")
        assert "none found on this part" in str(result.report)
        sizes = [sorted(c.vertices for c in each.colors) for each in (result.report, named)]
        assert sizes[0] == sizes[1] and len(sizes[0]) >= 2


def test_what_is_not_named_is_not_imported(tmp_path: Path) -> None:
    with followed("extend", PARTS_AND_TESTS, tmp_path, run=False):
        build_surface(shipped("wok", 50))
        assert "torus_part" not in sys.modules
        Scene.read("torus.toml")
        assert "torus_part" in sys.modules


def test_no_reason_has_two_meanings(tmp_path: Path) -> None:
    with followed("extend", PARTS_AND_TESTS, tmp_path) as names:
        zone = names["scene"].validity_test[0]
        type(zone).name = "torque"
        with pytest.raises(InputError, match="a reason 'torque' already") as caught:
            Scene.read("torus.toml")
        assert (caught.value.file, caught.value.field) == ("torus.toml", "validity_test[0]")


def test_a_missing_angle_of_the_locked_joint() -> None:
    scene = shipped("wok").varied(setup={"robot": {"locked_joint_6_rad": None}})
    with pytest.raises(InputError, match="is missing") as caught:
        build_surface(scene)
    assert caught.value.field == "robot.locked_joint_6_rad"


def test_the_page_lists_the_tests_in_their_order() -> None:
    page = (TOP / "docs" / "frontend.md").read_text()
    rows = re.findall(r"^\| ([a-z ]+) \| (.*) \|$", page[page.index("| reason | test |") :], re.M)
    names = [test.name for test in STANDARD_TESTS]
    assert [name for name, _ in rows][2 : len(names) + 2] == names
