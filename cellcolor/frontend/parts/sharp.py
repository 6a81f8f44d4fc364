"""Sharp edges of a mesh: those at which its faces turn."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.frontend.parts.surface import Faces, face_normals
from cellcolor.frontend.parts.topology import edge_table

__all__ = ["SHARP", "sharp_edges"]

SHARP = np.radians(30.0)
"""Between the normals of two faces, rad; an edge is sharp from there on."""


def sharp_edges(vertices: Array, faces: Faces, angle: float) -> Index:
    """The edges (k, 2) of two faces whose normals are farther from each other than an angle, rad.

    Which way the faces wind does not matter; a face without area has no normal.
    """
    table = edge_table(faces)
    edges, sides = table.pairs()
    normals = face_normals(vertices, faces)
    with np.errstate(invalid="ignore"):
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosine = np.einsum("ij,ij->i", normals[sides[:, 0] // 3], normals[sides[:, 1] // 3])
    forward = table.forward.ravel()
    cosine[forward[sides[:, 0]] == forward[sides[:, 1]]] *= -1
    return np.asarray(table.ends[edges[cosine < np.cos(angle)]])
