"""Which way the faces of a mesh wind: made the same, and outward where that can be known."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Index, Mask
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped

__all__ = ["against_the_others", "inside_out", "turned"]


def against_the_others(mesh: TriangleMesh) -> tuple[Mask, Mask]:
    """The faces (m,) to be turned so that all neighbors wind alike, and those of one-sided parts.

    Neighbors are two faces with an edge that no other has. Of each part the fewer are turned. A
    part is one-sided, as a Moebius strip is, if no turning makes its neighbors wind alike.
    """
    count, ascending = len(mesh.corners), mesh.ascending.ravel()
    _, sides = mesh.pairs
    first, second = sides[:, 0] // 3, sides[:, 1] // 3
    alike = ascending[sides[:, 0]] != ascending[sides[:, 1]]
    # Every face is there twice, as it is (f) and turned (count + f); linked is what goes together.
    other = np.where(alike, second, second + count)
    mirrored = np.where(alike, second + count, second)
    links = np.concatenate(
        [np.column_stack([first, other]), np.column_stack([first + count, mirrored])]
    )
    group = grouped(2 * count, links)
    as_it_is, turned_over = group[:count], group[count:]
    chosen = np.minimum(as_it_is, turned_over)
    kept = as_it_is == chosen
    votes = np.bincount(chosen, np.where(kept, 1.0, -1.0), minlength=len(group))
    turn = kept ^ (votes[chosen] >= 0)
    one_sided = as_it_is == turned_over
    return turn & ~one_sided, one_sided


def inside_out(mesh: TriangleMesh) -> Mask:
    """The faces (m,) of closed parts with a negative volume; neighbors wind alike."""
    if not len(mesh.corners):
        return np.zeros(0, dtype=bool)
    part = mesh.parts()
    open_ = np.zeros(int(part.max(initial=-1)) + 1, dtype=bool)
    open_[part[(mesh.triangles_at[mesh.edge_of_side] != 2).any(axis=1)]] = True
    points = mesh.points - mesh.points.mean(axis=0)
    a, b, c = (points[mesh.corners[:, k]] for k in range(3))
    volume = np.bincount(part, np.einsum("ij,ij->i", a, np.cross(b, c)), minlength=len(open_))
    return np.asarray(((volume < 0) & ~open_)[part])


def turned(faces: Faces, which: Mask | Index) -> Faces:
    """Faces, some of them wound the other way round."""
    changed = faces.copy()
    changed[which] = changed[which][:, ::-1]
    return changed
