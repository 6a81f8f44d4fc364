"""Samples of a tool path: evenly spaced, at most 1 mm and 1 degree apart.

Where a joint is fast, beside a singularity, :mod:`~cellcolor.motion.courses` puts more between.

The degree is measured with the path's own normals. With those of the surface, which the samples
get, neighbors beside a sharp edge can be a little farther apart: 1.13 degrees at most on the parts
of docs/parts.md. The judge of trajectories tests between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, angles_between, to_nearest
from cellcolor.data.tool_paths import ToolPath
from cellcolor.mesh.triangle_mesh import TriangleMesh

DISTANCE = 0.001  # m, at most from one sample to the next
TURN = float(np.deg2rad(1.0))  # rad, the same for the normal
_NEAR = 0.025  # of both; so near to a corner that is asked for no other sample is needed
_ROOM = 0.95  # of both, for rounding and for normals that are not a path's own


@dataclass(frozen=True)
class Samples:
    """Points of a tool path, in its order.

    Attributes:
        points: (k, 3) m.
        normals: (k, 3) outward unit normals.
        faces: (k,) a triangle that each point lies in.
    """

    points: Array
    normals: Array
    faces: Index

    def __len__(self) -> int:
        return len(self.points)


def with_normals_of(samples: Samples, mesh: TriangleMesh, normals: Array) -> Samples:
    """The same points with the normals that a surface has there.

    Those of a path are interpolated from point to point. Where a normal turns quickly, as beside a
    sharp edge, they are a degree or more off those of the triangles.

    Args:
        samples: of a path on the surface.
        mesh: the surface's.
        normals: (n, 3) outward, at its vertices; of any length, which counts between them.
    """
    shares = mesh.shares(samples.faces, samples.points)
    turned = np.einsum("ki,kij->kj", shares, normals[mesh.corners[samples.faces]])
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    return Samples(samples.points, turned, samples.faces)


def even_places(path: ToolPath, corners: Index | None = None) -> Array:
    """Places (k,) of samples all along a path, both ends among them.

    A place is the way from the path's beginning, in shares of what samples may be apart.

    The way between neighbors is at most 1 mm long along the path, and the normal turns by at most
    1 degree on it. The larger share of the two sets an equal distance for all.
    Corners of the path are not samples, but those that are asked for: a chord cuts them by less
    than half a millimeter.

    Args:
        corners: numbers of points of the path.
    """
    passed = np.concatenate([[0.0], np.cumsum(_shares(path))])
    even = np.linspace(0.0, passed[-1], max(int(np.ceil(passed[-1])), 1) + 1)
    if corners is None or not len(corners):
        return even
    at = np.unique(passed[corners])
    needed = to_nearest(even, at) > _NEAR
    needed[[0, -1]] = True
    return np.union1d(even[needed], at)


def sampled(path: ToolPath, places: Array | None = None) -> Samples:
    """A path at places on it; without them at the even ones."""
    places = even_places(path) if places is None else places
    share = _shares(path)
    passed = np.concatenate([[0.0], np.cumsum(share)])
    step = np.clip(np.searchsorted(passed, places, side="right") - 1, 0, len(share) - 1)
    part = ((places - passed[step]) / np.where(share[step] > 0, share[step], 1.0))[:, None]
    points = (1 - part) * path.points[step] + part * path.points[step + 1]
    normals = (1 - part) * path.normals[step] + part * path.normals[step + 1]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Samples(points, normals, path.faces[step])


def _shares(path: ToolPath) -> Array:
    """The way between neighbors of a path, as a share of what samples may be apart."""
    lengths = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
    turns = angles_between(path.normals[:-1], path.normals[1:])
    # A chord between unit normals is passed fastest, as an angle, in its middle.
    fastest = 2 * np.tan(np.minimum(turns, 0.99 * np.pi) / 2)
    return np.asarray(np.maximum(lengths / DISTANCE, fastest / TURN) / _ROOM)
