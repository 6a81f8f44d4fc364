"""Calls of gpytoolbox, which take a process of their own (:func:`cellcolor.processes.run_alone`).

The library is compiled, cannot be interrupted and crashes on some meshes; a process can be ended.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index

_ITERATIONS = 10


def remesh(vertices: Array, faces: Index, length: float, kept: Index) -> tuple[Array, Index]:
    """A mesh with edges of about a length; the edges ``kept`` (k, 2) stay."""
    from gpytoolbox import remesh_botsch

    points, corners = remesh_botsch(
        vertices, faces.astype(np.int32), _ITERATIONS, length, True,
        feature_edges=kept.astype(np.int32),
    )  # fmt: skip
    return points, corners.astype(np.int64)


def distances(points: Array, corners: Index, vertices: Array, faces: Index) -> list[float]:
    """Distances of one mesh from another one and back: greatest, mean, greatest back, mean back.

    They are measured at vertices and middles of faces.
    """
    from gpytoolbox import squared_distance

    def apart(points: Array, corners: Index, vertices: Array, faces: Index) -> list[float]:
        asked = np.concatenate([points, points[corners].mean(axis=1)])
        squared, _, _ = squared_distance(
            asked, vertices, faces.astype(np.int32), use_cpp=True, use_aabb=True
        )
        distance = np.sqrt(np.maximum(squared, 0.0))
        return [float(distance.max()), float(distance.mean())]

    return [*apart(points, corners, vertices, faces), *apart(vertices, faces, points, corners)]
