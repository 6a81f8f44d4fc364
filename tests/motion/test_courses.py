"""Courses beside a singularity: no joint goes far from one sample to the next."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from painted import square
from shipped import ROBOTS

from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import NEVER
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion import following
from cellcolor.motion import segment as module
from cellcolor.motion.following import (
    DISTANCE,
    Followed,
    Samples,
    bowed,
    even_places,
    normals_at,
    off_way,
    sampled,
)
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.registry import PATTERNS

pytestmark = pytest.mark.second

CORNERS = np.array([[-0.05, -0.01, 0.0], [0.05, -0.01, 0.0], [0.0, 0.05, 0.0]])
MOST = 0.5  # rad; docs/judging-trajectories.md: in contact, a longer step is a jump


def course(passed_within: float, monkeypatch: pytest.MonkeyPatch) -> tuple[Samples, Followed]:
    """Across a triangle, with a joint that turns by half a circle, most of it within a length."""

    class Judge:
        reason_names = ("valid", "no")

        def __call__(self, joints: np.ndarray, _deadline: Any) -> Any:
            return SimpleNamespace(reasons=np.zeros(len(joints)))

    def follow(_prepared: Any, samples: Samples, *_: Any, **__: Any) -> Followed:
        angle = np.arctan(samples.points[:, 0] / passed_within)[:, None]
        reasons = np.zeros(len(samples), dtype=np.uint8)
        return Followed(angle, reasons, np.zeros(len(samples) - 1, dtype=bool))

    monkeypatch.setattr(module, "follow", follow)
    monkeypatch.setattr(module, "bowed", lambda _robot, joints: np.zeros(len(joints) - 1, bool))
    monkeypatch.setattr(module, "off_way", lambda *_: False)
    monkeypatch.setattr(module, "unwound", lambda joints, _: joints)
    monkeypatch.setattr(module, "joint_space", lambda _: None)
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    ends = np.array([[-0.0301, 0.0, 0.0], [0.0302, 0.0, 0.0]])
    path = ToolPath(0, 0, ends, up[:2], np.array([0]))
    mesh = TriangleMesh(CORNERS, np.array([[0, 1, 2]]))
    robot = SimpleNamespace(slides=np.zeros(1, dtype=bool))
    segments = SimpleNamespace(surface=SimpleNamespace(mesh=mesh), normals=up)
    prepared = SimpleNamespace(judge=Judge(), robot=robot)
    ground: Any = SimpleNamespace(prepared=prepared, segments=segments, deadline=NEVER)
    return module.course(ground, path, even_places(path), 0)


@pytest.mark.parametrize("passed_within", [0.1, 0.003, 0.0005, 0.0001])
def test_a_fast_joint_gets_samples_so_close_that_no_step_is_a_jump(
    passed_within: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    samples, followed = course(passed_within, monkeypatch)
    x, angles = samples.points[:, 0], followed.joints[:, 0]
    assert np.allclose(np.tan(angles) * passed_within, x)
    assert np.abs(np.diff(angles)).max() < MOST
    assert not followed.torn.any()
    assert x[0] == -0.0301 and x[-1] == 0.0302
    steps = np.diff(x)
    assert (steps > 0).all() and (steps <= DISTANCE).all()
    # Where the joint is slow, samples are as far apart as ever.
    assert np.median(steps) > 0.9 * DISTANCE
    assert (np.ptp(steps) < 1e-12) == (passed_within > DISTANCE)


def test_steps_that_bow_off_their_way_are_told() -> None:
    """Of UR5 steps, small and large: the tip and the axis at places all along each of them."""
    robot = prepare_arm(Setup.read(ROBOTS / "ur5_polishing.toml")).robot
    rng = np.random.default_rng(5)
    start = rng.uniform(-2, 2, (400, robot.joints))
    size = 10 ** rng.uniform(-3, 0, (400, 1))
    end = start + size * rng.uniform(-1, 1, start.shape)
    told = np.array([bowed(robot, np.stack(pair))[0] for pair in zip(start, end, strict=True)])
    between = [forward(robot, start + share * (end - start)) for share in np.linspace(0, 1, 9)]
    tips, axes = (np.stack([getattr(at, name) for at in between]) for name in ("tip", "tool_axis"))
    way = np.linspace(0, 1, 9)[:, None, None]
    off = np.linalg.norm(tips - ((1 - way) * tips[0] + way * tips[-1]), axis=2).max(axis=0)
    straight = (1 - way) * axes[0] + way * axes[-1]
    straight /= np.linalg.norm(straight, axis=2, keepdims=True)
    tilt = np.degrees(np.arccos(np.clip((axes * straight).sum(axis=2), -1, 1))).max(axis=0)
    # What is let through stays well inside what the judge allows: a sample, and 1 degree.
    share = off / np.linalg.norm(tips[-1] - tips[0], axis=1)
    assert share[~told].max() < 0.4 and tilt[~told].max() < 0.75
    assert ((share > 0.25) | (tilt > 0.4))[told].all()
    assert 50 < told.sum() < 350


@pytest.mark.parametrize(("aside", "told"), [(0.0, False), (2e-5, False), (5e-5, True)])
def test_the_tool_is_compared_with_the_normal_where_its_tip_is(
    aside: float, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Across a sharp edge 6 mm wide, on which the normal turns by 90 degrees."""
    mesh = TriangleMesh(np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.006, 0]]), np.array([[0, 1, 2]]))
    normals = np.array([[0.0, -1, 1], [0.0, -1, 1], [0.0, 1, 1]]) / np.sqrt(2)
    middle = np.array([[0.02, 0.003, 0.0]])
    tip = middle + np.array([0.0, aside, 0.0])
    pose = SimpleNamespace(tip=tip, tool_axis=np.array([[0.0, 0.0, -1.0]]))
    monkeypatch.setattr(following, "forward", lambda *_: pose)
    robot: Any = SimpleNamespace(task=SimpleNamespace(direction=True))
    # 20 µm aside the normal is 0.4 degrees off, 50 µm aside 0.95; 0.6 may be.
    normals_of = partial(normals_at, mesh, normals, np.array([0]))
    assert off_way(robot, np.zeros((1, 6)), middle, normals_of).tolist() == [told]


@pytest.mark.parametrize("beyond", [0.0, 1e-6, 2e-5])
def test_no_even_sample_is_just_beside_one_that_is_asked_for(beyond: float) -> None:
    """A step of micrometers takes a millisecond, and so would look like a stop."""
    x = np.array([0.0, 0.0095 + beyond, 0.019])
    points = np.stack([x, 0 * x, 0 * x], axis=1)
    path = ToolPath(0, 0, points, np.tile([0.0, 0.0, 1.0], (3, 1)), np.zeros(2, dtype=np.int64))
    places = even_places(path, np.array([1]))
    samples, _ = sampled(path, places)
    steps = np.diff(samples[:, 0])
    assert steps.min() > 0.9e-3 and steps.max() <= DISTANCE
    assert np.abs(samples[:, 0] - x[1]).min() < 1e-12
    assert samples[-1, 0] == pytest.approx(x[2])


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("seed", [0, 2])
def test_samples_go_round_the_ends_of_cracks(pattern: str, seed: int) -> None:
    """Chords between samples as well: no two neighbors lie in the parts of a crack's two ends."""
    rng = np.random.default_rng(seed)
    whole = square(8)
    edges = sorted({(min(a, b), max(a, b)) for a, b in whole.surface.left_of})
    cracks = [edges[k] for k in rng.choice(len(edges), 12, replace=False)]
    painting = square(8, tuple(cracks))
    covered = cover(painting, pattern=pattern, spacing_m=0.05, tool_radius_m=0.05)
    mesh = painting.surface.mesh
    for path, corners in zip(covered.paths.paths, covered.along_border, strict=True):
        points, faces = sampled(path, even_places(path, corners))
        owners = mesh.corners[faces, mesh.shares(faces, points).argmax(axis=1)]
        steps = {(min(a, b), max(a, b)) for a, b in pairwise(owners.tolist()) if a != b}
        assert len(steps) > 20
        assert not steps & set(cracks)


def test_from_one_way_to_another_nothing_is_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The straight line there may pass a singularity, where steps are as small as can be: a drawn
    scene took minutes."""
    seen: list[Any] = []

    def follow_edges(_surface: Any, steps: np.ndarray, *_: Any) -> Any:
        seen.extend(steps.tolist())
        return SimpleNamespace(smooth=np.zeros(len(steps), dtype=bool))

    monkeypatch.setattr(following, "follow_edges", follow_edges)
    monkeypatch.setattr(following, "unwound", lambda joints, _: joints)
    monkeypatch.setattr(following, "joint_space", lambda _: None)
    arm = SimpleNamespace(follow=lambda points, *_: points, measure=None, probe=len)
    verdicts = SimpleNamespace(reasons=np.zeros(6, dtype=np.uint8), determinants=np.ones(6))
    prepared: Any = SimpleNamespace(arm=arm, judge=lambda *_: verdicts)
    samples = Samples(np.eye(6, 3), np.eye(6, 3), np.zeros(6, dtype=np.intp))
    found = following.follow(prepared, samples, 0, together=3)
    assert seen == [[0, 1], [1, 2], [3, 4], [4, 5]]
    assert found.torn.tolist() == [True, True, False, True, True]
