"""Lines bend no more than they have to, whatever the mesh and the raggedness of its border."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from painted import square

from cellcolor.deadline import NEVER
from cellcolor.tool_paths.contour import lay_contours
from cellcolor.tool_paths.region import Segments, regions_of
from cellcolor.tool_paths.triangles import Triangles, evened
from examples import examples

SPACING = 0.05


def mesh_of(painting: Segments) -> Triangles:
    (region,) = regions_of(painting)
    return region.mesh.refined(SPACING / 2)


@given(st.floats(-3, 3), st.floats(-1, 1), st.integers(0, 10**6))
@examples(8)
def test_straight_lines_stay_and_short_waves_go(turn: float, offset: float, seed: int) -> None:
    mesh = mesh_of(square(8))
    along = mesh.points @ [np.cos(turn), np.sin(turn), 0.0] + offset
    assert np.allclose(evened(mesh, along, SPACING), along, atol=1e-6)
    noise = np.random.default_rng(seed).normal(0, 0.002, len(along))
    left = evened(mesh, along + noise, SPACING) - along
    inside = ~mesh.border
    assert np.sqrt((left[inside] ** 2).mean()) < 0.5 * np.sqrt((noise[inside] ** 2).mean())


def test_lines_beside_a_ragged_border_are_straighter_than_it() -> None:
    """A square whose sides have teeth: the line beside them follows less than half of each."""
    painting = square(21)
    vertices = painting.surface.vertices
    odd = (np.round(vertices[:, 0] * 20).astype(int) % 2) == 1
    bottom = vertices[:, 1] < 1e-9
    painting.segment_of[bottom & odd] = -1
    mesh = mesh_of(painting)
    laid = lay_contours(mesh, SPACING, NEVER)
    points = laid.mesh.points[laid.walk]
    near = (points[:, 1] < 0.08) & (points[:, 0] > 0.2) & (points[:, 0] < 0.8)
    teeth = np.ptp(mesh.points[mesh.border & (mesh.points[:, 1] < 0.05)][:, 1])
    first = points[near & (points[:, 1] < 0.06)]
    assert len(first) > 10
    assert np.ptp(first[:, 1]) < 0.5 * teeth
