"""Faces of a mesh that cross each other, found by a grid, then by sides against faces."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask, numbered
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.surface import Faces
from cellcolor.memory import chunks

MOST_FACES = 200_000  # more are not looked at
_MOST_PLACES = 10_000_000  # cells of the grid that all faces together are entered in
_PAIR = 3000  # bytes that two faces take
_INSIDE = 1e-7  # by this share of a side or face a crossing has to be off its ends


def crossing_pairs(vertices: Array, faces: Faces, deadline: Deadline = NEVER) -> Index | None:
    """Pairs of faces (p, 2), the smaller number first, of which one crosses the other.

    A side of one goes through the inside of the other. Faces that share an edge are no such pair,
    and faces that lie in one plane and overlap are not found.

    Returns:
        None if there are too many faces, or they are too uneven in size, for that to be affordable.
    """
    if len(faces) > MOST_FACES:
        return None
    corners = vertices[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    size = float(2 * np.median((high - low).max(axis=1)))
    first = np.floor((low - low.min(axis=0)) / size).astype(np.int64)
    spans = np.floor((high - low.min(axis=0)) / size).astype(np.int64) - first + 1
    entries = spans.prod(axis=1)
    if entries.sum() > _MOST_PLACES:
        return None
    face, rank = numbered(entries)
    cell = first[face]
    for axis in (2, 1, 0):
        rank, step = np.divmod(rank, spans[face, axis])
        cell[:, axis] += step
    counts = cell.max(axis=0) + 1
    key = np.ravel_multi_index(tuple(cell.T), tuple(counts))
    order = np.argsort(key, kind="stable")
    key, face = key[order], face[order]
    found = []
    offset, rows = 1, np.arange(len(key))
    while True:
        rows = rows[rows + offset < len(key)]
        rows = rows[key[rows] == key[rows + offset]]
        if not len(rows):
            break
        for part in chunks(len(rows), _PAIR):
            deadline.check()
            some = rows[part]
            pairs = np.column_stack([face[some], face[some + offset]])
            found.append(crossing_of(vertices, faces, low, high, pairs))
        offset += 1
    both = np.sort(np.concatenate([np.zeros((0, 2), dtype=np.int64), *found]), axis=1)
    return np.unique(both, axis=0)


def crossing_of(vertices: Array, faces: Faces, low: Array, high: Array, pairs: Index) -> Index:
    """Those of some pairs (p, 2) of faces that cross; their boxes go from low to high (m, 3)."""
    a, b = pairs.T
    near = ((low[a] <= high[b]) & (low[b] <= high[a])).all(axis=1)
    pairs = pairs[near]
    a, b = pairs.T
    shared = (faces[a][:, :, None] == faces[b][:, None, :]).sum(axis=(1, 2))
    pairs = pairs[shared < 2]
    both = np.concatenate([pairs, pairs[:, ::-1]])
    corners = faces[both[:, 0]]
    start, end = vertices[corners.T], vertices[np.roll(corners, -1, axis=1).T]
    triangles = np.tile(vertices[faces[both[:, 1]]], (3, 1, 1))
    hit = _through(start.reshape(-1, 3), end.reshape(-1, 3), triangles)
    return pairs[hit.reshape(6, -1).any(axis=0)]


def _through(start: Array, end: Array, triangle: Array) -> Mask:
    """Whether segments (k, 3) go through the insides of triangles (k, 3, 3).

    After Moeller and Trumbore, "Fast, minimum storage ray-triangle intersection", 1997.
    """
    way, origin = end - start, triangle[:, 0]
    u_side, v_side = triangle[:, 1] - origin, triangle[:, 2] - origin
    normal = np.cross(way, v_side)
    volume = np.einsum("ij,ij->i", u_side, normal)
    scale = np.linalg.norm(way, axis=1) * np.linalg.norm(np.cross(u_side, v_side), axis=1)
    level = np.abs(volume) <= 1e-9 * scale
    safe = np.where(level, 1.0, volume)
    off = start - origin
    u = np.einsum("ij,ij->i", off, normal) / safe
    other = np.cross(off, u_side)
    v = np.einsum("ij,ij->i", way, other) / safe
    t = np.einsum("ij,ij->i", v_side, other) / safe
    inside = np.minimum(np.minimum(u, v), np.minimum(1 - u - v, np.minimum(t, 1 - t)))
    return np.asarray(~level & (inside > _INSIDE))
