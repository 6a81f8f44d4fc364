"""A unit box as a mesh, and meshes as OBJ texts."""

from __future__ import annotations

import numpy as np

BOX = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
OUTWARD = [
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
]  # fmt: skip


def obj(vertices: object, faces: list[list[int]]) -> str:
    lines = [f"v {x} {y} {z}" for x, y, z in np.asarray(vertices).tolist()]
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]) + "\n"
