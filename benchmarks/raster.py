"""Raster paths: a surface cut by parallel planes, pass after pass."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import LabelledSurface

# A place on the mesh: on the mesh edge from the first vertex to the second, this part of the way.
_Place = tuple[int, int, float]
_STEP, _TURN = 0.0025, np.radians(2.0)  # m, rad; samples are not farther apart
_CLOSED = 0.2  # of its area: a surface whose normals add up to less has no side to be seen from


@dataclass(frozen=True)
class Raster:
    """A path over a surface, in samples; from each one to the next it goes straight in a triangle.

    Attributes:
        points: (n, 3), m.
        normals: (n, 3), outward unit vectors, interpolated in the triangles.
        starts: samples that the path does not go to from the one before, the first among them: the
            surface falls apart there.
    """

    points: Array
    normals: Array
    starts: Index


def raster(
    surface: LabelledSurface, normals: Array, reachable: Mask, angle: float, spacing: float
) -> Raster:
    """A raster path over the part of a surface that can be reached.

    The surface is cut by planes at the spacing. They contain the line of sight along which its
    normals point on average, or the vertical if it is closed. Of the passes that one plane gives
    the nearest is next, and between passes the path goes along mesh edges, the shortest way. Where
    the surface runs along the planes, passes are farther apart.

    Args:
        surface: the surface.
        normals: (n, 3) outward, at its vertices.
        reachable: (n,) only triangles are cut of which all vertices are.
        angle: of the planes about that line of sight, rad.
        spacing: between planes, m.
    """
    faces = surface.faces[reachable[surface.faces].all(axis=1)]
    across = surface.vertices @ _across(surface, angle)
    neighbors = _neighbors(surface.vertices, faces)
    levels = np.arange(across[faces].min() + spacing / 2, across[faces].max(), spacing)
    trail: list[_Place] = []
    starts = [0]
    for level in levels:
        passes = _passes(faces, across, float(level))
        while passes:
            chosen = _nearest(surface.vertices, trail, passes)
            if trail:
                way = _way(surface.vertices, neighbors, trail[-1], chosen[0])
                if way is None:
                    starts.append(len(trail))
                else:
                    trail += way
            trail += chosen
    return _sampled(surface.vertices, normals, trail, starts)


def _across(surface: LabelledSurface, angle: float) -> Array:
    """The unit vector (3,) on which planes stand."""
    sight = surface.mesh.area_vectors.sum(axis=0)
    if np.linalg.norm(sight) < _CLOSED * 2 * surface.mesh.areas.sum():
        sight = np.array([0.0, 0.0, 1.0])
    # The two other right singular vectors of the line of sight are a basis of the plane.
    plane = np.linalg.svd(sight[None])[2][1:]
    across: Array = plane[1] * np.cos(angle) - plane[0] * np.sin(angle)
    return across


def _neighbors(vertices: Array, faces: Index) -> dict[int, dict[int, float]]:
    """The neighbors of each vertex, and how far they are, m."""
    found: dict[int, dict[int, float]] = {}
    for corners in faces.tolist():
        for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
            length = float(np.linalg.norm(vertices[a] - vertices[b]))
            found.setdefault(a, {})[b] = length
            found.setdefault(b, {})[a] = length
    return found


def _passes(faces: Index, across: Array, level: float) -> list[list[_Place]]:
    """The polylines in which a plane cuts triangles; a closed one ends where it begins."""
    above = across > level
    cut = faces[above[faces].any(axis=1) & ~above[faces].all(axis=1)]
    ends: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for corners in cut.tolist():
        pair = [
            (min(a, b), max(a, b))
            for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
            if above[a] != above[b]
        ]
        ends.setdefault(pair[0], []).append(pair[1])
        ends.setdefault(pair[1], []).append(pair[0])
    found = []
    # Open polylines first, from one of their ends; what is left then is closed.
    for start in [edge for edge in ends if len(ends[edge]) == 1] + list(ends):
        if start not in ends:
            continue
        chain, closed = [start], len(ends[start]) == 2
        here = start
        while ends.get(here):
            after = ends[here].pop()
            ends[after].remove(here)
            if not ends[here]:
                del ends[here]
            chain.append(after)
            here = after
        ends.pop(here, None)
        assert not closed or chain[0] == chain[-1]
        found.append([(a, b, _part(across, a, b, level)) for a, b in chain])
    return found


def _part(across: Array, a: int, b: int, level: float) -> float:
    return float((level - across[a]) / (across[b] - across[a]))


def _nearest(vertices: Array, trail: list[_Place], passes: list[list[_Place]]) -> list[_Place]:
    """Take out the pass that begins nearest to the end of the trail, and turn it to begin there."""
    if not trail:
        return passes.pop(0)
    here = _point(vertices, trail[-1])
    best: tuple[float, int, int] | None = None
    for number, places in enumerate(passes):
        closed = places[0] == places[-1]
        for k in range(len(places)) if closed else (0, len(places) - 1):
            away = float(np.linalg.norm(_point(vertices, places[k]) - here))
            if best is None or away < best[0]:
                best = away, number, k
    assert best is not None
    _, number, k = best
    places = passes.pop(number)
    if places[0] == places[-1]:
        return places[k:-1] + places[: k + 1]
    return places if k == 0 else places[::-1]


def _way(
    vertices: Array, neighbors: dict[int, dict[int, float]], start: _Place, end: _Place
) -> list[_Place] | None:
    """The shortest way along mesh edges between two places (Dijkstra), None if there is none."""
    if set(start[:2]) & set(end[:2]):
        shared = min(set(start[:2]) & set(end[:2]))
        return [(shared, shared, 0.0)]
    begin, finish = _point(vertices, start), _point(vertices, end)
    best: dict[int, tuple[float, int]] = {}
    queue = [(float(np.linalg.norm(vertices[v] - begin)), v, -1) for v in start[:2]]
    heapq.heapify(queue)
    goals = {v: float(np.linalg.norm(vertices[v] - finish)) for v in end[:2]}
    reached: tuple[float, int] | None = None
    while queue:
        length, vertex, before = heapq.heappop(queue)
        if reached is not None and length >= reached[0]:
            break
        if vertex in best:
            continue
        best[vertex] = length, before
        if vertex in goals and (reached is None or length + goals[vertex] < reached[0]):
            reached = length + goals[vertex], vertex
        for other, step in neighbors[vertex].items():
            if other not in best:
                heapq.heappush(queue, (length + step, other, vertex))
    if reached is None:
        return None
    way, vertex = [], reached[1]
    while vertex != -1:
        way.append((vertex, vertex, 0.0))
        vertex = best[vertex][1]
    return way[::-1]


def _point(vertices: Array, place: _Place) -> Array:
    a, b, part = place
    return np.asarray((1 - part) * vertices[a] + part * vertices[b])


def _sampled(vertices: Array, normals: Array, trail: list[_Place], starts: list[int]) -> Raster:
    a, b = np.array([place[:2] for place in trail], dtype=np.int64).T
    part = np.array([place[2] for place in trail])[:, None]
    points = (1 - part) * vertices[a] + part * vertices[b]
    slanted = (1 - part) * normals[a] + part * normals[b]  # linear in the triangles
    upright = slanted / np.linalg.norm(slanted, axis=1, keepdims=True)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    turns = np.linalg.norm(np.diff(upright, axis=0), axis=1)
    pieces = np.maximum(1, np.ceil(np.maximum(steps / _STEP, turns / _TURN))).astype(int)
    pieces[np.array(starts[1:], dtype=np.int64) - 1] = 1
    firsts = np.concatenate([[0], np.cumsum(pieces)])
    along = np.repeat(np.arange(len(pieces)), pieces)
    way = ((np.arange(firsts[-1]) - firsts[:-1][along]) / pieces[along])[:, None]
    ends = np.minimum(along + 1, len(points) - 1)
    fine = (1 - way) * points[along] + way * points[ends]
    tilted = (1 - way) * slanted[along] + way * slanted[ends]
    fine = np.concatenate([fine, points[-1:]])
    tilted = np.concatenate([tilted, slanted[-1:]])
    unit = tilted / np.linalg.norm(tilted, axis=1, keepdims=True)
    return Raster(fine, unit, firsts[np.array(starts, dtype=np.int64)])
