"""Scenes with an arm as vendors describe it: meshes, continuous joints, nothing known of forces."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from meshed_arm import with_collision, write_package
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.arm.body import Shapes
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.reach.always_touching import check_capsules
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

TOOL = ROBOTS / "polishing_tool.urdf"
Varied = Callable[..., Scene]
NO_FORCE = {"force": False}
MARGINS = {"to_object_m": 0.003, "to_obstacles_m": 0.01, "to_ground_m": 0.01,
           "between_links_m": 0.004}  # fmt: skip


def meshed(scene: Varied, folder: Path, **setup: object) -> BuildResult:
    """The wok under the UR5 with meshes, which stand in a package in the folder."""
    package = folder / "toy_description"
    if not package.exists():
        write_package(folder, "toy_description")
    wok = scene(target_vertices=100)
    robot = {"arm_urdf": str(package / "urdf" / "arm.urdf")} | setup.pop("robot", {})  # type: ignore[operator]
    return build_surface(wok.with_setup(wok.setup.varied(robot=robot, **setup)))


@pytest.mark.slow
def test_a_hull_and_margins_only_take_away(scene: Varied, tmp_path: Path) -> None:
    exact = meshed(scene, tmp_path, robot={"mesh_collision": "exact"})
    hull = meshed(scene, tmp_path)
    with_margins = meshed(scene, tmp_path, margins=MARGINS)
    valid = [result.reasons == 0 for result in (exact, hull, with_margins)]
    assert valid[0].sum() > valid[1].sum() > valid[2].sum() > 0
    assert not (valid[1] & ~valid[0]).any() and not (valid[2] & ~valid[1]).any()
    lines = str(hull.report).splitlines()
    found = [line for line in lines if line.startswith("collides  ")]
    assert len(found) == 7
    assert any("'forearm_link': convex hull of forearm_link.stl, contains it" in x for x in found)
    assert "overlap" not in str(hull.report)
    assert {s.chosen for s in exact.report.stand_ins} == {"exact"}


def test_one_link_can_be_chosen_for_itself(tmp_path: Path) -> None:
    arm = str(write_package(tmp_path, "toy_description") / "urdf" / "arm.urdf")
    setup = Setup.read(ROBOTS / "ur5_polishing.toml").varied(robot={"arm_urdf": arm})
    one = setup.varied(robot={"mesh_collision_of": {"forearm_link": "exact"}})
    found = {each.link: each.chosen for each in prepare_arm(one).robot.stand_ins}
    assert found.pop("forearm_link") == "exact" and set(found.values()) == {"hull"}
    with pytest.raises(InputError, match="no such link") as caught:
        prepare_arm(setup.varied(robot={"mesh_collision_of": {"tool_body": "exact"}}))
    assert caught.value.field == "robot.mesh_collision_of.tool_body"


def test_continuous_joints_reach_what_wide_limits_do(scene: Varied) -> None:
    """With limits of a turn both ways none binds in the wok, so nothing else may change."""

    def continuous(text: str) -> str:
        return re.sub(r'type="revolute"', 'type="continuous"', re.sub("<limit [^>]*/>", "", text))

    keys = {"target_vertices": 300}
    endless = build_surface(scene(setup=NO_FORCE, arm=continuous, **keys))
    limited = build_surface(scene(setup=NO_FORCE, **keys))
    assert (endless.reasons == limited.reasons).all()
    assert endless.surface.colors == limited.surface.colors
    assert endless.surface.vertex_colors == limited.surface.vertex_colors
    assert endless.surface.cracks == limited.surface.cracks
    reached = ~np.isnan(endless.configurations)
    assert np.abs(endless.configurations[reached]).max() <= np.pi + 1e-12


def test_without_forces_the_scene_is_refused_until_that_is_said(scene: Varied) -> None:
    def no_effort(text: str) -> str:
        return text.replace('effort="150"', 'effort="0"')

    with pytest.raises(InputError, match=r"force = false under \[constraints\]"):
        build_surface(scene(arm=no_effort, target_vertices=100))
    found = build_surface(scene(setup=NO_FORCE, arm=no_effort, target_vertices=100))
    assert found.report.reachable > 0


def test_links_that_always_overlap_are_named_and_may_touch(scene: Varied) -> None:
    def fat(text: str) -> str:
        return with_collision(text, "wrist_3_link", '<box size="0.2 0.2 0.2"/>')

    may_touch = {"may_touch": [("wrist_1_link", "wrist_3_link")]}
    nothing = build_surface(scene(arm=fat, target_vertices=100)).report
    (warning,) = [text for text in nothing.warnings if "overlap" in text]
    assert "'wrist_1_link' and 'wrist_3_link' overlap in all" in warning
    assert nothing.reachable == 0
    allowed = build_surface(scene(setup=may_touch, arm=fat, target_vertices=100)).report
    assert not [text for text in allowed.warnings if "overlap" in text]
    assert allowed.candidates["self collision"] < nothing.candidates["self collision"]
    with pytest.raises(InputError, match="no link 'wrist_9_link'") as caught:
        build_surface(scene(setup={"may_touch": [("wrist_9_link", "wrist_1_link")]}))
    assert caught.value.field == "robot.may_touch[0]"


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.1, 0.05])
def test_capsules_that_leave_nothing_free_are_refused(
    scene: Varied, tmp_path: Path, radius: float
) -> None:
    """Balls as meshes about the frames of wrists 1 and 3, whose distance no joint changes."""
    apart = np.hypot(0.09465, 0.0823)  # wrist 1 to 2 and 2 to 3 are at right angles
    ball = tmp_path / "ball.stl"
    trimesh.creation.icosphere(subdivisions=3, radius=radius).export(ball)

    def with_balls(text: str) -> str:
        for link in ("wrist_1_link", "wrist_3_link"):
            text = with_collision(text, link, f'<mesh filename="{ball}"/>')
        return text

    keys = {"arm": with_balls, "target_vertices": 100}
    if 2 * radius < apart:
        assert build_surface(scene(setup={"mesh_collision": "capsules"}, **keys)).report.candidates
        return
    with pytest.raises(
        InputError, match=r"'wrist_1_link' and 'wrist_3_link'.* 0 are free.*exact"
    ) as caught:
        build_surface(scene(setup={"mesh_collision": "capsules"}, **keys))
    assert caught.value.field == "robot.mesh_collision"
    said = re.search(r"by ([0-9.]+) to ([0-9.]+) mm", caught.value.message)
    assert said is not None
    balls = 1e3 * (2 * radius - apart)
    assert [float(each) for each in said.groups()] == pytest.approx([balls, balls], abs=1)
    build_surface(scene(setup={"mesh_collision": "hull"}, **keys))


@pytest.mark.slow
def test_capsules_that_leave_hardly_anything_free_are_warned_of(tmp_path: Path) -> None:
    """Balls about the base and wrist 1, which meet unless the arm is stretched upwards."""
    text = (ROBOTS / "ur5.urdf").read_text()
    for link, radius in (("base_link", 0.75), ("wrist_1_link", 0.13)):
        ball = tmp_path / f"{link}.stl"
        trimesh.creation.icosphere(subdivisions=3, radius=radius).export(ball)
        text = with_collision(text, link, f'<mesh filename="{ball}"/>')
    (tmp_path / "arm.urdf").write_text(text)
    links = re.findall(r'<link name="(\w+)"', text + (ROBOTS / "polishing_tool.urdf").read_text())
    plain = load_robot(tmp_path / "arm.urdf", "wrist_3_link", TOOL, "tool_tip")
    shaped = {body.link for body in plain.bodies}
    others = tuple(
        (ball, link)
        for ball in ("base_link", "wrist_1_link")
        for link in links
        if link in shaped and {ball, link} != {"base_link", "wrist_1_link"}
    )
    robot = load_robot(
        tmp_path / "arm.urdf", "wrist_3_link", TOOL, "tool_tip",
        shapes=Shapes("capsules"), may_touch=others,
    )  # fmt: skip
    upwards = (0.0, -np.pi / 2, 0.0, 0.0, 0.0, 0.0)  # 0.91 m apart
    warning = check_capsules(robot, upwards)
    assert warning is not None
    assert "'base_link' and 'wrist_1_link' overlap in" in warning
    free = re.search(r"and ([0-9]+) are free", warning)
    assert free is not None
    assert 1 <= int(free.group(1)) <= 10
    assert check_capsules(replace(robot, stand_ins=())) is None


def test_a_tool_that_reaches_its_tip_is_warned_of(scene: Varied) -> None:
    text = (ROBOTS / "polishing_tool.urdf").read_text()
    origin = '<origin xyz="0 0 0.05"/>'
    long = with_collision(text, "tool_body", '<box size="0.02 0.02 0.1"/>', origin)
    found = build_surface(scene(setup={"tool_urdf": long}, target_vertices=100)).report
    assert any("touches the object wherever the tip does" in text for text in found.warnings)
