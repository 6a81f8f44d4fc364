"""Windings: a ring about the base, for an arm whose first joint turns by 200 degrees each way."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest
from motions import Planned, planned_scene, ring_scene

from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.following import follow, joint_space
from cellcolor.motion.refusing import ArmRefusals
from cellcolor.motion.samples import sampled
from cellcolor.motion.segment import _refuse_what_is_beyond
from cellcolor.motion.small_triangles import SmallTriangles, corner_states
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.windings import Parts, PartSteps, parts_of, walls_of
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.measures import in_all
from cellcolor.tool_paths.region import Segments

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def ring() -> Planned:
    """A motion over the ring."""
    return planned_scene(ring_scene(np.deg2rad(200)))


def test_a_path_without_walls_overruns_the_first_joint(ring: Planned) -> None:
    motion = ring.prepared.setup.motion
    assert motion is not None
    (color,) = {color for color in ring.painted.plan.vertex_colors if color is not None}
    covered = cover(
        Segments(
            replace(ring.painted.surface, cracks=()), ring.painted.segment_of, [color], ring.normals
        ),
        spacing_m=motion.spacing_m,
        tool_radius_m=motion.tool_radius_m,
    )
    (path,) = covered.paths.paths
    branch = ring.built.color_branch[color]
    followed = follow(ring.prepared, sampled(path), branch)
    assert followed.good
    assert not joint_space(ring.prepared).fits(followed.joints)
    turned = np.ptp(followed.joints, axis=0)
    assert turned[0] > np.deg2rad(400)
    assert (turned[1:] < np.pi).all()


def test_the_chosen_path_stays_in_the_limits_without_a_lift_off(ring: Planned) -> None:
    trajectory, robot = ring.plan.trajectory, ring.prepared.robot
    assert trajectory.lift_offs == ring.lift_offs == 0
    assert trajectory.extra_lift_offs == ()
    assert (trajectory.joints >= robot.lower).all()
    assert (trajectory.joints <= robot.upper).all()
    assert np.ptp(trajectory.joints[trajectory.contact][:, 0]) > 1.8 * np.pi  # nearly all round
    assert in_all(ring.plan.measures, ring.plan.paths.spacing_m).covered_wide > 0.99


def test_cracks_of_the_color_open_the_ring_and_do_not_part_it(ring: Planned) -> None:
    surface = ring.painted.surface
    graph = nx.Graph(edge for edge in surface.left_of)
    (color,) = {color for color in ring.painted.plan.vertex_colors if color is not None}
    assert ring.built.limits.winding and color in ring.built.limits.positions
    graph.remove_edges_from([(c.i, c.j) for c in surface.cracks if color in c.colors])
    assert nx.is_connected(graph)
    # The first joint follows the polar angle: no closed walk may go round the base any more.
    polar = np.arctan2(surface.vertices[:, 1], surface.vertices[:, 0])
    for cycle in nx.cycle_basis(graph):
        steps = np.diff(polar[[*cycle, cycle[0]]])
        assert np.abs((np.remainder(steps + np.pi, 2 * np.pi) - np.pi).sum()) < 1e-6


@pytest.mark.slow
def test_there_are_no_walls_where_the_limits_allow_the_path_as_it_is() -> None:
    ring = planned_scene(ring_scene(np.deg2rad(20 * 360)))
    assert ring.plan.walls == ()
    assert ring.plan.trajectory.lift_offs == 0
    assert np.ptp(ring.plan.trajectory.joints[:, 0]) > 2.2 * np.pi


def around_the_base(wide: float) -> tuple[Parts, TriangleMesh]:
    """The example of the module: a fan of four triangles about the base; rad of a part each way."""
    around = np.deg2rad([0.0, 90.0, 180.0, 270.0])
    places = np.column_stack([np.cos(around), np.sin(around), np.zeros(4)])
    fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    mesh = TriangleMesh(np.vstack([places, np.zeros(3)]), fan)
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    angles = np.deg2rad([[0.0], [90.0], [180.0], [-90.0]])
    steps = PartSteps(
        ends,
        np.array([[0], [0], [1], [0]]),
        np.array([np.flatnonzero(mesh.marked([tuple(sorted(end))]))[0] for end in ends.tolist()]),
        np.ones(4),
    )
    low, high, vertex, nowhere = angles - wide, angles + wide, np.arange(4), np.full(24, -1)
    return Parts(places, np.ones(4), low, high, steps, angles, vertex, nowhere), mesh


def turning_by(degrees: float) -> JointSpace:
    """One joint that turns so far each way."""
    limits = np.deg2rad([degrees])
    return JointSpace.of(np.zeros(1, dtype=bool), -limits, limits, 1.0)


@pytest.mark.parametrize(
    ("limit", "walls", "whole"),
    [
        (200, {(2, 3)}, True),  # from 180 degrees the joint would go on to 270
        (100, {(1, 2), (2, 3)}, False),  # 180 degrees is out of reach
    ],
)
def test_four_parts_around_the_base(limit: float, walls: set[tuple[int, int]], whole: bool) -> None:
    parts, mesh = around_the_base(np.deg2rad(10))
    found = walls_of(parts, mesh, turning_by(limit), NEVER)
    assert set(found.edges) == walls
    assert (found.whole, found.joint) == (whole, 0)


def test_parts_that_span_more_than_the_limits_are_joined_by_their_vertices() -> None:
    """180 ± 30 degrees do not fit into 200 each way, 180 do: one tree."""
    parts, mesh = around_the_base(np.deg2rad(30))
    space = turning_by(200)
    assert not walls_of(parts, mesh, space, NEVER).whole
    none = np.zeros(len(mesh.edges), dtype=bool)
    found = walls_of(parts.at_vertices(mesh, none, space), mesh, space, NEVER)
    assert found.whole and set(found.edges) == {(2, 3)}
    assert (parts.center + 2 * np.pi * found.turns).ravel() == pytest.approx(
        np.deg2rad([0, 90, 180, -90])
    )


def test_parts_without_a_step_are_joined_along_the_edge_between_their_vertices() -> None:
    """Without the steps to D the joint goes there from A, to -90 degrees; 270 is out of reach."""
    parts, mesh = around_the_base(0.0)
    none, space = np.zeros(len(mesh.edges), dtype=bool), turning_by(200)
    steps = parts.steps
    kept = PartSteps(steps.ends[:2], steps.turns[:2], steps.edge[:2], steps.lengths[:2])
    apart = replace(parts, steps=kept)
    joined = apart.at_vertices(mesh, none, space)
    assert {tuple(sorted(end)) for end in joined.steps.ends.tolist()} == {
        (0, 1), (1, 2), (2, 3), (0, 3),
    }  # fmt: skip
    found = walls_of(joined, mesh, space, NEVER)
    assert found.whole and set(found.edges) == {(2, 3)}
    closed = mesh.marked([(0, 3)])
    assert len(apart.at_vertices(mesh, closed, space).steps.ends) == 3


def test_the_few_samples_beyond_the_limits_are_kept_off() -> None:
    """A joint that turns to 201 degrees where 200 are allowed, in the last of 300 samples."""
    points = np.column_stack([np.arange(300.0), np.zeros(300), np.zeros(300)])
    turned = np.deg2rad(np.append(np.linspace(-199.0, 199.0, 299), 201.0))[:, None]
    stroke = Stroke(0, 0, points, points, turned)
    samples = SimpleNamespace(points=points, faces=np.arange(300))
    courses = SimpleNamespace(courses=[SimpleNamespace(samples=samples)])
    refused: list[tuple[int, list[float], str]] = []
    refusals = SimpleNamespace(add=lambda face, at, why: refused.append((face, at.tolist(), why)))
    arguments: Any = (courses, [stroke], turning_by(200), refusals)
    assert _refuse_what_is_beyond(*arguments)
    assert refused == [(299, [299.0, 0.0, 0.0], "joint limits")]
    # Where a tenth is beyond, that is no exception, and the stroke is cut.
    arguments = (courses, [stroke], turning_by(180), refusals)
    assert not _refuse_what_is_beyond(*arguments)


def test_points_where_the_first_joint_is_beyond_its_limits_are_refused(ring: Planned) -> None:
    """The first joint follows the polar angle, so what is beyond is counted from polar angles."""
    prepared, built = ring.prepared, ring.built
    (color,) = {color for color in ring.painted.plan.vertex_colors if color is not None}
    branch = built.color_branch[color]
    small = SmallTriangles.of(ring.painted.surface.mesh, ring.normals, ring.painted.segment_of)
    states = corner_states(prepared, small, np.array([branch]))
    parts = parts_of(small, states, 0, np.zeros(len(small.whole.edges), dtype=bool))
    rng = np.random.default_rng(3)
    turns = np.zeros(parts.center.shape, dtype=np.int64)
    turns[:, 0] = rng.integers(-1, 2, len(turns))
    own = ring.painted.segment_of == 0
    refusals = ArmRefusals(prepared, branch, small, states, 0, own, 0.004, NEVER)
    asked = rng.choice(np.flatnonzero(parts.part_of >= 0), 400)
    shares = rng.dirichlet([2.0, 2.0, 2.0], len(asked))
    points, normals = (
        np.einsum("ki,kij->kj", shares, of[small.corners[asked]])
        for of in (small.points, small.normals)
    )
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    before = refusals(points, normals)
    assert (before == 0).all()
    refusals.keep_inside(parts.part_of, turns)
    after = refusals(points, normals)

    def polar(of: np.ndarray) -> np.ndarray:
        return np.asarray(np.arctan2(of[:, 1], of[:, 0]))

    own = parts.part_of[asked]
    from_vertex = polar(points) - polar(parts.places[own])
    on = np.remainder(from_vertex + np.pi, 2 * np.pi) - np.pi
    first = parts.center[own, 0] + on + 2 * np.pi * turns[own, 0]
    clear = (
        np.abs(np.abs(first) - np.deg2rad(200)) > 0.05
    )  # the offset of the wrist varies a little
    assert np.array_equal((after > 0)[clear], (np.abs(first) > np.deg2rad(200))[clear])
    assert {refusals.names[code] for code in after[after > 0]} == {"joint limits"}
    out = int(np.flatnonzero(after)[0])
    assert np.array_equal(refusals.tested(points[out], normals[out]), points[out])
