"""Colors and cracks: by hand, and by following the surface with Pinocchio's Jacobian."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from continuation import Follower
from reasons import Reason
from shipped import shipped

from cellcolor.arrays import Array
from cellcolor.configurations.matching import farthest
from cellcolor.data.surface import Crack
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.links import link
from cellcolor.frontend.parts.shapes import disc_mesh
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.reach.colors import Coloring, color_nodes
from cellcolor.frontend.reach.smooth import Measure
from cellcolor.frontend.reach.validity_tests import Verdicts
from cellcolor.frontend.setup import Continuity

pytestmark = pytest.mark.second

NEAR = 0.01  # m^3
POLICY = Continuity(
    base_step_rad=0.1,
    step_per_length_rad_per_m=1.0,
    near_singular_determinant_m3=NEAR,
    probe_spacing_m=0.05,
)


def measure(policy: Continuity = POLICY) -> Measure:
    return Measure(policy, NEAR, lever=0.2)


class Plane:
    """A flat disc of seven vertices whose configurations are given as functions of the place."""

    def __init__(self, *branches: Callable[[Array], Array], determinant: float = 1.0) -> None:
        flat, faces = disc_mesh(7, 0.0, 0)
        vertices = np.column_stack([flat, np.zeros(7)])
        self.surface = Surface(vertices, faces, np.tile([0.0, 0.0, 1.0], (7, 1)))
        self.edges = self.surface.mesh.edges
        self.branches, self.determinant = branches, determinant
        every = np.arange(len(branches))
        configurations = np.stack([self.joints(vertices, np.full(7, b)) for b in every], axis=1)
        self.candidates = Verdicts(
            configurations,
            np.where(np.isnan(configurations[:, :, 0]), Reason.NO_SOLUTION, Reason.VALID).astype(
                np.uint8
            ),
            np.full((7, len(branches)), determinant),
            np.empty((0, 7, len(branches), 3)),
            ("valid", "no solution"),
        )
        self.asked = 0

    def joints(self, points: Array, branch: Array) -> Array:
        first = np.array([self.branches[b](p) for p, b in zip(points, branch, strict=True)])
        return np.column_stack([first] + [np.where(np.isnan(first), np.nan, 0.0)] * 5)

    def probe(self, points: Array, _: Array, branch: Array) -> tuple[Array, Array]:
        self.asked += len(points)
        q = self.joints(points, branch)
        return q, np.where(np.isnan(q[:, 0]), np.nan, self.determinant)

    def colored(self, *names: str) -> Coloring:
        return color_nodes(self.candidates.valid, self.edges, self.linked(), names)

    def linked(self, policy: Continuity = POLICY) -> Array:
        return link(self.surface, self.edges, self.candidates, measure(policy), None, self.probe)


def test_missing_configuration_on_the_way_is_seen_near_singularities_only() -> None:
    def gap(p: Array) -> float:
        return np.nan if 0.38 < p[0] < 0.46 else 0.0

    assert Plane(gap).linked().all()
    near = Plane(gap, determinant=0.001)
    across = (near.surface.vertices[near.edges][:, :, 0] < 0.42).sum(axis=1) == 1
    assert (near.linked()[:, 0] == ~across).all()


def spiral(p: Array) -> float:
    """Once around the center the joint comes back a quarter of a circle off."""
    return float(np.arctan2(p[1], p[0])) / 4 if p @ p > 0.01 else np.nan


def test_holonomy_makes_a_crack_and_no_second_color() -> None:
    plane = Plane(spiral)
    coloring = plane.colored("turning")
    assert coloring.names == ("turning",)
    assert coloring.node_color[:, 0].tolist() == [-1, 0, 0, 0, 0, 0, 0]
    # arctan2 jumps between the vertices at 180 and at 240 degrees.
    assert coloring.cracks == (Crack(4, 5, (0,)),)


def test_names_and_numbers() -> None:
    plane = Plane(
        # Three vertices on the left, two apart from one another on the right.
        lambda p: np.nan if abs(p[0]) < 0.3 or p[0] > 0.9 else float(p[0] > 0),
        lambda _: np.nan,
        lambda p: 0.0 if abs(p[1]) < 0.1 else np.nan,
    )
    coloring = plane.colored("a", "b", "c")
    left = np.flatnonzero(plane.surface.vertices[:, 0] < -0.3)
    assert coloring.names == ("a 1", "a 2", "a 3", "c")
    assert coloring.branch == (0, 0, 0, 2)
    assert (coloring.node_color[left, 0] == 0).all()
    assert coloring.node_color[2, 0] == 1 and coloring.node_color[6, 0] == 2
    assert (coloring.node_color[:, 1] == -1).all()


@pytest.fixture(scope="module")
def around_wrist_singularities() -> BuildResult:
    """A small hemisphere beside the robot, with wrist singularities on it."""
    scene = shipped("wok").varied(
        object={"radius_m": 0.115, "half_angle_rad": np.pi / 2, "target_vertices": 500},
        ground={"height_m": -0.3},
    )
    return build_surface(
        scene.moved(position_m=(0.411, 0.156, 0.332), rpy_rad=(0.0, -1.342, -0.458))
    )


def test_what_is_linked_can_be_followed(
    robot: Robot, around_wrist_singularities: BuildResult
) -> None:
    """Differential kinematics knows no branches: it must end where the color says."""
    result = around_wrist_singularities
    surface, q = result.surface, result.configurations
    center = np.array([0.411, 0.156, 0.332])
    cracked = {(crack.i, crack.j, c) for crack in surface.cracks for c in crack.colors}
    pairs = np.sort(np.concatenate([surface.faces[:, [0, 1]], surface.faces[:, [1, 2]]]), axis=1)
    joined = [
        (i, j, branch)
        for i, j in np.unique(pairs, axis=0).tolist()
        for branch in range(8)
        if (shared := result.node_color[i, branch]) >= 0
        and shared == result.node_color[j, branch]
        and (i, j, shared) not in cracked
    ]
    steps = [farthest(q[i, b], q[j, b]) for i, j, b in joined]
    # The fastest ones, and some from everywhere.
    fastest = np.argsort(steps)[-12:].tolist()
    others = np.random.default_rng(2).choice(len(joined), 12, replace=False).tolist()
    follower = Follower(robot)
    for i, j, branch in (joined[row] for row in fastest + others):
        ends = [i, j]
        path = follower.along(q[i, branch], surface.vertices[ends], surface.vertices[ends] - center)
        assert path is not None
        assert farthest(path[-1], q[j, branch]) < 1e-6


def test_cracks_are_on_shared_colors_and_colors_are_injective(
    around_wrist_singularities: BuildResult,
) -> None:
    surface = around_wrist_singularities.surface
    assert surface.cracks
    for crack in surface.cracks:
        shared = set(surface.vertex_colors[crack.i]) & set(surface.vertex_colors[crack.j])
        assert set(crack.colors) <= shared
    per_vertex = np.sort(around_wrist_singularities.node_color, axis=1)
    assert not ((per_vertex[:, 1:] == per_vertex[:, :-1]) & (per_vertex[:, 1:] >= 0)).any()
