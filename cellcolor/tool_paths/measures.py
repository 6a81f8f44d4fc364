"""What a tool path covers, and how often it passes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, numbered
from cellcolor.data.trajectory import LeftOut
from cellcolor.tool_paths.rounding import Line
from cellcolor.tool_paths.triangles import Triangles

_SAMPLES = 4000  # at which visits are counted, for one path
_FINE = 8  # samples of the path on each spacing


@dataclass(frozen=True, slots=True)
class PathMeasures:
    """One path, or all of them.

    Attributes:
        area_m2: of what is to be covered.
        length_m: of the path.
        covered_wide: share of the area within 1.5 spacings of the path, along the surface.
        covered: share of the area within 0.75 spacings of it.
        mean_visits: passes within half a spacing of a point, in the mean over the area. A pass
            is a stretch of path that long as it stays so near.
        border_m: length of the covered part's border.
    """

    area_m2: float
    length_m: float
    covered_wide: float
    covered: float
    mean_visits: float
    border_m: float

    def __str__(self) -> str:
        visits = f"{self.mean_visits:.2f} visits"
        return f"{self.length_m:.2f} m, {100 * self.covered:.2f} % covered, {visits}"


def measure(line: Line, segment: int, spacing: float) -> tuple[PathMeasures, list[LeftOut]]:
    """Measure a path, and find what it leaves uncovered."""
    mesh = line.mesh
    distances = mesh.distances_from(*_beside(line))
    areas = mesh.vertex_areas
    area = float(areas.sum())
    measures = PathMeasures(
        area,
        float(np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()),
        share_within(mesh, distances, 1.5 * spacing),
        share_within(mesh, distances, 0.75 * spacing),
        float(visits_of(line, spacing).mean()),
        float(mesh.lengths[mesh.triangles_at == 1].sum()),
    )
    left = []
    for members in mesh.places(distances > 0.75 * spacing):
        farthest = members[distances[members].argmax()]
        left.append(
            LeftOut(
                segment,
                float(areas[members].sum()),
                "a tip or core that the pattern does not enter",
                tuple(mesh.points[farthest].tolist()),
            )
        )
    return measures, left


def share_within(mesh: Triangles, distances: Array, most: float) -> float:
    """Share of a mesh where a field, linear in each triangle, is no greater than a value."""
    low, middle, high = np.sort(distances[mesh.corners], axis=1).T
    with np.errstate(divide="ignore", invalid="ignore"):
        below = (most - low) ** 2 / ((middle - low) * (high - low))
        above = 1.0 - (high - most) ** 2 / ((high - low) * (high - middle))
    share = np.where(most < middle, below, above)
    share = np.where(most <= low, 0.0, np.where(most >= high, 1.0, share))
    return min(1.0, float(np.average(share, weights=mesh.areas)))


def _beside(line: Line) -> tuple[Index, Array]:
    """The corners of all triangles that a path lies in, and how far it is from each, m."""
    corners = line.mesh.corners[line.triangles]
    start, step = line.points[:-1, None], np.diff(line.points, axis=0)[:, None]
    off = line.mesh.points[corners] - start
    length = np.maximum((step**2).sum(axis=2), 1e-300)
    share = np.clip((off * step).sum(axis=2) / length, 0.0, 1.0)
    far = np.linalg.norm(off - share[:, :, None] * step, axis=2).ravel()
    vertices, number = np.unique(corners, return_inverse=True)
    nearest = np.full(len(vertices), np.inf)
    np.minimum.at(nearest, number.ravel(), far)
    return vertices, nearest


def visits_of(line: Line, spacing: float) -> Index:
    """How many passes come within half a spacing of each of several places, even by area."""
    mesh = line.mesh
    rng = np.random.default_rng(0)
    chosen = rng.choice(len(mesh.corners), _SAMPLES, p=mesh.areas / mesh.areas.sum())
    shares = rng.dirichlet((1.0, 1.0, 1.0), _SAMPLES)[:, :, None]
    places = (mesh.points[mesh.corners[chosen]] * shares).sum(axis=1)
    outward = (mesh.normals[mesh.corners[chosen]] * shares).sum(axis=1)
    points, normals = _sampled(line.points, line.normals, spacing / _FINE)
    near = cKDTree(points).query_ball_point(places, spacing / 2, return_sorted=True)
    place = np.repeat(np.arange(len(places)), [len(found) for found in near])
    found = np.concatenate([np.array(rows, dtype=np.int64) for rows in near])
    # The back of a sheet faces away.
    kept = np.einsum("ij,ij->i", normals[found], outward[place]) > 0
    place, found = place[kept], found[kept]
    begins = np.ones(len(found), dtype=bool)
    begins[1:] = (np.diff(found) > 1) | (np.diff(place) > 0)
    return np.bincount(place[begins], minlength=len(places))


def _sampled(points: Array, normals: Array, longest: float) -> tuple[Array, Array]:
    """A path with more points, none farther from the next than asked for."""
    pieces = np.ceil(np.linalg.norm(np.diff(points, axis=0), axis=1) / longest).astype(np.int64)
    pieces = np.maximum(pieces, 1)
    start, number = numbered(pieces)
    between = (number / pieces[start])[:, None]
    return tuple(  # type: ignore[return-value]
        np.vstack([(1 - between) * rows[start] + between * rows[start + 1], rows[-1:]])
        for rows in (points, normals)
    )


def in_all(measures: list[PathMeasures]) -> PathMeasures:
    """The measures of several paths together; shares and means are weighed by area."""
    if not measures:
        return PathMeasures(0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
    areas = [one.area_m2 for one in measures]

    def mean(name: str) -> float:
        return float(np.average([getattr(one, name) for one in measures], weights=areas))

    return PathMeasures(
        sum(areas),
        sum(one.length_m for one in measures),
        mean("covered_wide"),
        mean("covered"),
        mean("mean_visits"),
        sum(one.border_m for one in measures),
    )
