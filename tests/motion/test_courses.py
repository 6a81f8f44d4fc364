"""Courses beside a singularity: no joint goes far from one sample to the next."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from painted import square

from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import NEVER
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion import courses
from cellcolor.motion.courses import Course, laid_out
from cellcolor.motion.following import DISTANCE, Followed, Samples, even_places, sampled
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.registry import PATTERNS

pytestmark = pytest.mark.second

CORNERS = np.array([[-0.05, -0.01, 0.0], [0.05, -0.01, 0.0], [0.0, 0.05, 0.0]])
MOST = 0.5  # rad; docs/judging-trajectories.md: in contact, a longer step is a jump


def course(passed_within: float, monkeypatch: pytest.MonkeyPatch) -> Course:
    """Across a triangle, with a joint that turns by half a circle, most of it within a length."""

    class Judge:
        reason_names = ("valid", "no")

        def __call__(self, joints: np.ndarray, _deadline: Any) -> Any:
            return SimpleNamespace(reasons=np.zeros(len(joints)))

    def follow(_prepared: Any, samples: Samples, *_: Any) -> Followed:
        angle = np.arctan(samples.points[:, 0] / passed_within)[:, None]
        reasons = np.zeros(len(samples), dtype=np.uint8)
        return Followed(angle, reasons, np.zeros(len(samples) - 1, dtype=bool))

    monkeypatch.setattr(courses, "follow", follow)
    monkeypatch.setattr(courses, "off_way", lambda *_: False)
    monkeypatch.setattr(courses, "unwound", lambda joints, _: joints)
    monkeypatch.setattr(courses, "joint_space", lambda _: None)
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    ends = np.array([[-0.0301, 0.0, 0.0], [0.0302, 0.0, 0.0]])
    path = ToolPath(0, 0, ends, up[:2], np.array([0]))
    mesh = TriangleMesh(CORNERS, np.array([[0, 1, 2]]))
    laid: Any = SimpleNamespace(paths=SimpleNamespace(paths=(path,)), along_border=(None,))
    robot = SimpleNamespace(slides=np.zeros(1, dtype=bool))
    prepared: Any = SimpleNamespace(judge=Judge(), robot=robot)
    surface: Any = SimpleNamespace(mesh=mesh)
    refusals: Any = SimpleNamespace(add=lambda *_: None)
    _, (found,) = laid_out(prepared, surface, up, 0, lambda: laid, refusals, NEVER)
    return found


@pytest.mark.parametrize("passed_within", [0.1, 0.003, 0.0005, 0.0001])
def test_a_fast_joint_gets_samples_so_close_that_no_step_is_a_jump(
    passed_within: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = course(passed_within, monkeypatch)
    x, angles = found.samples.points[:, 0], found.followed.joints[:, 0]
    assert np.allclose(np.tan(angles) * passed_within, x)
    assert np.abs(np.diff(angles)).max() < MOST
    assert not found.followed.torn.any()
    assert x[0] == -0.0301 and x[-1] == 0.0302
    steps = np.diff(x)
    assert (steps > 0).all() and (steps <= DISTANCE).all()
    # Where the joint is slow, samples are as far apart as ever.
    assert np.median(steps) > 0.9 * DISTANCE
    assert (np.ptp(steps) < 1e-12) == (passed_within > DISTANCE)


@pytest.mark.parametrize("beyond", [0.0, 1e-6, 2e-5])
def test_no_even_sample_is_just_beside_one_that_is_asked_for(beyond: float) -> None:
    """A step of micrometers takes a millisecond, and so would look like a stop."""
    x = np.array([0.0, 0.0095 + beyond, 0.019])
    points = np.stack([x, 0 * x, 0 * x], axis=1)
    path = ToolPath(0, 0, points, np.tile([0.0, 0.0, 1.0], (3, 1)), np.zeros(2, dtype=np.int64))
    places = even_places(path, np.array([1]))
    samples = sampled(path, places)
    steps = np.diff(samples.points[:, 0])
    assert steps.min() > 0.9e-3 and steps.max() <= DISTANCE
    assert np.abs(samples.points[:, 0] - x[1]).min() < 1e-12
    assert samples.points[-1, 0] == pytest.approx(x[2])


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
        samples = sampled(path, even_places(path, corners))
        owners = mesh.corners[
            samples.faces, mesh.shares(samples.faces, samples.points).argmax(axis=1)
        ]
        steps = {(min(a, b), max(a, b)) for a, b in pairwise(owners.tolist()) if a != b}
        assert len(steps) > 20
        assert not steps & set(cracks)
