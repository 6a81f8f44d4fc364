"""One obstacle of each kind in the way of an arm, and the same in coal."""

from __future__ import annotations

from pathlib import Path

import coal
import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.contact.box_grid import BoxGridObstacle
from cellcolor.frontend.contact.half_space import HalfSpaceObstacle
from cellcolor.frontend.contact.obstacle import Obstacle
from cellcolor.frontend.contact.primitives import CapsuleObstacle, ConeObstacle
from cellcolor.frontend.parts.placement import rotation_from_rpy

KINDS = ("cone", "capsule", "half-space", "box-grid")


def standing(
    kind: str, place: Array, folder: Path
) -> tuple[Obstacle, list[tuple[coal.ShapeBase, coal.Transform3s]]]:
    """An obstacle about a place (3,), and coal's shapes and where they stand.

    Args:
        folder: for the file of a grid, and what its name is relative to.
    """
    where = {"position_m": tuple(place.tolist()), "rpy_rad": (0.3, -0.4, 0.5)}
    pose = coal.Transform3s(rotation_from_rpy(0.3, -0.4, 0.5), place)
    if kind == "cone":
        return ConeObstacle(radius_m=0.1, height_m=0.2, **where), [(coal.Cone(0.1, 0.2), pose)]
    if kind == "capsule":
        capsule = CapsuleObstacle(radius_m=0.04, axis_m=0.2, **where)
        return capsule, [(coal.Capsule(0.04, 0.2), pose)]
    if kind == "half-space":
        wall = {"position_m": where["position_m"], "rpy_rad": (0.0, -1.4, 0.0)}
        pose = coal.Transform3s(rotation_from_rpy(0.0, -1.4, 0.0), place)
        return HalfSpaceObstacle(**wall), [(coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0), pose)]
    cells = [(i, j, k) for i in range(4) for j in range(3) for k in range(2) if i + j + k != 2]
    (folder / "map.csv").write_text("\n".join(",".join(map(str, cell)) for cell in cells))
    grid = BoxGridObstacle(file=str(folder / "map.csv"), cell_m=0.05, **where)
    turn = rotation_from_rpy(0.3, -0.4, 0.5)
    boxes = [
        (
            coal.Box(0.05, 0.05, 0.05),
            coal.Transform3s(turn, place + turn @ (np.add(cell, 0.5) * 0.05)),
        )
        for cell in cells
    ]
    return grid, boxes
