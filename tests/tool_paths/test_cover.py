"""Tool paths on random paintings: held to an independent checker, whatever the pattern."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray
from painted import SHAPES, one_segment, painted_at_random, slit, square, whole
from path_checker import PathChecker

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.plan import Plan
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.mesh.dividing import small_areas
from cellcolor.tool_paths.cover import Covered, check_spacing, cover
from cellcolor.tool_paths.region import Segments, regions_of
from cellcolor.tool_paths.registry import PATTERNS
from examples import examples

pytestmark = pytest.mark.second


def covered(painting: Segments, pattern: str, spacing: float, **options: object) -> Covered:
    return cover(painting, pattern=pattern, spacing_m=spacing, tool_radius_m=spacing, **options)


@pytest.mark.parametrize("pattern", PATTERNS)
@given(st.integers(0, 10**6), st.sampled_from(SHAPES))
@examples(2)
def test_paths_stay_on_their_segments(pattern: str, seed: int, shape: str) -> None:
    assert_on_segments(pattern, seed, shape, 0.25)


@pytest.mark.slow
@pytest.mark.parametrize("pattern", PATTERNS)
@given(st.integers(0, 10**6), st.sampled_from(SHAPES), st.sampled_from([0.04, 0.1, 0.25]))
@example(2417, "torus", 0.04)  # a path's turning point on a straight border
@example(11, "annulus", 0.04)  # points of a line that are nearly one
@example(1, "disc", 0.25)  # two segments of a quarter of the spacing squared, to the last digit
@examples(20)
def test_many_paths_stay_on_their_segments(
    pattern: str, seed: int, shape: str, spacing: float
) -> None:
    assert_on_segments(pattern, seed, shape, spacing)


def assert_on_segments(pattern: str, seed: int, shape: str, spacing: float) -> None:
    """Paths on a random painting are one a segment, and the checker finds nothing."""
    painting = painted_at_random(seed, shape)
    found = covered(painting, pattern, spacing)
    checker = PathChecker(painting.surface, painting.segment_of)
    for path in found.paths.paths:
        assert not checker.problems(path)
        assert path.color == painting.colors[path.segment]
    # Every segment has one path, in one piece, unless it is smaller than the tool can see. On
    # grids some are exactly as large as that, where rounding decides.
    areas = np.zeros(len(painting.colors))
    corners = painting.segment_of[painting.surface.faces].ravel()
    thirds = np.repeat(small_areas(painting.surface.mesh)[::6] * 2, 3)
    np.add.at(areas, corners[corners >= 0], thirds[corners >= 0])
    segments = [path.segment for path in found.paths.paths]
    assert len(segments) == len(set(segments))
    least = spacing**2 / 4
    tied = set(np.flatnonzero(np.isclose(areas, least, rtol=1e-9)).tolist())
    assert set(segments) - tied == set(np.flatnonzero(areas > least).tolist()) - tied


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(
    "shape",
    ["disc", "annulus", "sphere", "double torus", pytest.param("torus", marks=pytest.mark.slow)],
)
def test_whole_shapes_are_covered_nearly_once(pattern: str, shape: str) -> None:
    painting = whole(shape, 12)
    # Some eleven passes across each of them.
    spacing = float(np.sqrt(painting.surface.vertex_areas.sum()) / 11)
    found = covered(painting, pattern, spacing)
    checker = PathChecker(painting.surface, painting.segment_of)
    (path,) = found.paths.paths
    assert not checker.problems(path)
    assert found.in_all.covered_wide >= 0.99 and found.in_all.covered >= 0.97
    assert found.in_all.mean_visits <= 1.3


class Discs:
    """Refuses what is in one of some discs on a plane, and is told of triangles with one inside."""

    names = ("", "in a disc")

    def __init__(self, middles: Array, radius: float, doubtful: set[int]) -> None:
        self.middles, self.radius, self.doubtful = middles, radius, doubtful

    def depths(self, points: Array) -> Array:
        """How far inside of a disc each point is; below 0 outside."""
        apart = np.linalg.norm(points[:, None, :2] - self.middles[None], axis=2)
        return self.radius - apart.min(axis=1, initial=np.inf)

    def __call__(self, points: Array, normals: Array) -> NDArray[np.uint8]:
        assert (normals == [0, 0, 1]).all()
        return (self.depths(points) >= 0).astype(np.uint8)

    def tested(self, point: Array, normal: Array) -> Array:
        assert self(point[None], normal[None]).all()
        return point


@given(st.integers(0, 10**6), st.sampled_from(sorted(PATTERNS)), st.data())
@examples(4)
def test_walls_and_what_is_refused_are_kept_off(
    seed: int, pattern: str, data: st.DataObject
) -> None:
    """However coarse the mesh is, hardly more is left out than what is refused."""
    painting, spacing = square(8), 0.1
    rng = np.random.default_rng(seed)
    edges = sorted({(min(a, b), max(a, b)) for a, b in painting.surface.left_of})
    walls = [edges[k] for k in rng.choice(len(edges), data.draw(st.integers(0, 25)))]
    middles = rng.uniform(0, 1, (data.draw(st.integers(0, 4)), 2))
    everywhere = set(range(len(painting.surface.faces)))
    refusals = Discs(middles, data.draw(st.floats(0.02, 0.3)), everywhere)
    found = covered(painting, pattern, spacing, walls=walls, refusals=refusals)
    checker = PathChecker(painting.surface, painting.segment_of, walls)
    finest = spacing / 4
    for path in found.paths.paths:
        assert not checker.problems(path)
        assert refusals.depths(path.points).max(initial=0) < finest / 2
    # What is left out is the discs and a rim of one small triangle, and states a place in one.
    out = [place for place in found.uncovered if place.reason == "in a disc"]
    left = sum(region.mesh.areas.sum() for region in regions_of(painting, walls))
    small = [place for place in found.uncovered if place.reason.startswith("a part smaller")]
    parts = found.in_all.area_m2 + sum(place.area_m2 for place in (*out, *small))
    assert parts == pytest.approx(left)
    if out:
        places = np.array([place.place for place in out])
        assert (refusals.depths(places) >= 0).all()
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 201)] * 2), axis=-1).reshape(-1, 2)
    near = (refusals.depths(grid) > -finest).mean()
    crumbs = 0.25 * spacing**2 * len(walls)
    assert sum(place.area_m2 for place in out) <= left * near + crumbs + 0.01


@pytest.mark.parametrize("key", ["spacing_m", "tool_radius_m"])
def test_lengths_in_millimeters(key: str) -> None:
    """On a square of 1 m: as wide as its diagonal is allowed, 15 mm given in meters are not."""
    painting = square(8)
    usual = {"spacing_m": 0.2, "tool_radius_m": 0.2}
    painted = painting.surface, Plan((0,) * len(painting.surface.vertices))
    cellcolor.cover(*painted, **usual | {key: 1.41})
    with pytest.raises(InputError, match=r"15 looks like millimeters: 0\.015 m\?") as caught:
        cellcolor.cover(*painted, **usual | {key: 15.0})
    assert caught.value.field == key


def test_a_small_segment_beside_a_large_one_is_no_fault_of_the_spacing() -> None:
    """It is listed as uncovered, and the large one has its path.

    A motion lays out segment by segment: there the small one is alone.
    """
    painting = square(16)
    segment_of = painting.segment_of.copy()
    segment_of[0] = 1  # a corner of the square
    both = painting._replace(segment_of=segment_of, colors=[0, 0])
    found = covered(both, "contour", 0.3)
    assert [path.segment for path in found.paths.paths] == [0]
    small = [place for place in found.uncovered if place.reason.startswith("a part smaller")]
    assert [place.segment for place in small] == [1]
    alone = both._replace(segment_of=np.where(segment_of == 1, 1, -1))
    assert covered(alone, "contour", 0.3).paths.paths == ()
    check_spacing(both.surface, segment_of, 1.41)
    with pytest.raises(InputError, match="larger than the largest segment"):
        check_spacing(both.surface, segment_of, 1.42)


def test_the_checker_finds_what_is_wrong() -> None:
    """A path moved off the surface, into another triangle, over a crack, out of its segment."""
    painting = square(8)
    checker = PathChecker(painting.surface, painting.segment_of)
    (path,) = covered(painting, "contour", 0.2).paths.paths
    assert not checker.problems(path)
    lifted = path.points.copy()
    lifted[5, 2] += 0.01
    assert "not in triangle" in checker.problems(replace(path, points=lifted))[0]
    faces = path.faces.copy()
    faces[7] = (faces[7] + 60) % len(painting.surface.faces)
    assert "not in triangle" in checker.problems(replace(path, faces=faces))[0]
    cut = square(8, slit(8, 3, range(2, 6)))
    assert "leaves" in PathChecker(cut.surface, cut.segment_of).problems(path)[0]
    walled = PathChecker(painting.surface, painting.segment_of, slit(8, 3, range(2, 6)))
    assert "leaves" in walled.problems(path)[0]
    other = painting.segment_of.copy()
    # A corner of the triangle that a step in the middle of the path lies in.
    other[painting.surface.faces[path.faces[len(path.faces) // 2]]] = 1
    assert "leaves" in PathChecker(painting.surface, other).problems(path)[0]


@pytest.mark.parametrize("width", [0.1, 0.11, 0.13])
def test_a_band_as_wide_as_the_spacing_is_walked_along(width: float) -> None:
    """A line along its middle covers 0.075 on each side; a loop would go over most of it twice."""
    points = np.array([[x, y, 0.0] for y in (0.0, width) for x in np.linspace(0, 1, 21)])
    for pattern in PATTERNS:
        found = covered(one_segment(points, grid_faces(2, 21)), pattern, 0.1)
        (path,) = found.paths.paths
        assert path.length < 1.3
        assert found.in_all.mean_visits < 1.1
        assert found.in_all.covered > 0.96  # the last corners are farther off


def test_a_path_along_a_border_stays_off_it() -> None:
    """In a band of a fifth of the spacing it partly runs along; it goes round vertices inside."""
    width = 0.02
    points = np.array([[x, y, 0.0] for y in (0.0, width) for x in np.linspace(0, 1, 41)])
    (path,) = covered(one_segment(points, grid_faces(2, 41)), "contour", 0.1).paths.paths
    inner = path.points[1:-1]
    assert path.length > 0.85
    assert np.minimum(inner[:, 1], width - inner[:, 1]).min() > 2e-6


def test_what_another_distribution_registers_is_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "one_line.py").write_text(
        "from cellcolor.tool_paths.registry import Laid\n"
        "def lay(mesh, spacing, deadline):\n"
        "    return Laid(mesh, mesh.corners[0, [0, 1]].tolist())\n"
    )
    info = tmp_path / "one_line-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: one-line\nVersion: 1\n")
    (info / "entry_points.txt").write_text(
        "[cellcolor.patterns]\none-line = one_line:lay\nbroken = one_line:nothing\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    painting = square(6)
    found = covered(painting, "one-line", 0.5)
    # What it leaves uncovered is reached by spurs.
    assert found.paths.pattern == "one-line" and found.in_all.covered_wide == 1.0
    with pytest.raises(InputError, match="'broken', registered as"):
        covered(painting, "broken", 0.5)


def test_the_deadline_and_progress() -> None:
    told: list[str] = []
    covered(square(6), "contour", 0.2, progress=told.append)
    assert told == ["covering part 1 of 1"]
    with pytest.raises(OutOfTime):
        covered(square(6), "contour", 0.2, deadline=Deadline.after(0.0))
