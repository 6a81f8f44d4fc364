"""Which way the rows of ``back-and-forth`` run, measured along the paths."""

from __future__ import annotations

import numpy as np
import pytest
from painted import one_segment

from cellcolor.arrays import Array
from cellcolor.data.tool_paths import ToolPath
from cellcolor.errors import InputError
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.region import Segments
from cellcolor.tool_paths.registry import find_pattern

SPACING = 0.1


def sheet(width: float, height: float) -> Segments:
    """A rectangle along x and y."""
    x, y = np.linspace(0, width, 13), np.linspace(0, height, 13)
    points = np.array([[a, b, 0.0] for b in y for a in x])
    return one_segment(points, grid_faces(13, 13))


def pipe() -> Segments:
    """A third of a pipe around the x axis."""
    turns, along = np.linspace(0, 2, 13), np.linspace(0, 1, 13)
    points = np.array([[x, 0.5 * np.cos(t), 0.5 * np.sin(t)] for x in along for t in turns])
    return one_segment(points, grid_faces(13, 13))


def path_of(painting: Segments, pattern: str) -> ToolPath:
    found = cover(painting, pattern=pattern, spacing_m=SPACING, tool_radius_m=SPACING)
    (path,) = found.paths.paths
    assert found.in_all.covered_wide > 0.99
    return path


def share_along(path: ToolPath, directions: Array) -> float:
    """The share of the length that runs within 15 degrees of a direction at each step (k, 3)."""
    steps = np.diff(path.points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    along = np.abs(np.sum(steps * directions, axis=1)) >= np.cos(np.radians(15)) * lengths
    return float(lengths[along].sum() / lengths.sum())


@pytest.mark.parametrize("degrees", [0, 30, 90])
def test_rows_run_along_the_vector(degrees: float) -> None:
    """On a sheet that is narrow along x, where rows along y would be the fewest."""
    turn = np.radians(degrees)
    vector = np.array([np.cos(turn), np.sin(turn), 0.0])
    name = f"back-and-forth:{vector[0]},{vector[1]},0.5"  # what is across the sheet does not matter
    path = path_of(sheet(0.8, 1.2), name)
    assert share_along(path, vector) > 0.7
    if degrees == 0:
        assert share_along(path_of(sheet(0.8, 1.2), "back-and-forth"), vector) < 0.25


@pytest.mark.parametrize("around", [True, False])
def test_rows_run_around_an_axis_or_along_it(around: bool) -> None:
    path = path_of(pipe(), "back-and-forth:around:1,0,0" if around else "back-and-forth:1,0,0")
    middles = (path.points[1:] + path.points[:-1]) / 2
    circles = np.cross([1.0, 0.0, 0.0], middles)
    circles /= np.linalg.norm(circles, axis=1, keepdims=True)
    wanted = circles if around else np.tile([1.0, 0.0, 0.0], (len(middles), 1))
    assert share_along(path, wanted) > 0.75


def turns(path: ToolPath) -> int:
    """Where the path turns by more than 45 degrees within two spacings."""
    steps = np.diff(path.points, axis=0)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=1))])
    at = np.arange(0.0, way[-1] - 2 * SPACING, SPACING / 4)

    def heading(where: Array) -> Array:
        ends = [
            np.column_stack([np.interp(w, way, column) for column in path.points.T])
            for w in (where, where + SPACING / 2)
        ]
        found = ends[1] - ends[0]
        return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))

    cosines = np.sum(heading(at) * heading(at + 1.5 * SPACING), axis=1)
    turned = cosines < np.cos(np.radians(45))
    return int(turned[0]) + int((turned[1:] & ~turned[:-1]).sum())


def test_the_fewest_turns_are_no_more_than_those_of_any_other_direction() -> None:
    """On a slanted parallelogram, whose long sides are at 35 degrees."""
    slant = np.radians(35)
    grid = np.array([[a, b] for b in np.linspace(0, 0.55, 13) for a in np.linspace(0, 1.3, 13)])
    points = np.column_stack([grid[:, 0] * np.cos(slant), grid[:, 0] * np.sin(slant) + grid[:, 1]])
    painting = one_segment(np.column_stack([points, np.zeros(len(points))]), grid_faces(13, 13))
    fewest = turns(path_of(painting, "back-and-forth:fewest-turns"))
    assert fewest <= turns(path_of(painting, "back-and-forth")) / 2
    for degrees in (35, 120):
        angle = np.radians(degrees)
        name = f"back-and-forth:{np.cos(angle):.6f},{np.sin(angle):.6f},0"
        assert fewest <= turns(path_of(painting, name))


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("back-and-forth:1,0", "not '1,0'"),
        ("back-and-forth:around:0,0,0", "not 'around:0,0,0'"),
        ("back-and-forth:across", "not 'across'"),
        ("contour:1,0,0", "contour has no rows"),
    ],
)
def test_what_is_no_direction_is_refused(name: str, fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        find_pattern(name)
