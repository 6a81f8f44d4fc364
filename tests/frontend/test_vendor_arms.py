"""Scenes with an arm as vendors describe it: meshes, continuous joints, nothing known of forces."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from meshed_arm import with_collision, write_package
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.build import build_surface
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup

Varied = Callable[..., Scene]
NO_FORCE = {"force": False}


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


def test_a_tool_that_reaches_its_tip_is_warned_of(scene: Varied) -> None:
    text = (ROBOTS / "polishing_tool.urdf").read_text()
    origin = '<origin xyz="0 0 0.05"/>'
    long = with_collision(text, "tool_body", '<box size="0.02 0.02 0.1"/>', origin)
    found = build_surface(scene(setup={"tool_urdf": long}, target_vertices=100)).report
    assert any("touches the object wherever the tip does" in text for text in found.warnings)
