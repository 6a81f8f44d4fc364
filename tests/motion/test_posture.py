"""The posture that is preferred among divisions with as few segments."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from shipped import ROBOTS, shipped

import cellcolor
from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decomposition_of
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.scene import Scene
from cellcolor.frontend.setup import Setup
from cellcolor.motion.posture import with_best_posture
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

HOME = (-0.27, -1.02, 1.57, 1.02, 1.57, 0.0)  # over the plate, shoulder-left


def plate() -> Scene:
    """A plate before a UR5e that each of four colors covers alone."""
    setup = Setup.read(ROBOTS / "ur5e_polishing.toml")
    setup = setup.varied(motion={"home_rad": HOME}, file=setup.file)
    return (
        shipped("square", 150)
        .varied(
            object={"size_x_m": 0.2, "size_y_m": 0.2},
            placement={"position_m": (0.473, 0.0, 0.021), "rpy_rad": (0.0, 0.0, 0.0)},
            ground={"height_m": 0.0},
        )
        .with_setup(setup)
    )


@pytest.fixture(scope="module")
def built() -> BuildResult:
    found = cellcolor.build(plate())
    assert len(found.surface.colors) == 4
    assert all(len(own) == 4 for own in found.surface.vertex_colors)
    return found


def asked(built: BuildResult, home: object = HOME, **prefer: str) -> BuildResult:
    """The same build with another home position or preference in its setup."""
    setup = built.prepared.setup
    changed = setup.varied(motion={"home_rad": home}, prefer=prefer, file=setup.file)
    return replace(built, prepared=replace(built.prepared, scene=built.scene.with_setup(changed)))


def taken(built: BuildResult) -> tuple[str, Solution]:
    """The branch of the plate's segment, and the solution."""
    solution = cellcolor.solve(built).solution
    ((sub,),) = (cell.subcells for cell in solution.cells)
    assert solution.segments == 1 and solution.status == "optimal"
    return built.surface.colors[sub.color], solution


def test_the_color_around_home_is_taken_whichever_it_is(built: BuildResult) -> None:
    """No leaning backward: home where each color has the middle of the plate, and full turns on."""
    middle = int(np.linalg.norm(built.surface.vertices - [0.473, 0.0, 0.021], axis=1).argmin())
    for color, branch in enumerate(built.color_branch):
        home = built.configurations[middle, branch].copy()
        home[0] += 2 * np.pi * (-1 if home[0] > 0 else 1)
        name, solution = taken(asked(built, tuple(home.tolist())))
        assert name == built.surface.colors[color]
        assert solution.preference.posture == "near-home" and solution.preference.unproved is None
        assert "proved to be the best" in str(solution.preference)


def test_what_is_said_is_the_mean_over_joints_and_area(built: BuildResult) -> None:
    name, solution = taken(built)
    assert name.startswith("shoulder-left elbow-up")
    branch = built.branches.index(name)
    areas = built.surface.vertex_areas
    far = np.zeros(len(areas))
    for vertex, joint in product(range(len(areas)), range(6)):
        angle = built.configurations[vertex, branch, joint]
        far[vertex] += min(abs(angle + 2 * np.pi * k - HOME[joint]) for k in (-1, 0, 1)) / 6
    assert solution.preference.cost == pytest.approx((far * areas).sum() / areas.sum())
    assert solution.to_document()["preference"] == {
        "posture": "near-home",
        "cost": solution.preference.cost,
    }


def test_a_named_branch_comes_first_and_home_decides_among_those(built: BuildResult) -> None:
    name, solution = taken(asked(built, branch="shoulder-right"))
    assert name.startswith("shoulder-right") and solution.preference.outside == 0
    alone = {}
    for branch in built.branches:
        if branch.startswith("shoulder-right") and branch in built.surface.colors:
            own, found = taken(asked(built, branch=branch))
            assert own == branch
            alone[branch] = found.preference.cost
    assert name == min(alone, key=alone.get) and len(alone) == 2
    with pytest.raises(InputError, match="no branch that is in use has the words 'elbow-sideways'"):
        cellcolor.solve(asked(built, branch="elbow-sideways"))


@pytest.mark.parametrize("home", [None, "free"])
def test_without_a_position_as_home_the_arm_is_well_conditioned(
    built: BuildResult, home: str | None
) -> None:
    _, solution = taken(asked(built, home))
    assert solution.preference.posture == "well-conditioned"
    _, other = taken(asked(built, posture="well-conditioned"))
    assert other.preference == solution.preference
    with pytest.raises(InputError, match=r"needs a position as motion\.home_rad"):
        asked(built, home, posture="near-home")


def test_the_number_stays_and_no_time_for_a_proof_is_said() -> None:
    """The hemisphere's cheapest colors of cells do not fit together, so that needs the model."""
    built = cellcolor.build(shipped("hemisphere_flat", 400))
    decomposition = decomposition_of(built.surface)
    solution = solve(decomposition.instance, Options())
    whole = with_best_posture(built, decomposition, solution, Options())
    late = Options(deadline=Deadline.after(0.0))
    cut = with_best_posture(built, decomposition, solution, late)
    assert whole.segments == cut.segments == solution.segments
    assert whole.bounds == cut.bounds == solution.bounds
    assert whole.preference.unproved is None
    assert whole.preference.cost <= cut.preference.cost
    assert str(cut.preference).endswith("not proved to be the best: the time ended first")
