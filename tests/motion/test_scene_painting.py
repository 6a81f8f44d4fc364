"""Paintings of scenes: what is drawn is asked of the robot, and what a configuration costs."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest
from painted import assert_whole, mean_cost, random_solution
from shipped import shipped

from cellcolor.arrays import unit
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.kinematics import forward, task_determinant
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.lab.families.surfaces import voronoi
from cellcolor.motion import scene_painting
from cellcolor.motion.following import normals_at
from cellcolor.motion.posture import color_costs
from cellcolor.motion.scene_painting import ScenePainting, paint_scene
from cellcolor.painting.paint import paint
from cellcolor.painting.refined import interpolated, unrefined
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from cellcolor.trajectory_checker.fine_mesh import refined


@pytest.fixture(scope="module")
def wok() -> BuildResult:
    """The wok before an obstacle, so small that what is divided has to be refined."""
    plain = shipped("wok_obstacle", 150)
    scene = plain.varied(setup=plain.setup.varied(slivers=None))
    return build_surface(scene)


def by_chance(wok: BuildResult, seed: int) -> ScenePainting:
    """A painting of a division that no solver made."""
    decomposition = decomposition_of(wok.surface)
    solution = random_solution(decomposition.instance, 2, random.Random(seed))
    return paint_scene(wok, decomposition, solution)


def reaches(prepared: PreparedScene, found: ScenePainting) -> bool:
    """Whether every painted vertex's color is valid there: from points and normals alone."""
    branch = np.array(found.built.coloring.branch)
    painted = found.painted
    own = [v for v, color in enumerate(painted.plan.vertex_colors) if color is not None]
    branches = branch[[painted.plan.vertex_colors[v] for v in own]]
    normals = unit(painted.interpolated(found.built.prepared.surface.normals))
    joints = prepared.arm.follow(painted.surface.vertices[own], -normals[own], branches)
    return bool((prepared.judge(joints).reasons == VALID).all())


@pytest.mark.parametrize("name", ["wok", "hemisphere_tilted"])
def test_a_solved_scene_is_painted_as_proved(name: str) -> None:
    scene = shipped(name, 400)
    built = build_surface(scene)
    decomposition = decomposition_of(built.surface)
    solution = solve(decomposition.instance, Options("surface"))
    told: list[str] = []
    found = paint_scene(built, decomposition, solution, progress=told.append)
    assert found.painted.segments == solution.segments == found.painted.minima[0]
    assert found.painted.minima == (solution.segments,) and found.painted.refused == ()
    assert_whole(built.surface, found.painted, solution)
    assert reaches(built.prepared, found)
    cost = color_costs(built.robot, built.verdicts)[:, np.array(built.color_branch)]
    drawn = paint(built.surface, decomposition, solution)
    assert mean_cost(found.painted, cost) < mean_cost(drawn, cost)
    assert told == ["painting", "moving borders"]


@pytest.mark.parametrize("seed", [1, 3])
def test_what_the_scene_refuses_is_solved_again(wok: BuildResult, seed: int) -> None:
    """Divisions drawn at random copy colors far beyond where they reach."""
    found = by_chance(wok, seed)
    assert len(found.painted.minima) > 1 and found.painted.refused == ()
    assert found.painted.minima[-1] == found.solution.segments == found.painted.segments
    assert len(found.built.surface.vertices) > len(wok.surface.vertices)
    assert_whole(found.built.surface, found.painted, found.solution)
    assert reaches(wok.prepared, found)
    # What the second proof is of: every color of the finer surface is asked of the robot.
    count = len(wok.surface.vertices)
    assert found.built.surface.vertex_colors[:count] == wok.surface.vertex_colors


def test_in_the_end_what_is_refused_is_told(
    wok: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With no second try: the vertices named are those that fail when asked once more."""
    monkeypatch.setattr(scene_painting, "_TIMES", 1)
    found = by_chance(wok, 0)
    assert found.painted.refused and not reaches(wok.prepared, found)
    kept = np.ones(len(found.painted.surface.vertices), dtype=bool)
    kept[list(found.painted.refused)] = False
    colors = [
        color if keep else None
        for color, keep in zip(found.painted.plan.vertex_colors, kept, strict=True)
    ]
    plan = replace(found.painted.plan, vertex_colors=tuple(colors))
    assert reaches(wok.prepared, replace(found, painted=replace(found.painted, plan=plan)))


def test_costs_by_hand(wok: BuildResult) -> None:
    """Each valid candidate by itself: every turn of every joint tried, and its determinant."""
    prepared, built = wok.prepared, wok
    candidates, robot = built.verdicts, prepared.robot
    cost = color_costs(robot, candidates)
    rows, branches = np.nonzero(candidates.valid)
    joints = candidates.configurations[rows, branches]
    poses = forward(robot, joints)
    determinants = task_determinant(poses, robot.task)
    for row, branch, q, determinant in zip(rows, branches, joints, determinants, strict=True):
        room = [
            max(
                min(angle + 2 * np.pi * turn - low, high - angle - 2 * np.pi * turn)
                for turn in range(-3, 4)
            )
            for angle, low, high in zip(q, robot.lower, robot.upper, strict=True)
        ]
        share = min(1.0, min(room) / (np.pi / 2), determinant / determinants.max())
        assert cost[row, branch] == pytest.approx(1 - share)
    assert (cost[~candidates.valid] == 1).all()


def test_what_is_left_alone_stays_so_on_a_finer_surface(wok: BuildResult) -> None:
    mask = wok.surface.vertices[:, 0] > np.median(wok.surface.vertices[:, 0])
    found = by_chance(wok.without(mask), 3)
    assert len(found.painted.minima) > 1
    alone = found.built.left_alone
    assert alone is not None and (alone[: len(mask)] == mask).all()
    assert len(alone) == len(found.built.surface.vertices) > len(mask)
    assert all(
        not own for own, out in zip(found.built.surface.vertex_colors, alone, strict=True) if out
    )
    # A new vertex lies on a mesh edge: beyond the border by half of one at most.
    beyond = found.built.surface.vertices[len(mask) :][~alone[len(mask) :], 0]
    assert (
        beyond.max()
        < np.median(wok.surface.vertices[:, 0])
        + wok.prepared.surface.lengths(wok.prepared.surface.mesh.edges).max()
    )


@pytest.mark.parametrize("seed", range(3))
def test_normals_between_vertices_are_those_that_the_judge_takes(seed: int) -> None:
    """On a surface whose triangles were halved, with normals that turn by up to half a circle."""
    rng = np.random.default_rng(seed)
    surface = voronoi(seed, "disc", size=9, regions=12, colors=3)
    finer = unrefined(surface)
    for _ in range(2):
        finer = finer.halved(rng.random(len(finer.mesh.points)) < 0.3)
    normals = unit(rng.normal(size=(len(surface.vertices), 3)))
    faces = rng.integers(0, len(finer.mesh.corners), 200)
    shares = rng.dirichlet(np.ones(3), 200)
    points = np.einsum("ki,kij->kj", shares, finer.mesh.points[finer.mesh.corners[faces]])
    between = interpolated(finer.between, normals)
    found = normals_at(finer.mesh, between, faces, points)
    fine = refined(Surface(surface.vertices, np.array(surface.faces), normals), 1e9, NEVER)
    facing = np.tile(surface.mesh.triangle_normals[0], (200, 1))
    assert found == pytest.approx(fine.locate(points, facing).normals, abs=1e-9)
