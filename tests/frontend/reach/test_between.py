"""Validity between vertices: on a plane by hand, the spacing of points, and on scenes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin
import pytest
from reasons import Reason
from shipped import SCENES

from cellcolor.arrays import Array
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.contact.obstacle import CylinderObstacle
from cellcolor.frontend.contact.tip import longest_step
from cellcolor.frontend.links import (
    remains_valid,
)
from cellcolor.frontend.parts.shapes import disc_mesh
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene


def plane() -> Surface:
    flat, faces = disc_mesh(37, 0.0, 0)
    vertices = np.column_stack([flat, np.zeros(len(flat))])
    return Surface(vertices, faces, np.tile([0.0, 0.0, 1.0], (len(flat), 1)))


def checked(
    surface: Surface, test: Callable[[Array, Array, Array], Array], pieces: int, reach: float = 0.0
) -> Array:
    """Which edges remain valid, with one body whose end moves ``reach`` times as far as the tool.

    It may move by 10 mm.
    """
    edges = surface.mesh.edges
    branches = np.zeros(len(edges), dtype=np.intp)
    ends = reach * surface.vertices[None, :, None]

    def answer(points: Array, directions: Array, branch: Array) -> tuple[Array, Array]:
        return test(points, directions, branch), reach * points[None]

    cut = np.full(len(edges), pieces)
    return remains_valid(surface, edges, branches, cut, ends, np.array([0.01]), answer)


@pytest.mark.parametrize(("pieces", "reach"), [(40, 0.0), (1, 1.0)])
def test_a_gap_on_the_edge_is_found_and_nothing_else(pieces: int, reach: float) -> None:
    """Whether the tool or a body asks for points that are near enough."""
    surface = plane()

    def test(points: Array, directions: Array, branch: Array) -> Array:
        assert (directions == [0, 0, -1]).all() and len(branch) == len(points)
        return np.abs(points[:, 0] - 0.21) > 0.01  # a strip without a vertex

    found = checked(surface, test, pieces, reach)
    across = (surface.vertices[surface.mesh.edges][:, :, 0] < 0.21).sum(axis=1) == 1
    assert (found == ~across).all() and across.any()
    assert checked(surface, test, 1).all()  # nobody asks for a point


def test_a_jump_is_no_link() -> None:
    """A body that is in two places on both sides of a point is not followed forever."""
    surface = plane()
    edges = surface.mesh.edges
    branches = np.zeros(len(edges), dtype=np.intp)

    def test(points: Array, _: Array, __: Array) -> tuple[Array, Array]:
        return np.ones(len(points), dtype=bool), place(points)

    def place(points: Array) -> Array:
        return np.where(points[None, :, :1] > 0.21, 0.5, 0.0) * np.ones(3)

    ends = place(surface.vertices)[:, :, None]
    cut = np.ones(len(edges), dtype=int)
    found = remains_valid(surface, edges, branches, cut, ends, np.array([0.01]), test)
    across = (surface.vertices[edges][:, :, 0] > 0.21).sum(axis=1) == 1
    assert (found == ~across).all() and across.any()


@pytest.mark.parametrize("name", ["hemisphere_tilted", "square"])
def test_no_body_moves_far_between_tested_points(name: str) -> None:
    """On links of a scene, one at a time; the bodies put in place by Pinocchio."""
    prepared = prepare(SCENES / f"{name}.toml")
    surface, robot = prepared.surface, prepared.robot
    edges, random = surface.mesh.edges, np.random.default_rng(5)
    solutions = prepared.arm.inverse(surface.vertices, -surface.normals)
    found = prepared.judge(solutions.reshape(-1, 6))
    valid = (found.reasons == Reason.VALID).reshape(-1, 8)
    ends = found.tracked.reshape(-1, *valid.shape, 3)
    longest = prepared.judge.tracked_steps
    data = robot.model.createData()
    asked: list[Array] = []

    def test(points: Array, directions: Array, at: Array) -> tuple[Array, Array]:
        asked.append(np.column_stack([points, directions]))
        verdicts = prepared.judge(prepared.arm.follow(points, directions, of[at]))
        return verdicts.reasons == Reason.VALID, verdicts.tracked

    def axis_points(q: Array, share: Array) -> Array:
        pin.forwardKinematics(robot.model, data, q)
        return np.array(
            [
                data.oMi[body.joint].act(body.start + t * (body.end - body.start))
                for body, t in zip(robot.bodies, share, strict=True)
            ]
        )

    allowed = np.array([longest_step(body.radius) for body in robot.bodies])
    pairs = random.permutation(np.argwhere(valid[edges].all(axis=1)))[:100]
    tested, largest = 0, 0.0
    for row, branch in pairs:
        edge, of = edges[[row]], np.array([branch])
        asked.clear()
        one = np.ones(1, dtype=int)
        if not remains_valid(surface, edge, of, one, ends, longest, test)[0]:
            continue
        inner = np.concatenate([np.zeros((0, 6)), *asked])
        start, goal = (np.append(surface.vertices[v], -surface.normals[v]) for v in edge[0])
        order = np.argsort(np.linalg.norm(inner[:, :3] - start[:3], axis=1))
        way = np.array([start, *inner[order], goal])
        joints = prepared.arm.inverse(way[:, :3], way[:, 3:])[:, branch]
        for share in (np.zeros(len(robot.bodies)), random.uniform(0, 1, len(robot.bodies))):
            path = np.array([axis_points(q, share) for q in joints])
            moved = np.linalg.norm(np.diff(path, axis=0), axis=2)
            assert (moved <= allowed + 1e-9).all()
            largest = max(largest, float((moved / allowed).max()))
        tested += len(inner)
    assert tested > 100 and largest > 0.95


def test_asked_for_in_the_setup(scene: Callable[..., Scene]) -> None:
    """A narrow post cuts links whose two ends it does not touch."""
    post = CylinderObstacle(radius_m=0.004, height_m=0.3, position_m=(0.3, 0.02, 0.15))
    wok = scene(target_vertices=200).with_obstacle(post)
    asked = build_surface(wok)
    trusting = build_surface(wok.varied(setup={"continuity": {"validity_spacing_m": None}}))
    assert (asked.reasons == trusting.reasons).all()

    def torn(result: BuildResult) -> set[tuple[int, int, str]]:
        names = result.surface.colors
        return {(c.i, c.j, names[k]) for c in result.surface.cracks for k in c.colors}

    assert len(torn(asked)) > len(torn(trusting)) or len(asked.surface.colors) > len(
        trusting.surface.colors
    )
