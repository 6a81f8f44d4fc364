"""Arms as a calibration leaves them: every joint's frame a little moved and turned."""

from __future__ import annotations

import dh_arms
import numpy as np
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array


def perturbed(placements: list[Array], angle: float, distance: float, seed: int) -> list[Array]:
    """Placements (4, 4) of the joints, each but the flange's moved by up to so much, rad and m."""
    random, moved = np.random.default_rng(seed), []
    for placement in placements[:-1]:
        turn, way = random.uniform(-1, 1, (2, 3))
        step = np.eye(4)
        step[:3, :3] = Rotation.from_rotvec(angle / np.sqrt(3) * turn).as_matrix()
        step[:3, 3] = distance / np.sqrt(3) * way
        moved.append(placement @ step)
    return [*moved, placements[-1]]


def urdf(name: str, angle: float = 1e-3, distance: float = 5e-4, seed: int = 1) -> str:
    """URDF of one of ``dh_arms.ARMS`` after a calibration; the tool stays on the last axis."""
    placements = [np.eye(4), *dh_arms.steps_of(dh_arms.ARMS[name])]
    return dh_arms.urdf_of(perturbed(placements, angle, distance, seed))
