"""Capsules around points and meshes, as small as can be found.

One capsule is fitted to points. A mesh gets a few that contain it and lie close to it: the mesh is
cut along planes, and each piece gets a capsule of its own. A face that lies across a plane is cut
in two, so that both capsules hold their part of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.cluster.vq import kmeans2
from scipy.optimize import minimize
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.polyhedron import convex_hull

_ROUNDING = 1e-9  # of the radius, so that no point is left outside by rounding


class Capsule(NamedTuple):
    """All points within ``radius`` (m) of the segment from ``start`` to ``end``, (3,) in m."""

    start: Array
    end: Array
    radius: float

    @property
    def volume(self) -> float:
        """In m^3."""
        length = float(np.linalg.norm(self.end - self.start))
        return float(np.pi * self.radius**2 * (length + 4 / 3 * self.radius))


def capsule_around(points: Array) -> Capsule:
    """A small capsule around points (n, 3): the best one found from each principal direction."""
    hull = convex_hull(points)
    outer = points if hull is None else hull.vertices
    middle = outer.mean(axis=0)
    axes = np.linalg.svd(outer - middle, full_matrices=False)[2]
    size = max(float(np.ptp(outer, axis=0).max()), 1e-9)
    best = None
    for axis in axes:
        across = np.linalg.svd(axis[None])[2][1:]

        def around(tried: Array, axis: Array = axis, across: Array = across) -> Capsule:
            direction = axis + tried[2:4] @ across
            center = middle + size * tried[:2] @ across
            direction /= np.linalg.norm(direction)
            return along_axis(outer, center, direction, 1 + abs(float(tried[4])))

        found = minimize(
            lambda tried, around=around: around(tried).volume / size**3,
            _SIMPLEX[0],
            method="Nelder-Mead",
            options={"maxiter": 200, "initial_simplex": _SIMPLEX},
        )
        capsule = around(found.x)
        if best is None or capsule.volume < best.volume:
            best = capsule
    assert best is not None  # there are three axes
    return best


_SIMPLEX = np.concatenate([np.zeros((1, 5)), 0.1 * np.eye(5)])


def along_axis(points: Array, center: Array, axis: Array, wider: float) -> Capsule:
    """The shortest capsule around points whose axis lies on a given line.

    Its radius is ``wider`` times the smallest one that is possible; with more it may be shorter.
    """
    along = (points - center) @ axis
    off = points - center - along[:, None] * axis
    squares = np.einsum("ij,ij->i", off, off)
    radius = float(np.sqrt(squares.max())) * wider * (1 + _ROUNDING)
    cap = np.sqrt(np.maximum(radius**2 - squares, 0.0))
    low, high = float((along + cap).min()), float((along - cap).max())
    if low > high:
        low = high = (low + high) / 2
    return Capsule(center + low * axis, center + high * axis, radius)


_MOST = 4  # capsules of one mesh
_CLOSE = 0.005  # m; capsules that are no farther off the mesh are close enough
_WORTH = 0.9  # more capsules have to bring the distance below this share of it
_OVERLAP = 1e-5  # m; of two capsules where the mesh was cut, so that no point is in neither
_SAMPLES = 2000  # of the mesh, to compare cuts by
_FEWEST = 8  # samples in a piece
_SHARES = np.linspace(0.1, 0.9, 9)  # of the length of a piece, where it may be cut
_WIDER = (1.0, 1.15, 1.3)  # radii that are tried, as shares of the smallest that is possible


class _Cut(NamedTuple):
    """A plane: all points p with ``normal @ p == offset``."""

    normal: Array
    offset: float


def capsules_around(vertices: Array, faces: Index) -> list[Capsule]:
    """One to four capsules that contain a mesh: each point of a face is in one of them.

    They are the fewest whose surface is within 5 mm of the mesh, or little farther than that of the
    closest ones found. The mesh is cut in halves again and again, and also into the neighborhoods
    of two to four points (k-means). The same mesh always has the same capsules.
    """
    triangles = vertices[faces]
    samples = _samples(triangles)
    tree = cKDTree(samples)
    covers: list[tuple[list[Capsule], float]] = []
    halves = _halved(triangles, samples, tree)
    for count in range(1, _MOST + 1):
        found = [next(halves, [])]
        if count > 1:
            found.append(_neighborhoods(triangles, kmeans2(samples, count, minit="++", seed=0)[0]))
        parted = [[p.reshape(-1, 3) for p in pieces if len(p)] for pieces in found if pieces]
        # The smallest capsules take long to find, so only for what the quick ones say is better.
        quick = [_measured([_rough(points) for points in parts], tree) for parts in parted]
        best = min(range(len(parted)), key=lambda each: quick[each][1])
        small = _measured([capsule_around(points) for points in parted[best]], tree)
        covers.append(min(quick[best], small, key=lambda cover: cover[1]))
        if covers[-1][1] <= _CLOSE:
            break
    enough = max(_CLOSE, min(far for _, far in covers) / _WORTH)
    chosen = next(cover for cover, far in covers if far <= enough)
    return [capsule._replace(radius=capsule.radius + _OVERLAP) for capsule in chosen]


def _halved(triangles: Array, samples: Array, tree: cKDTree) -> Iterator[list[Array]]:
    """Triangles (m, 3, 3) whole, and in ever more pieces of (k, 3, 3).

    Among the cuts of each piece across its principal axes the one is taken that leaves capsules
    around samples of the mesh closest to it.
    """
    pieces, sampled, rough = [triangles], [samples], [_rough(samples)]
    while True:
        yield list(pieces)
        found = _best_cut(sampled, rough, tree)
        if found is None:
            return
        index, cut, rough = found
        at, below = slice(index, index + 1), sampled[index] @ cut.normal <= cut.offset
        sampled[at] = [sampled[index][below], sampled[index][~below]]
        above = _Cut(-cut.normal, -cut.offset)
        pieces[at] = [_below(pieces[index], cut), _below(pieces[index], above)]


def _neighborhoods(triangles: Array, centers: Array) -> list[Array]:
    """The part of triangles (m, 3, 3) nearest to each of some points (k, 3): Voronoi cells."""
    pieces = []
    for center in centers:
        piece = triangles
        for other in centers:
            if other is not center and len(piece):
                normal = other - center
                piece = _below(piece, _Cut(normal, float(normal @ (center + other)) / 2))
        pieces.append(piece)
    return pieces


def _measured(cover: list[Capsule], tree: cKDTree) -> tuple[list[Capsule], float]:
    """Capsules, and how far their surface is from the mesh, m."""
    return cover, float(_distances(cover, tree).max())


def _best_cut(
    sampled: list[Array], rough: list[Capsule], tree: cKDTree
) -> tuple[int, _Cut, list[Capsule]] | None:
    """The piece to cut next, the plane, and capsules around the samples on either side."""
    best, least = None, np.inf
    for index, own in enumerate(sampled):
        middle = own.mean(axis=0)
        for axis in _axes(own):
            along = (own - middle) @ axis
            low, high = float(along.min()), float(along.max())
            for share in _SHARES:
                offset = low + share * (high - low)
                below = along <= offset
                if not _FEWEST <= below.sum() <= len(own) - _FEWEST:
                    continue
                cover = list(rough)
                cover[index : index + 1] = [_rough(own[below]), _rough(own[~below])]
                far = _distances(cover, tree)
                # Nearly the greatest distance, but one far end of two is better than both.
                score = float((far**8).mean())
                if score < least:
                    cut = _Cut(axis, float(middle @ axis) + offset)
                    best, least = (index, cut, cover), score
    return best


def _below(triangles: Array, cut: _Cut) -> Array:
    """The part of triangles (m, 3, 3) on or below a plane, as triangles."""
    heights = triangles @ cut.normal - cut.offset
    under = heights <= 0
    counts = under.sum(axis=1)
    pieces = [triangles[counts == 3]]
    for count in (1, 2):
        rows = np.flatnonzero(counts == count)
        # Turned so that the corner that is alone on its side of the plane is the first one.
        alone = np.argmax(under[rows] == (count == 1), axis=1)
        order = (alone[:, None] + np.arange(3)) % 3
        tip, left, right = np.take_along_axis(triangles[rows], order[:, :, None], 1).swapaxes(0, 1)
        at = np.take_along_axis(heights[rows], order, 1)
        share = at[:, :1] / (at[:, :1] - at[:, 1:])
        to_left = tip + share[:, :1] * (left - tip)
        to_right = tip + share[:, 1:] * (right - tip)
        if count == 1:
            pieces.append(np.stack([tip, to_left, to_right], axis=1))
        else:
            pieces.append(np.stack([to_left, left, right], axis=1))
            pieces.append(np.stack([to_left, right, to_right], axis=1))
    return np.concatenate(pieces)


def _samples(triangles: Array) -> Array:
    """Points on triangles (m, 3, 3), evenly by area, and their corners as far as they are few."""
    random = np.random.default_rng(0)
    sides = triangles[:, 1:] - triangles[:, :1]
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    chosen = random.choice(len(triangles), _SAMPLES, p=area / area.sum())
    a, b = random.random((2, _SAMPLES, 1))
    folded = a + b > 1
    a, b = np.where(folded, 1 - a, a), np.where(folded, 1 - b, b)
    points = triangles[chosen, 0] + a * sides[chosen, 0] + b * sides[chosen, 1]
    corners = np.unique(triangles.reshape(-1, 3), axis=0)
    few = corners[:: 1 + len(corners) // _SAMPLES]
    return np.concatenate([points, few])


def _axes(points: Array) -> Array:
    """Principal directions (3, 3) of points, as rows."""
    return np.asarray(np.linalg.eigh(np.cov(points.T))[1].T)


def _rough(points: Array) -> Capsule:
    """A capsule around points along one of their principal directions, through their middle."""
    tried = []
    for axis in _axes(points):
        across = np.linalg.svd(axis[None])[2][1:]
        middle = (points @ across.T).min(axis=0) / 2 + (points @ across.T).max(axis=0) / 2
        tried += [along_axis(points, middle @ across, axis, wider) for wider in _WIDER]
    return min(tried, key=lambda capsule: capsule.volume)


def _distances(capsules: list[Capsule], tree: cKDTree) -> Array:
    """From points on the surface of all capsules to samples of the mesh, m."""
    points = []
    for number, capsule in enumerate(capsules):
        own = _surface(capsule)
        covered = np.zeros(len(own), dtype=bool)
        for other in capsules[:number] + capsules[number + 1 :]:
            covered |= _inside(other, own)
        points.append(own[~covered])
    outside = np.concatenate(points)
    return np.asarray(tree.query(outside)[0]) if len(outside) else np.zeros(1)


def _inside(capsule: Capsule, points: Array) -> Mask:
    axis = capsule.end - capsule.start
    square = float(axis @ axis)
    share = np.clip((points - capsule.start) @ axis / (square or 1.0), 0.0, 1.0)
    off = points - capsule.start - share[:, None] * axis
    return np.asarray(np.einsum("ij,ij->i", off, off) < capsule.radius**2)


def _surface(capsule: Capsule) -> Array:
    """Points on a capsule: those of a sphere, one half at each end, and some in between."""
    axis = capsule.end - capsule.start
    high = _SPHERE @ axis > 0
    sides = _RING[:, :2] @ np.linalg.svd(axis[None])[2][1:]
    shares = np.linspace(0.0, 1.0, 8)
    return np.concatenate(
        [
            capsule.start + capsule.radius * _SPHERE + high[:, None] * axis,
            *[capsule.start + share * axis + capsule.radius * sides for share in shares],
        ]
    )


def _even_sphere(count: int) -> Array:
    """Points on the unit sphere, along a spiral (Fibonacci)."""
    number = np.arange(count) + 0.5
    height, turn = 1 - 2 * number / count, np.pi * (1 + np.sqrt(5)) * number
    flat = np.sqrt(1 - height**2)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), height], axis=1)


_SPHERE = _even_sphere(128)
_RING = np.stack([f(2 * np.pi * np.arange(16) / 16) for f in (np.cos, np.sin)], axis=1)
