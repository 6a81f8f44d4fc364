"""A spiral leads from loop to loop without a door where loops lie in each other."""

from __future__ import annotations

import numpy as np
import pytest
from painted import Painting, one_segment, square

from cellcolor.arrays import Array
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.tool_paths.cover import Covered, cover
from cellcolor.tool_paths.joined_loops import Loop
from cellcolor.tool_paths.spiral import _direction
from cellcolor.tool_paths.triangles import Triangles

SPACING = 0.05


def covered(painting: Painting, pattern: str) -> Covered:
    return cover(*painting, pattern=pattern, spacing_m=SPACING, tool_radius_m=SPACING)


def turning(points: Array, way: float) -> Array:
    """By how much a path turns within a way before and after each of its places, rad."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    grid = np.arange(2 * way, along[-1] - 2 * way, way / 10)
    at = [
        np.stack([np.interp(grid + k * way, along, axis) for axis in points.T], axis=1)
        for k in (-2, -1, 1, 2)
    ]
    before, after = at[1] - at[0], at[3] - at[2]
    cosine = (before * after).sum(axis=1)
    return np.asarray(
        np.arccos(
            np.clip(
                cosine / np.linalg.norm(before, axis=1) / np.linalg.norm(after, axis=1), -1.0, 1.0
            )
        )
    )


def test_no_place_of_a_square_is_turned_back_at() -> None:
    """The square turns by 90 degrees at its corners; at a door a path goes back beside itself."""
    painting = square(21)
    spiral, doors = (covered(painting, pattern) for pattern in ("spiral", "contour"))
    (spiral_path,), (door_path,) = spiral.paths.paths, doors.paths.paths
    back = np.radians(150)
    middle = np.linalg.norm(spiral_path.points - spiral_path.points.mean(axis=0), axis=1)
    outside = spiral_path.points[: int(np.flatnonzero(middle > 2 * SPACING)[-1])]
    assert turning(outside, 0.8 * SPACING).max() < back
    assert (turning(door_path.points, 0.8 * SPACING) > back).sum() > 20
    assert spiral_path.length < 1.04 * door_path.length
    assert spiral.in_all.covered > 0.995 and spiral.in_all.mean_visits < 1.06
    # It ends in the middle.
    assert np.linalg.norm(spiral_path.points[-1] - spiral_path.points[0]) > 0.3


def test_two_lobes_are_a_spiral_and_loops_behind_a_door() -> None:
    """Two squares that a band joins: loops of both lie in the first, and a chain enters one."""
    x, y = (rows.ravel() for rows in np.meshgrid(np.linspace(0, 2, 41), np.linspace(0, 1, 21)))
    points = np.stack([x, y, np.zeros_like(x)], axis=1)
    faces = np.array(grid_faces(21, 41))
    inside = (np.abs(x - 1) > 0.1) | (np.abs(y - 0.5) < 0.16)
    faces = faces[inside[faces].all(axis=1)]
    used, faces = np.unique(faces, return_inverse=True)
    lobes = one_segment(points[used], faces.reshape(-1, 3))
    found = covered(lobes, "spiral")
    (path,) = found.paths.paths
    assert found.in_all.covered > 0.985 and found.in_all.mean_visits < 1.1
    sharp = (turning(path.points, 0.8 * SPACING) > np.radians(150)).sum()
    (door_path,) = covered(lobes, "contour").paths.paths
    assert 0 < sharp < 0.8 * (turning(door_path.points, 0.8 * SPACING) > np.radians(150)).sum()
    assert np.linalg.norm(path.points[-1] - path.points[0]) > 3 * SPACING


@pytest.mark.parametrize("spacing", [0.05, 0.07, 0.1])
def test_short_inner_loops_do_not_end_the_spiral(spacing: float) -> None:
    """Of an L, whose innermost loop is half a spacing long at 0.07."""
    x, y = (rows.ravel() for rows in np.meshgrid(*[np.linspace(0, 1, 21)] * 2))
    points = np.stack([x, y, np.zeros_like(x)], axis=1)
    faces = np.array(grid_faces(21, 21))
    inside = (x < 0.51) | (y < 0.51)
    used, faces = np.unique(faces[inside[faces].all(axis=1)], return_inverse=True)
    painting = one_segment(points[used], faces.reshape(-1, 3))
    paths = [
        cover(*painting, pattern=pattern, spacing_m=spacing, tool_radius_m=spacing).paths.paths[0]
        for pattern in ("spiral", "contour")
    ]
    assert np.linalg.norm(paths[0].points[-1] - paths[0].points[0]) > spacing / 2
    assert paths[0].length < 1.15 * paths[1].length


@pytest.mark.parametrize("spacing", [0.2, 0.27])
def test_a_core_shorter_than_two_spacings_is_led_into(spacing: float) -> None:
    (path,) = cover(
        *square(21), pattern="spiral", spacing_m=spacing, tool_radius_m=spacing
    ).paths.paths
    assert np.linalg.norm(path.points[-1] - path.points[0]) > spacing / 2


@pytest.mark.parametrize("gaps_round", [1.3, 1.6, 1.9, 10.0])
def test_where_a_loop_leads(gaps_round: float) -> None:
    """Round a fan of triangles, forward: to +y at the place on the x axis."""
    angles = 2 * np.pi * np.arange(36) / 36
    ring = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    points = np.vstack([ring, np.zeros((1, 3))]) / (2 * np.pi)  # one meter round
    corners = np.array([[k, (k + 1) % 36, 36] for k in range(36)])
    mesh = Triangles(points, corners, np.tile([0.0, 0.0, 1.0], (37, 1)), np.arange(36))
    found = _direction(mesh, Loop(mesh, np.arange(36)), 0, 1.0 / gaps_round)
    assert found[1] > 0.9 * np.linalg.norm(found)


def test_two_loops_are_walked_the_same_way_round() -> None:
    """The inner one is shorter than two spacings. Turning back would take another half of one."""
    options = {"spacing_m": 0.33, "tool_radius_m": 0.33}
    spiral, doors = (
        cover(*square(21), pattern=pattern, **options).paths.paths[0].length
        for pattern in ("spiral", "contour")
    )
    assert spiral < doors
