"""The six scenes as shipped, with one setup: the paper's lift-offs at two resolutions each."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from planners import largest_set_first
from shipped import SCENES, shipped
from vertex_minima import covers

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.scene import Scene
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.second

# Section VI of the paper; the square is not in it.
LIFT_OFFS = {
    "hemisphere_flat": 3,
    "hemisphere_tilted": 2,
    "half_pipe": 1,
    "wok": 1,
    "wok_obstacle": 2,
    "square": 0,
}


def built(name: str, vertices: int) -> BuildResult:
    return build_surface(shipped(name, vertices))


def wrist_above(robot: Robot, configurations: Array) -> list[bool]:
    """Whether the crossing of axes 5 and 6 is above the forearm's line, seen along axis 3."""
    data, above = robot.model.createData(), []
    for joints in configurations:
        pin.forwardKinematics(robot.model, data, joints)
        elbow, wrist, knuckle = (data.oMi[joint].translation for joint in (3, 4, 5))
        normal = np.cross(data.oMi[3].rotation[:, 2], wrist - elbow)  # the joints turn about z
        above.append(bool((knuckle - wrist) @ normal * normal[2] > 0))
    return above


def test_one_setup_for_all() -> None:
    scenes = {file.stem: Scene.read(file) for file in SCENES.glob("*.toml")}
    assert scenes.keys() == LIFT_OFFS.keys()
    assert len({scene.setup for scene in scenes.values()}) == 1


@pytest.mark.parametrize("name", LIFT_OFFS)
@pytest.mark.parametrize(
    "vertices", [500, *(pytest.param(fine, marks=pytest.mark.slow) for fine in (2000, 4000))]
)
def test_lift_offs(name: str, vertices: int) -> None:
    surface = built(name, vertices).surface
    solution = solve(decompose(surface), Options(deadline=Deadline.after(300), workers=2))
    assert solution.status == "optimal" and solution.proved_for_surface
    assert solution.lift_offs == LIFT_OFFS[name]


@pytest.mark.parametrize("name", LIFT_OFFS)
def test_files_as_built(name: str) -> None:
    """The stored instance is what the stored surface gives, and has the lift-offs as well."""
    instance = Instance.read(SCENES / f"{name}.json")
    surface = LabelledSurface.read(SCENES / f"{name}.surface.json")
    assert decompose(surface, f"{name}.surface.json").to_json() == instance.to_json()
    assert surface.meta["scene"] == Scene.read(SCENES / f"{name}.toml").model_dump(mode="json")
    assert len(surface.vertices) > 800
    solution = solve(instance, Options(deadline=Deadline.after(60), workers=2))
    assert solution.status == "optimal" and solution.lift_offs == LIFT_OFFS[name]


@pytest.mark.parametrize("name", LIFT_OFFS)
def test_stored_surface_is_what_the_scene_gives(name: str) -> None:
    stored = LabelledSurface.read(SCENES / f"{name}.surface.json")
    again = build_surface(SCENES / f"{name}.toml").surface
    assert (stored.colors, stored.vertex_colors, stored.cracks) == (
        again.colors,
        again.vertex_colors,
        again.cracks,
    )


def test_flat_hemisphere_is_not_fully_reachable_and_needs_four_colors() -> None:
    result = built("hemisphere_flat", 500)
    assert 0.88 < result.report.reachable_area_m2 / result.report.area_m2 < 0.92
    assert covers(result.surface, 4) and not covers(result.surface, 3)


def test_tilted_hemisphere_is_reachable_and_covered_by_three_colors() -> None:
    result = built("hemisphere_tilted", 500)
    report = result.report
    assert report.slivers is not None
    covered = report.reachable_area_m2 - report.slivers.given_up_area_m2
    assert covered >= 0.98 * report.area_m2
    assert covers(result.surface, 3) and not covers(result.surface, 2)


def test_trap_of_the_half_pipe() -> None:
    """The color of the largest area, by far, is in no pair that suffices, so greedy pays."""
    result = built("half_pipe", 500)
    area = {color.name: color.area_m2 / result.report.area_m2 for color in result.report.colors}
    trap, second, *_ = sorted(area, key=lambda name: area[name], reverse=True)
    assert trap == "shoulder-left elbow-up wrist-flipped"
    assert area[trap] > 0.8 and area[second] < 0.7
    pairs = covers(result.surface, 2)
    assert pairs and not any(trap in pair for pair in pairs)
    # Optima consist of such pairs, since no color suffices alone.
    assert not covers(result.surface, 1)
    judge = cellcolor.Oracle(result.surface, workers=1)
    assert judge.judge(largest_set_first(result.surface)).beatable_by >= 1


def test_two_colors_cover_the_square_alone() -> None:
    """Two more reach part of it, as in the paper; but here these have the same shoulder."""
    result = built("square", 500)
    assert covers(result.surface, 1) == [
        {"shoulder-left elbow-up wrist-unflipped"},
        {"shoulder-left elbow-up wrist-flipped"},
    ]
    area = result.report.area_m2
    partial = {color.name for color in result.report.colors if color.area_m2 < 0.95 * area}
    assert partial == {
        "shoulder-right elbow-up wrist-unflipped",
        "shoulder-right elbow-up wrist-flipped",
    }


def test_three_colors_over_the_wok_with_the_obstacle(robot: Robot) -> None:
    """Three are needed; cells of the first alone have the wrist below the forearm (caption f)."""
    result = build_surface(SCENES / "wok_obstacle.toml")
    surface = result.surface
    brown = "shoulder-left elbow-up wrist-unflipped"
    chosen = {
        brown,
        "shoulder-right elbow-up wrist-unflipped",
        "shoulder-right elbow-up wrist-flipped",
    }
    assert not covers(surface, 2) and covers(surface, 3) == [chosen]
    number, branch = surface.colors.index(brown), result.branches.index(brown)
    assert (number,) in surface.vertex_colors
    rows = np.flatnonzero(result.node_color[:, branch] == number)
    assert not any(wrist_above(robot, result.configurations[rows, branch]))
