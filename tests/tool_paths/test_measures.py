"""Measures of paths of which they are known: straight lines, circles, repetitions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from painted import flat_grid, slit, square

from cellcolor.tool_paths.measures import measure
from cellcolor.tool_paths.region import regions_of
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.rounding import line_of
from cellcolor.tool_paths.triangles import Triangles


def lines(rows: range, columns: int) -> list[int]:
    """To and fro along some rows of a grid, from one to the next along its sides."""
    walk: list[int] = []
    for number, row in enumerate(rows):
        line = range(row * columns, (row + 1) * columns)
        if walk:
            side = walk[-1] % columns
            walk += [between * columns + side for between in range(rows[number - 1] + 1, row)]
        walk += list(line)[:: -1 if number % 2 else 1]
    return walk


def test_parallel_lines_pass_once() -> None:
    # 1 m wide, 41 rows: lines at 0.05 m, 0.15 m, … with a spacing of 0.1 m.
    laid = Laid(flat_grid(41, 161, 0.025), lines(range(2, 40, 4), 161))
    found, left = measure(line_of(laid), 0, 0.1)
    assert found.area_m2 == pytest.approx(4.0) and found.border_m == pytest.approx(10.0)
    assert found.length_m == pytest.approx(10 * 4.0 + 9 * 0.1)
    assert found.covered == found.covered_wide == 1.0 and not left
    # Off the sides, where it turns, every point is within half a spacing of one line.
    assert 1.0 <= found.mean_visits < 1.03


def test_one_line_covers_a_strip() -> None:
    laid = Laid(flat_grid(41, 161, 0.025), lines(range(20, 21), 161))
    found, left = measure(line_of(laid), 0, 0.1)
    # Of a metre across it has 0.15 m and 0.075 m on either side.
    assert found.covered_wide == pytest.approx(0.3, abs=1e-6)
    assert found.covered == pytest.approx(0.15, abs=1e-6)
    assert found.mean_visits == pytest.approx(0.1, abs=0.02)
    assert len(left) == 2
    # By vertices: up to half a step less or more than 0.85 of 4 square metres, on either side.
    assert sum(place.area_m2 for place in left) == pytest.approx(4.0 * 0.85, abs=4 * 0.026)
    assert {round(place.place[1], 6) for place in left} == {0.0, 1.0}


def test_the_far_side_of_a_slit_is_not_covered() -> None:
    size = 21
    top = (size - 1) * size + 9
    painting = square(size, (*slit(size, 9, range(1, size - 1)), (top, top + 1)))
    (region,) = regions_of(painting)
    mesh = region.mesh.refined(0.03)
    # Along the line x = 0.45, just on the left of the slit at x = 0.475.
    graph = mesh.graph()
    at = np.flatnonzero(np.abs(mesh.points[:, 0] - 0.45) < 1e-9)
    order = at[np.argsort(mesh.points[at, 1])]
    assert all(graph[a, b] > 0 for a, b in pairwise(order.tolist()))
    found, _ = measure(line_of(Laid(mesh, order.tolist())), 0, 0.1)
    # 0.075 m on the left, 0.025 m up to the slit, and next to nothing round its end.
    assert found.covered == pytest.approx(0.1, abs=0.03)


def test_the_back_of_a_sheet_is_not_covered() -> None:
    """Two sheets 1 mm apart, joined along one side, and a path on one of them."""
    rows, columns, step = 21, 41, 0.05
    front = flat_grid(rows, columns, step)
    back = front.points[:, :] * (1.0, 1.0, 0.0) + (0.0, 0.0, -0.001)
    points = np.vstack([front.points, back])
    up = front.normals
    rim = [[a, a + rows * columns, a + 1] for a in range(columns - 1)]
    rim += [[a + 1, a + rows * columns, a + 1 + rows * columns] for a in range(columns - 1)]
    faces = np.vstack([front.corners, front.corners[:, ::-1] + rows * columns, rim])
    mesh = Triangles(points, faces, np.vstack([up, -up]), np.arange(len(faces)))
    found, _ = measure(line_of(Laid(mesh, lines(range(1, 20, 2), columns))), 0, 0.1)
    assert found.covered == pytest.approx(0.5, abs=0.05)
    assert found.mean_visits == pytest.approx(0.5, abs=0.05)
