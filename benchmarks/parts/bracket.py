"""A bracket with a rib, a boss, bolt holes, a fillet and a chamfer, its edges sharp.

Its faces are flat or can be rolled out flat: each is a region of even triangles between borders
that it shares, point by point, with its neighbors. The base lies in z <= 0 and the wall in x <= 0;
where they meet inside is a fillet. Lengths in mm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from even import Array, Index, Mesh, flat_region, rounded
from scipy.spatial import cKDTree

SPACING = 9.0
LENGTH, HEIGHT, HALF_WIDTH, THICK = 240.0, 200.0, 80.0, 16.0
FILLET, CHAMFER = 45.0, 20.0
RIB_HALF_WIDTH, RIB_FOOT, RIB_TOP = 8.0, 150.0, 95.0  # its foot's x and its top's z
BOLT_X, BOLT_Y, BOLT_RADIUS = 200.0, 50.0, 12.0
BOSS_Z, BOSS_RADIUS, BOSS_TOP_RADIUS, BOSS_HEIGHT, BORE_RADIUS = 150.0, 30.0, 20.0, 12.0, 10.0

_FLAT = LENGTH - FILLET  # of the base, before the fillet
_ARC = FILLET * np.pi / 2
_ROLLED = _FLAT + _ARC + HEIGHT - FILLET  # base and wall, rolled out


def line(*corners: Sequence[float]) -> Array:
    """Points on an open polygon, its corners among them, about a spacing apart."""
    parts = []
    for a, b in zip(np.array(corners[:-1]), np.array(corners[1:]), strict=True):
        pieces = max(1, round(float(np.linalg.norm(b - a)) / SPACING))
        parts.append(a + (b - a) * (np.arange(pieces) / pieces)[:, None])
    return np.concatenate([*parts, np.array(corners[-1:])])


def ring(*corners: Sequence[float]) -> Array:
    """Points on a closed polygon."""
    return line(*corners, corners[0])[:-1]


def circle(center: Sequence[float], radius: float, points: int) -> Array:
    """So many points on a circle."""
    angle = 2 * np.pi * np.arange(points) / points
    return np.array(center) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def inner(rolled: Array) -> Array:
    """From the rolled-out inside (s, y), s from the base's tip up the wall, to (x, y, z)."""
    s, y = rolled.T
    angle = np.clip((s - _FLAT) / FILLET, 0, np.pi / 2)
    x = FILLET - FILLET * np.sin(angle) + np.maximum(_FLAT - s, 0)
    z = FILLET - FILLET * np.cos(angle) + np.maximum(s - _FLAT - _ARC, 0)
    return np.stack([x, y, z], axis=1)


def tube(first: Array, last: Array) -> Mesh:
    """Triangles between two rings (k, 3) of as many points."""
    rows = max(1, round(float(np.linalg.norm(last[0] - first[0])) / SPACING))
    parts = np.arange(rows + 1)[:, None, None] / rows
    points = (first + (last - first) * parts).reshape(-1, 3)
    around = len(first)
    k = np.arange(rows * around)
    after = k - k % around + (k + 1) % around
    up = [
        np.stack(t, axis=1) for t in ((k, after, after + around), (k, after + around, k + around))
    ]
    return points, np.concatenate(up).astype(np.int64)


def bracket() -> Mesh:
    """Vertices (n, 3) in mm, and faces, ccw from outside."""
    foot, top = LENGTH - RIB_FOOT, _FLAT + _ARC + RIB_TOP - FILLET
    boss = (_FLAT + _ARC + BOSS_Z - FILLET, 0.0)
    bolts = [(LENGTH - BOLT_X, sign * BOLT_Y) for sign in (-1, 1)]
    around_bolt, around_boss = 9, 18
    side = line((0.0, 0.0), (_ROLLED, 0.0))[:, 0]
    across = line((0.0, -HALF_WIDTH), (0.0, HALF_WIDTH))[:, 1]
    rib_side = line((foot, 0.0), (top, 0.0))[:, 0]
    rib_across = line((0.0, -RIB_HALF_WIDTH), (0.0, RIB_HALF_WIDTH))[:, 1]
    slope = line((RIB_FOOT, 0.0), (0.0, RIB_TOP))
    outer = line((-THICK, HEIGHT), (-THICK, CHAMFER - THICK), (CHAMFER - THICK, -THICK))
    outer = np.concatenate([outer[:-1], line((CHAMFER - THICK, -THICK), (LENGTH, -THICK))])
    tip, crown = line((LENGTH, -THICK), (LENGTH, 0.0)), line((0.0, HEIGHT), (-THICK, HEIGHT))
    pieces: list[Mesh] = []

    def add(loops: list[Array], flip: bool, place: Callable[[Array], Array]) -> None:
        points, faces = flat_region(loops, SPACING)
        pieces.append((place(points), faces[:, ::-1] if flip else faces))

    # The inside, rolled out, but for bolts, boss and rib.
    bolt_holes = [circle(bolt, BOLT_RADIUS, around_bolt) for bolt in bolts]
    boss_foot = circle(boss, BOSS_RADIUS, around_boss)
    rib_foot = rectangle(rib_side, rib_across)
    add([rectangle(side, across), *bolt_holes, boss_foot, rib_foot], True, inner)
    # Rib: two sides, and the slope between them.
    below = inner(np.stack([rib_side, np.zeros_like(rib_side)], axis=1))[:, [0, 2]]
    loop = np.concatenate([below, slope[::-1][1:-1]])
    for y in (-RIB_HALF_WIDTH, RIB_HALF_WIDTH):
        add([loop], y > 0, lambda p, y=y: np.stack([p[:, 0], np.full(len(p), y), p[:, 1]], axis=1))
    way = np.array([-RIB_FOOT, RIB_TOP])
    long = float(np.linalg.norm(way))
    stations = np.linalg.norm(slope - slope[0], axis=1)

    def on_slope(p: Array) -> Array:
        x, z = (np.array([RIB_FOOT, 0.0]) + p[:, :1] * way / long).T
        return np.stack([x, p[:, 1], z], axis=1)

    add([rectangle(stations, rib_across)], True, on_slope)
    # Boss: a cone, its top, and the bore through it and the wall.
    boss_top = circle(boss, BOSS_TOP_RADIUS, 14)
    bore = circle(boss, BORE_RADIUS, 8)

    def on_boss(p: Array) -> Array:
        points = inner(p)
        away = np.linalg.norm(p - np.array(boss), axis=1)
        height = (BOSS_RADIUS - away) / (BOSS_RADIUS - BOSS_TOP_RADIUS) * BOSS_HEIGHT
        points[:, 0] = np.clip(height, 0, BOSS_HEIGHT)
        return points

    add([boss_foot, boss_top], True, on_boss)
    add([boss_top, bore], True, on_boss)
    out = on_boss(bore)
    back = out * [0, 1, 1] - [THICK, 0, 0]
    pieces.append(_flipped(tube(out, back)))
    for hole in bolt_holes:
        up = inner(hole)
        pieces.append(_flipped(tube(up, up - [0, 0, THICK])))
    # Outside: the wall's back, the chamfer, the base's bottom.
    back_hole = back[:, [1, 2]]
    levels = line((0.0, CHAMFER - THICK), (0.0, HEIGHT))[:, 1]
    add([rectangle(across, levels), back_hole], True, lambda p: _column(p, 0, -THICK))
    slant = line((-THICK, CHAMFER - THICK), (CHAMFER - THICK, -THICK))
    steps = np.linalg.norm(slant - slant[0], axis=1)
    direction = np.array([1.0, -1.0]) / np.sqrt(2)

    def on_chamfer(p: Array) -> Array:
        x, z = (slant[0] + p[:, :1] * direction).T
        return np.stack([x, p[:, 1], z], axis=1)

    add([rectangle(steps, across)], True, on_chamfer)
    bottom = line((CHAMFER - THICK, 0.0), (LENGTH, 0.0))[:, 0]
    bottom_holes = [inner(hole)[:, :2] for hole in bolt_holes]
    add([rectangle(bottom, across), *bottom_holes], True, lambda p: _column(p, 2, -THICK))
    # The base's tip, the wall's crown, and the two flanks.
    add([rectangle(across, tip[:, 1])], False, lambda p: _column(p, 0, LENGTH))
    add([rectangle(crown[:, 0][::-1], across)], False, lambda p: _column(p, 2, HEIGHT))
    profile = inner(np.stack([side, np.zeros_like(side)], axis=1))[:, [0, 2]]
    flank = np.concatenate([profile[:-1], crown[:-1], outer[:-1], tip[:-1]])
    for y in (-HALF_WIDTH, HALF_WIDTH):
        add([flank], y > 0, lambda p, y=y: _column(p, 1, y))
    return welded(pieces)


def rectangle(xs: Array, ys: Array) -> Array:
    """A closed loop (k, 2) along a rectangle with these stations on its sides."""
    corners = [
        np.stack([xs[:-1], np.full(len(xs) - 1, ys[0])], axis=1),
        np.stack([np.full(len(ys) - 1, xs[-1]), ys[:-1]], axis=1),
        np.stack([xs[:0:-1], np.full(len(xs) - 1, ys[-1])], axis=1),
        np.stack([np.full(len(ys) - 1, xs[0]), ys[:0:-1]], axis=1),
    ]
    return np.concatenate(corners)


def _column(points: Array, axis: int, value: float) -> Array:
    """Points (n, 2) with a third coordinate put in."""
    return np.insert(points, axis, value, axis=1)


def _flipped(mesh: Mesh) -> Mesh:
    return mesh[0], mesh[1][:, ::-1]


def welded(pieces: Sequence[Mesh]) -> Mesh:
    """Pieces as one mesh: points within 0.05 mm of each other are one vertex."""
    starts = np.cumsum([0, *(len(points) for points, _ in pieces)])
    points = rounded(np.concatenate([points for points, _ in pieces]))
    faces: Index = np.concatenate([f + s for (_, f), s in zip(pieces, starts[:-1], strict=True)])
    first = np.arange(len(points))
    for i, j in sorted(cKDTree(points).query_pairs(0.05)):
        first[j] = min(first[j], first[i])
    kept, number = np.unique(first, return_inverse=True)
    return points[kept], number[faces]
