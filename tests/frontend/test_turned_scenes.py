"""Whole builds with the turn of the tool given: by a rule, and as a finite set."""

from __future__ import annotations

import arm_plates
import dh_arms
import numpy as np
import pytest
from bent_tools import tip_frame
from turned_scenes import SHIPPED, plate, setup
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import Setup, build_surface
from cellcolor.frontend.build import TURN_NOT_DEFINED
from cellcolor.frontend.prepared import prepare

DOWN = np.array([0.0, 0.0, -1.0])
LIMITS = (-0.4, 0.0)  # rad, of joint 6: so narrow that no turn alone reaches the whole plate


@pytest.mark.second
@pytest.mark.parametrize("tool", ["", "bent", "across"])
@pytest.mark.parametrize("kinematics", ["ur", "eaik"])
def test_the_tool_has_the_turn_that_the_rule_gives(tool: str, kinematics: str) -> None:
    """On the axis of joint 6, beside it and across it, by Pinocchio."""
    goal = np.array([0.5, 0.1, 0.4])
    given = setup({"towards_m": tuple(goal)}, tool=tool).varied(robot={"kinematics": kinematics})
    result = build_surface(plate(given))
    valid = np.argwhere(result.reasons == VALID)
    assert len(valid) > 30
    for vertex, branch in valid[::7]:
        pose = tip_frame(result.robot.model, result.configurations[vertex, branch])
        point = result.surface.vertices[vertex]
        assert np.abs(pose.translation - point).max() < 1e-9
        assert np.abs(pose.rotation[:, 2] - DOWN).max() < 1e-9
        flat = (goal - point) * [1, 1, 0]
        assert np.abs(pose.rotation[:, 0] - flat / np.linalg.norm(flat)).max() < 1e-8


def test_a_vertex_where_the_rule_says_nothing_has_a_reason_of_its_own() -> None:
    whole = build_surface(plate(setup({"along": (1.0, 0.0, 0.0)})))
    x, y, z = whole.surface.vertices[17].tolist()
    # Above one vertex: of all others the way there has a part across the tool.
    result = build_surface(plate(setup({"towards_m": (x, y, z + 0.3)})))
    code = result.reason_names.index(TURN_NOT_DEFINED)
    assert (result.reasons[17] == code).all()
    assert (result.reasons[:17] != code).all() and (result.reasons[18:] != code).all()
    assert np.isnan(result.configurations[17]).all()
    assert result.report.unreachable[TURN_NOT_DEFINED] == 1
    # Along the normal everywhere: nothing is reachable, and all of it for this reason.
    never = build_surface(plate(setup({"along": (0.0, 0.0, 2.0)})))
    assert never.report.unreachable == {
        name: (40 if name == TURN_NOT_DEFINED else 0) for name in never.reason_names[1:]
    }


def test_scenes_with_a_free_turn_know_nothing_of_it() -> None:
    result = build_surface(plate(setup(None)))
    assert TURN_NOT_DEFINED not in result.reason_names
    assert "turn" not in result.surface.meta["setup"]["task"]
    assert SHIPPED.model_dump(mode="json")["task"].keys() == {
        "normal_force_n",
        "contact_radius_m",
        "gravity_m_per_s2",
    }


def test_no_edge_through_a_place_without_a_turn_is_linked() -> None:
    """Over it the tool would have to turn by half a circle at once."""
    free = prepare(plate(setup(None)))
    edges = free.surface.mesh.edges
    inner = int(np.argmin(np.abs(free.surface.vertices[edges].mean(axis=1)[:, 1])))
    i, j = edges[inner].tolist()
    x, y, _ = free.surface.vertices[[i, j]].mean(axis=0).tolist()
    through = build_surface(plate(setup({"towards_m": (x, y, 0.3)})))
    linked = through.coloring.linked
    both = (through.reasons[i] == VALID) & (through.reasons[j] == VALID)
    assert both.any() and not linked[inner].any()
    # Beside it by 20 mm the same edge is smooth, though fast.
    across = np.array([-(free.surface.vertices[j] - free.surface.vertices[i])[1], 0])
    across[1] = (free.surface.vertices[j] - free.surface.vertices[i])[0]
    x, y = (np.array([x, y]) + 0.02 * across / np.linalg.norm(across)).tolist()
    beside = build_surface(plate(setup({"towards_m": (x, y, 0.3)})))
    assert beside.coloring.linked[inner].any()


def test_solutions_without_names_have_the_turn_too() -> None:
    """Told apart by continuity; a set of turns needs names."""
    scene = arm_plates.plate(dh_arms.urdf("passing"), "eaik", 60)
    rule = {"along": (0.6, 0.8, 0.0)}
    given = scene.setup.varied(task={"turn": rule}, robot={"locked_joint_6_rad": None})
    x, y, z = scene.covered().placed(scene.placement).vertices[11].tolist()
    result = build_surface(scene.with_setup(given))
    valid = np.argwhere(result.reasons == VALID)
    assert len(valid) > 30
    for vertex, branch in valid[::5]:
        pose = tip_frame(result.robot.model, result.configurations[vertex, branch])
        assert np.abs(pose.translation - result.surface.vertices[vertex]).max() < 1e-9
        assert np.abs(pose.rotation[:, [0, 2]].T - [[0.6, 0.8, 0], DOWN]).max() < 1e-8
    above = given.varied(task={"turn": {"along": None, "towards_m": (x, y, z + 1.0)}})
    result = build_surface(scene.with_setup(above))
    code = result.reason_names.index(TURN_NOT_DEFINED)
    assert np.flatnonzero((result.reasons == code).any(axis=1)).tolist() == [11]
    several = given.varied(task={"turn": rule | {"turns": 2}})
    with pytest.raises(InputError, match="no names") as caught:
        build_surface(scene.with_setup(several))
    assert caught.value.field == "task.turn"


def test_a_set_of_turns_has_the_colors_of_each_turn_and_its_minimum_is_exact() -> None:
    """Against a build for each turn alone, and a search through all colorings of the vertices."""
    degrees = (30.0, 50.0, 70.0, 90.0)
    several = build_surface(
        plate(setup({"along": (1.0, 0.0, 0.0), "turns_deg": degrees}, limits=LIMITS))
    )
    expected: list[set[str]] = [set() for _ in several.surface.vertices]
    for number, turn in enumerate(degrees):
        alone = build_surface(
            plate(setup({"along": (1.0, 0.0, 0.0), "turns_deg": (turn,)}, limits=LIMITS))
        )
        own = slice(8 * number, 8 * number + 8)
        assert several.branches[own] == alone.branches
        assert all(name.startswith(f"turn {turn:g}° ") for name in alone.branches)
        assert np.array_equal(several.reasons[:, own], alone.reasons)
        same = np.array_equal(several.configurations[:, own], alone.configurations, equal_nan=True)
        assert same
        for names, colors in zip(expected, alone.surface.vertex_colors, strict=True):
            names |= {alone.surface.colors[color] for color in colors}
        assert alone.report.reachable < several.report.reachable
    for names, colors in zip(expected, several.surface.vertex_colors, strict=True):
        assert {several.surface.colors[color] for color in colors} == names
    solved = cellcolor.solve(several)
    assert solved.segments == vertex_minimum(several.surface) > 1


@pytest.mark.parametrize(
    ("turn", "message"),
    [
        ({}, "give either along or towards_m"),
        ({"along": (1, 0, 0), "towards_m": (0, 0, 0)}, "give either along or towards_m"),
        ({"along": (0, 0, 0)}, "must have a direction"),
        ({"along": (1, 0, 0), "turns": 2, "turns_deg": (0.0,)}, "give either turns or turns_deg"),
        ({"along": (1, 0, 0), "turns_deg": (10.0, -350.0)}, "a turn twice"),
        ({"along": (1, 0, 0), "turns_deg": (180.0, 0.0, -180.0)}, "a turn twice"),
    ],
)
def test_faulty_turns_are_refused(turn: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        setup(turn)
    assert caught.value.field == "task.turn"


@pytest.mark.parametrize(("key", "value"), [("turns", 0), ("turns", 361), ("turns_deg", ())])
def test_too_few_and_too_many_turns_are_refused(key: str, value: object) -> None:
    with pytest.raises(InputError) as caught:
        setup({"along": (1, 0, 0), key: value})
    assert caught.value.field == f"task.turn.{key}"


def refused(given: Setup, vertices: int = 20) -> InputError:
    with pytest.raises(InputError) as caught:
        build_surface(plate(given, vertices))
    assert "\n" not in str(caught.value)
    return caught.value


def test_a_free_turn_beside_the_last_axis_is_redundant() -> None:
    for kinematics in ("ur", "eaik"):
        error = refused(setup(None, tool="bent").varied(robot={"kinematics": kinematics}))
        assert error.field == "joint[wrist_3_joint]"
        assert "redundant" in error.message and "[task.turn]" in error.message


def test_a_locked_joint_and_a_given_turn_are_refused_together() -> None:
    error = refused(setup({"along": (1, 0, 0)}).varied(robot={"locked_joint_6_rad": 0.0}))
    assert error.field == "robot.locked_joint_6_rad" and "task.turn" in error.message


def test_more_turns_than_fit_are_refused() -> None:
    error = refused(setup({"along": (1, 0, 0), "turns": 360}), 800)
    assert error.field == "task.turn" and "360 turns" in error.message
