"""Even triangles: on flat regions with given borders, and on closed smooth implicit surfaces.

Points are spread by a repulsion that ends at the wanted spacing, as in DistMesh (Persson and Strang
2004), and joined by Delaunay triangulations. Coordinates are in mm and rounded to 1 µm before
they are triangulated, so that the last bits of a sine decide nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, cKDTree

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mesh = tuple[Array, Index]
Field = Callable[[Array], Array]
Place = Callable[[Array], Array]

_DECIMALS = 3  # of a mm


def rounded(points: Array) -> Array:
    """To the micrometer, without negative zeros."""
    return np.round(points, _DECIMALS) + 0.0


def spread(points: Array, fixed: int, spacing: float, place: Place, steps: int = 150) -> Array:
    """Points that have moved apart until neighbors are about ``spacing`` from each other.

    Args:
        points: (n, d), mm.
        fixed: so many of the first points stay where they are.
        spacing: mm.
        place: puts moved points (n, d) back to where they belong.
        steps: how often they move.
    """
    length = 1.15 * spacing  # longer than wanted, so that all push each other a little
    for _ in range(steps):
        i, j = cKDTree(points).query_pairs(length, output_type="ndarray").T
        way = points[i] - points[j]
        distance = np.linalg.norm(way, axis=1, keepdims=True)
        push = 0.2 * (length - distance) * way / np.maximum(distance, 1e-9)
        move = np.zeros_like(points)
        np.add.at(move, i, push)
        np.add.at(move, j, -push)
        move[:fixed] = 0
        moved = place(points + move)
        points = rounded(np.concatenate([points[:fixed], moved[fixed:]]))
    return points


def inside(points: Array, loops: Sequence[Array]) -> NDArray[np.bool_]:
    """Which points (n, 2) lie in the region between loops (k, 2), by the rule of even and odd."""
    odd = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for loop in loops:
        for (ax, ay), (bx, by) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            crosses = (ay > y) != (by > y)
            with np.errstate(divide="ignore", invalid="ignore"):
                odd ^= crosses & (x < (bx - ax) * (y - ay) / (by - ay) + ax)
    return odd


def flat_region(loops: Sequence[Array], spacing: float, lift: Place | None = None) -> Mesh:
    """Triangles of a flat region, counterclockwise, whose borders are the loops as they are.

    Args:
        loops: (k, 2) each, mm; the region is between them, by the rule of even and odd.
        spacing: of the points inside, mm.
        lift: from flat points (n, 2) to points (n, 3); points are even there. None: flat.

    Returns:
        Flat points (n, 2), mm, those of the loops first; triangles (m, 3).
    """
    border = rounded(np.concatenate(loops))
    low, high = border.min(axis=0), border.max(axis=0)
    rows = np.arange(low[1], high[1], spacing * np.sqrt(3) / 2)
    columns = np.arange(low[0], high[0] + spacing, spacing)
    x, y = np.meshgrid(columns, rows)
    x[1::2] -= spacing / 2
    grid = np.stack([x.ravel(), y.ravel()], axis=1)
    apart = cKDTree(border).query(grid)[0] > 0.7 * spacing
    grid = grid[apart & inside(grid, loops)]
    points = np.concatenate([border, grid])

    def place(moved: Array) -> Array:
        """Points that were pushed over the border stay where they were."""
        flat = moved[:, :2]
        kept = inside(flat, loops)
        kept[: len(border)] = True
        back = np.where(kept[:, None], flat, points)
        points[:] = back
        return back if lift is None else lift(back)

    start = points.copy() if lift is None else lift(points)
    points = spread(start, len(border), spacing, place)[:, :2].copy()
    faces = Delaunay(points).simplices.astype(np.int64)
    faces = faces[inside(points[faces].mean(axis=1), loops)]
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces = faces[np.abs(turn) > 1e-6]
    turn = turn[np.abs(turn) > 1e-6]
    faces[turn < 0] = faces[turn < 0][:, [0, 2, 1]]
    if lift is not None:
        _flip_edges(rounded(lift(points)), faces)
    return points, faces


def _flip_edges(points: Array, faces: Index) -> None:
    """Flip edges until no two angles opposite to an edge add up to more than half a turn.

    Args:
        points: (n, 3), mm.
        faces: (m, 3), changed in place.
    """
    changed = True
    while changed:
        changed = False
        seen: dict[tuple[int, int], tuple[int, int]] = {}
        touched = np.zeros(len(faces), dtype=bool)
        for face, corners in enumerate(faces.tolist()):
            for k in range(3):
                a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
                other = seen.get((b, a))
                seen[a, b] = (face, c)
                if other is None or touched[face] or touched[other[0]]:
                    continue
                d = other[1]
                if _angle(points, c, a, b) + _angle(points, d, a, b) > np.pi + 1e-4:
                    faces[face], faces[other[0]] = (a, d, c), (d, b, c)
                    touched[[face, other[0]]] = changed = True


def _angle(points: Array, at: int, a: int, b: int) -> float:
    u, v = points[a] - points[at], points[b] - points[at]
    return float(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))


def closed_surface(field: Field, low: Array, high: Array, spacing: float) -> Mesh:
    """Triangles of the closed smooth surface where a field is zero; it is negative inside.

    Those faces of the Delaunay tetrahedra are taken that lie between a tetrahedron whose
    circumcenter is inside and one whose is outside: the restricted Delaunay triangulation, which
    is the surface's where points are dense enough for its curvature (Amenta and Bern 1999).

    Args:
        field: of points (n, 3), mm, (n,).
        low, high: (3,) corners of a box around the surface.
        spacing: between neighboring points, mm.
    """

    def place(points: Array) -> Array:
        for _ in range(4):
            slope = _slope(field, points)
            points = points - (field(points) / (slope**2).sum(axis=1))[:, None] * slope
        return points

    fine = spacing / 4
    axes = [np.arange(a, b, fine) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    near = grid[np.abs(field(grid)) < fine * np.linalg.norm(_slope(field, grid), axis=1)]
    near = rounded(place(near))
    points = spread(near[_thinned(near, 0.85 * spacing)], 0, spacing, place, 300)
    return points, _restricted_delaunay(points, field)


def _slope(field: Field, points: Array) -> Array:
    step = 1e-3
    ahead = np.eye(3) * step
    return np.stack([(field(points + a) - field(points - a)) / (2 * step) for a in ahead], axis=1)


def _thinned(points: Array, distance: float) -> list[int]:
    """Points in their order, without those nearer than the distance to an earlier one."""
    taken: list[int] = []
    gone = np.zeros(len(points), dtype=bool)
    tree = cKDTree(points)
    for number in range(len(points)):
        if not gone[number]:
            taken.append(number)
            gone[tree.query_ball_point(points[number], distance)] = True
    return taken


def _restricted_delaunay(points: Array, field: Field) -> Index:
    cells = Delaunay(points)
    corners = points[cells.simplices]
    a = corners[:, 0]
    edges = corners[:, 1:] - a[:, None]
    u, v, w = (edges[:, k] for k in range(3))
    vw, wu, uv = np.cross(v, w), np.cross(w, u), np.cross(u, v)
    volume = (u * vw).sum(axis=1)
    squares = (edges**2).sum(axis=2)
    center = squares[:, :1] * vw + squares[:, 1:2] * wu + squares[:, 2:] * uv
    with np.errstate(divide="ignore", invalid="ignore"):
        center = a + center / (2 * volume[:, None])
    full = np.zeros(len(corners), dtype=bool)
    sound = np.isfinite(center).all(axis=1)
    full[sound] = field(center[sound]) < 0
    outer = np.append(~full, True)[cells.neighbors]  # beyond the hull is outside
    cell, corner = np.nonzero(full[:, None] & outer)
    tetrahedra = cells.simplices[cell]
    faces = np.stack([np.delete(t, k) for t, k in zip(tetrahedra, corner, strict=True)])
    opposite = points[tetrahedra[np.arange(len(cell)), corner]]
    p, q, r = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(q - p, r - p) * (opposite - p)).sum(axis=1) > 0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    return faces.astype(np.int64)
