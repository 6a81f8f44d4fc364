"""How far a part may be off a placement before its lift-offs rise; sampled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import norm, qmc

from cellcolor.arrays import Array
from cellcolor.frontend.parts.placement import rotation_from_rpy
from cellcolor.questions.placements import Pose

_FITTED = 4  # times that a displacement is scaled; a turn moves points along arcs


@dataclass(frozen=True, slots=True)
class Displaced:
    """A placement beside another.

    Attributes:
        off_m: how far the vertex is moved that is moved farthest.
        pose: where the part stands.
    """

    off_m: float
    pose: Pose


def displaced(
    vertices: Array, pose: Pose, up_to_m: float, count: int, seed: int
) -> list[Displaced]:
    """Placements all around one, the nearest first, at even steps from none to the farthest.

    The part is shifted and turned about its middle, by as much as each other, in directions that
    are spread evenly (a scrambled Sobol sequence).

    Args:
        vertices: (n, 3) of the part in its own frame, m.
        pose: where it stands.
        up_to_m: no vertex is moved farther.
        count: how many.
        seed: of the sequence.
    """
    turn = rotation_from_rpy(*pose[3:])
    here = vertices @ turn.T + np.array(pose[:3])
    middle = (here.min(axis=0) + here.max(axis=0)) / 2
    size = float(np.linalg.norm(here - middle, axis=1).max()) or 1.0
    even = qmc.Sobol(6, seed=seed).random_base2(int(np.ceil(np.log2(max(count, 2)))))[:count]
    directions = norm.ppf(np.clip(even, 1e-9, 1 - 1e-9))
    found = []
    for number, direction in enumerate(directions, 1):
        wanted = up_to_m * number / count
        shift, about = direction[:3], direction[3:] / size
        scale, off = 0.0, 0.0
        for _ in range(_FITTED):
            scale = scale * wanted / off if off else wanted / float(np.linalg.norm(direction))
            more = Rotation.from_rotvec(scale * about).as_matrix()
            moved = (here - middle) @ more.T + middle + scale * shift
            off = float(np.linalg.norm(moved - here, axis=1).max())
        position = more @ (np.array(pose[:3]) - middle) + middle + scale * shift
        angles = Rotation.from_matrix(more @ turn).as_euler("xyz")
        found.append(Displaced(off, (*position.tolist(), *angles.tolist())))
    return sorted(found, key=lambda each: each.off_m)
