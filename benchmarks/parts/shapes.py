"""The other parts: a saddle, a sheet with holes, a sphere, a torus and a blend of balls; mm."""

from __future__ import annotations

import numpy as np
from bracket import circle, rectangle
from even import Array, Mesh, closed_surface, flat_region, rounded


def saddle() -> Mesh:
    """A square saddle, 340 mm wide, which rises and falls by 96 mm at the middles of its sides."""
    half, spacing = 170.0, 8.5

    def lift(p: Array) -> Array:
        return np.stack([*p.T, (p[:, 0] ** 2 - p[:, 1] ** 2) / 300.0], axis=1)

    # Points on a side are even on the bent line, not on the straight one below it.
    fine = np.linspace(-half, half, 2001)
    bent = np.concatenate([[0], np.cumsum(np.hypot(np.diff(fine), np.diff(fine**2 / 300.0)))])
    stations = np.interp(np.linspace(0, bent[-1], round(bent[-1] / spacing) + 1), bent, fine)
    points, faces = flat_region([rectangle(stations, stations)], spacing, lift)
    return rounded(lift(points)), faces


def perforated_sheet() -> Mesh:
    """A sheet of 400 x 300 mm, bent to a radius of 190 mm, with four round holes and a slot."""
    spacing, radius = 9.0, 190.0
    holes = [((-120.0, 70.0), 32.0), ((-120.0, -70.0), 32.0), ((0.0, 0.0), 55.0)]
    holes.append(((120.0, -75.0), 22.0))
    loops = [circle(c, r, round(2 * np.pi * r / spacing)) for c, r in holes]
    slot = np.concatenate(
        [
            np.stack([np.linspace(90, 150, 7)[:-1], np.full(6, 45.0)], axis=1),
            circle((150.0, 70.0), 25.0, 18)[[*range(14, 18), *range(5)]],
            np.stack([np.linspace(150, 90, 7)[1:], np.full(6, 95.0)], axis=1),
            circle((90.0, 70.0), 25.0, 18)[5:14],
        ]
    )
    rim = rectangle(np.linspace(-200, 200, 45), np.linspace(-150, 150, 34))
    points, faces = flat_region([rim, *loops, _without_repeats(slot)], spacing)
    angle = points[:, 0] / radius  # rolled on a cylinder: distances stay as they are
    bent = [radius * np.sin(angle), points[:, 1], radius * (np.cos(angle) - 1)]
    return rounded(np.stack(bent, axis=1)), faces


def sphere() -> Mesh:
    """A ball of 110 mm radius."""

    def field(p: Array) -> Array:
        return np.linalg.norm(p, axis=1) - 110.0

    return closed_surface(field, np.full(3, -120.0), np.full(3, 120.0), 9.8)


def torus() -> Mesh:
    """A torus about z, the middle of its tube on a circle of 125 mm, its tube 40 mm in radius."""

    def field(p: Array) -> Array:
        return np.hypot(np.hypot(p[:, 0], p[:, 1]) - 125.0, p[:, 2]) - 40.0

    box = np.array([175.0, 175.0, 50.0])
    return closed_surface(field, -box, box, 11.0)


# Centers and radii of balls, mm: a body, a head, a tail and two stubs of limbs.
_BALLS = np.array(
    [
        [0.0, 0.0, 0.0, 72.0],
        [70.0, 10.0, 45.0, 46.0],
        [-85.0, -15.0, 20.0, 34.0],
        [-10.0, 70.0, -20.0, 36.0],
        [15.0, -75.0, -10.0, 32.0],
    ]
)


def blend(spacing: float = 10.0) -> Mesh:
    """A closed shape without edges: five balls, blended into one another; spacing in mm."""
    softness = 16.0  # mm

    def field(p: Array) -> Array:
        away = np.linalg.norm(p[:, None] - _BALLS[:, :3], axis=2) - _BALLS[:, 3]
        least = away.min(axis=1, keepdims=True)
        total = np.exp((least - away) / softness).sum(axis=1)
        return least[:, 0] - softness * np.log(total)

    low = (_BALLS[:, :3] - _BALLS[:, 3:]).min(axis=0) - 30
    high = (_BALLS[:, :3] + _BALLS[:, 3:]).max(axis=0) + 30
    return closed_surface(field, low, high, spacing)


def _without_repeats(loop: Array) -> Array:
    """A closed loop whose points are 3 mm apart or more."""
    kept = np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > 3.0
    return loop[kept]
