"""Which side of a part is its outside: where an open one faces, and the two sides of a shell."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask, angles_between
from cellcolor.frontend.parts.surface import Surface
from cellcolor.mesh.triangle_mesh import TriangleMesh

SHARP_RAD = 1.0
"""Between the normals of two faces: the sides of a shell end at edges from there on."""

_THIN = 0.03  # of the part's size; a side so near behind another makes a shell
_MOSTLY = 0.6  # of the area, for the part to be one
_POINTS = 100  # of the area that are looked at
_ALIKE = 0.5  # of the larger side's area, at least, has the other one


def whole_mesh(surface: Surface) -> TriangleMesh:
    """Its mesh before edges were halved."""
    return surface.mesh if surface.divided is None else surface.divided[0]


def thickness(mesh: TriangleMesh) -> float | None:
    """Of a shell, the median distance in m from one side to the other behind it; None of others."""
    size = float(np.linalg.norm(np.ptp(mesh.points, axis=0)))
    corners, inward = mesh.points[mesh.corners], -np.nan_to_num(mesh.triangle_normals)
    points, faces = spread(mesh, _POINTS)
    middles = corners.mean(axis=1)
    radii = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
    behind = np.full(_POINTS, np.inf)
    for row, (point, face) in enumerate(zip(points, faces.tolist(), strict=True)):
        near = np.linalg.norm(middles - point, axis=1) <= radii + _THIN * size
        # What lies behind has its own outside on the other side.
        rows = np.flatnonzero(near & (inward @ inward[face] < -0.5))
        behind[row] = _first_hit(point, inward[face], corners[rows])
    found = behind <= _THIN * size
    return float(np.median(behind[found])) if found.mean() >= _MOSTLY else None


def spread(mesh: TriangleMesh, count: int) -> tuple[Array, Index]:
    """Points (k, 3) all over the surface, each for as much area, and the face (k,) of each."""
    corners, areas = mesh.points[mesh.corners], mesh.areas
    wanted = (np.arange(count) + 0.5) / count * areas.sum()
    face = np.minimum(np.searchsorted(np.cumsum(areas), wanted), len(areas) - 1)
    u, v = np.random.default_rng(0).random((2, count))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    weights = np.stack([1 - u - v, u, v], axis=1)
    return np.einsum("ij,ijk->ik", weights, corners[face]), face


def _first_hit(point: Array, way: Array, triangles: Array) -> float:
    """How far it is from a point to the first of triangles (k, 3, 3), m (Moeller, Trumbore)."""
    a, b, c = triangles.transpose(1, 0, 2)
    across = np.cross(way, c - a)
    scale = np.einsum("ij,ij->i", b - a, across)
    off = point - a
    with np.errstate(divide="ignore", invalid="ignore"):
        u = np.einsum("ij,ij->i", off, across) / scale
        turned = np.cross(off, b - a)
        v = turned @ way / scale
        far = np.einsum("ij,ij->i", c - a, turned) / scale
    inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (far > 0)
    return float(far[inside].min(initial=np.inf))


def between_sharp(mesh: TriangleMesh, sharp_rad: float) -> Index:
    """The number of the piece (m,) that each face is in; sharp edges part them."""
    edges, sides = mesh.pairs
    sharp = np.zeros(len(mesh.edges), dtype=bool)
    sharp[edges] = angles_between(*(mesh.triangle_normals[s // 3] for s in sides.T)) > sharp_rad
    return mesh.parts(sharp)


def pieces(mesh: TriangleMesh) -> list[Mask]:
    """The faces (m,) between sharp edges, the piece with the largest area first."""
    part = between_sharp(mesh, SHARP_RAD)
    order = np.argsort(-np.bincount(part, mesh.areas), kind="stable")
    return [np.asarray(part == number) for number in order[:2]]


def shell_sides(mesh: TriangleMesh) -> list[Mask] | None:
    """The two sides (m,) of a shell, the larger one, its outer, first; None if they are not two."""
    found = pieces(mesh)
    if len(found) < 2 or mesh.areas[found[1]].sum() < _ALIKE * mesh.areas[found[0]].sum():
        return None
    return found


def facing(mesh: TriangleMesh, faces: Mask | slice = slice(None)) -> Array:
    """The mean of the normals (3,): of length 1 if all point alike, 0 if every way."""
    area = mesh.areas[faces].sum()
    return np.asarray(mesh.area_vectors[faces].sum(axis=0) / 2 / area)


def inner_point(mesh: TriangleMesh, faces: Mask) -> Array:
    """The middle (3,) of the largest of some faces."""
    own: Index = np.flatnonzero(faces)
    return np.asarray(mesh.points[mesh.corners[own[np.argmax(mesh.areas[own])]]].mean(axis=0))


def note_on_shell(surface: Surface) -> tuple[str, ...]:
    """A sentence if a tool has to cover both sides of something thin."""
    thick = thickness(whole_mesh(surface))
    if thick is None:
        return ()
    return (
        f"the part is a shell, {1e3 * thick:.2g} mm thick, and both its sides are to be covered: "
        "[cover] chooses one (docs/parts.md, patches)",
    )
