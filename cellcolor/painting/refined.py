"""A labelled surface refined without asking anybody what reaches the new vertices.

A new vertex lies in the middle of a mesh edge and copies one end of it: it has that end's colors,
and stands for that end in all that follows. A mesh edge between vertices that stand for the same
old vertex has no crack; any other has the crack of the old mesh edge that it stands for.
Contracting every **group** of vertices that stand for one old vertex gives the old mesh again with
the same cracks, so the topological graph of the refined surface is that of the old one. Consider
one step:

1. Each group is connected and has no hole. It is the old vertex v and middles of mesh edges at v,
   each a neighbor of v; two of them that are neighbors lie in one old triangle at v. So it is a fan
   around v.
2. Each old triangle keeps its corner. Let every vertex of an old triangle bear the name of the end
   that it stands for. Along each side the names change once, so by Sperner's lemma the number of
   new triangles with three names is odd. Two new triangles at the two ends of one side cannot both
   have three, so there is exactly one. The mesh edges between two groups are crossed by one path,
   from the change on the side to that triangle; a second one would be closed, and part a group.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.mesh.dividing import halved
from cellcolor.mesh.triangle_mesh import TriangleMesh

MOST_VERTICES = 250_000
"""No surface is refined beyond that, so that painting it stays within the memory that is promised.
One that grew from 11,664 to 190,761 vertices took 22 s and 970 MB, and moving its borders 40 s and
1.4 GB in all."""


@dataclass(frozen=True)
class Refined:
    """A refinement of a labelled surface.

    Attributes:
        old: the surface that was refined.
        mesh: n points in m, those of the old surface first, in their order.
        stands_for: (n,) the old vertex that each vertex stands for; itself for an old one.
        between: (n, 2) the two earlier vertices in whose middle each new vertex lies; an old one
            lies between itself and itself.
    """

    old: LabelledSurface
    mesh: TriangleMesh
    stands_for: Index
    between: Index

    def surface(self, deadline: Deadline = NEVER) -> LabelledSurface:
        """The refined surface, to be decomposed, saved and planned on like any other."""
        if len(self.mesh.points) == len(self.old.vertices):
            return self.old
        origin = self.stands_for.tolist()
        cracks = []
        for a, b in deadline.watch(self.mesh.edges.tolist()):
            if colors := self.old.cracked(origin[a], origin[b]):
                cracks.append(Crack(a, b, tuple(colors)))
        given_up = set(self.old.given_up)
        return LabelledSurface(
            name=self.old.name,
            colors=self.old.colors,
            vertices=self.mesh.points,
            faces=self.mesh.corners,
            vertex_colors=tuple([self.old.vertex_colors[vertex] for vertex in origin]),
            cracks=tuple(cracks),
            meta=self.old.meta,
            given_up=tuple([v for v, vertex in enumerate(origin) if vertex in given_up]),
        )

    def halved(self, roomy: Mask, deadline: Deadline = NEVER) -> Refined:
        """Every mesh edge with an end in ``roomy`` (n,) parted in the middle.

        The new vertex copies an end that is in ``roomy``, so what was marked gets wider: where
        there was a single vertex there is one with a neighbor in every direction.

        Raises:
            TooLarge: there would be more than ``MOST_VERTICES``.
        """
        marked = np.asarray(roomy[self.mesh.edges].any(axis=1))
        parted = self.mesh.edges[marked]
        needed = len(self.mesh.points) + len(parted)
        if needed > MOST_VERTICES:
            most = f"at most {MOST_VERTICES:,} are made"
            raise TooLarge(f"the painting would need {needed:,} vertices, {most}")
        deadline.check()
        copied = np.where(roomy[parted[:, 0]], parted[:, 0], parted[:, 1])
        finer, of = halved(self.mesh, marked)
        # Triangles stay in their order, each with its pieces where it was.
        corners = finer.corners[np.argsort(of, kind="stable")]
        return Refined(
            self.old,
            TriangleMesh(finer.points, corners),
            np.concatenate([self.stands_for, self.stands_for[copied]]),
            np.concatenate([self.between, parted]),
        )


def unrefined(surface: LabelledSurface) -> Refined:
    """The surface as it is."""
    same = np.arange(len(surface.vertices))
    return Refined(surface, surface.mesh, same, np.stack([same, same], axis=1))


def interpolated(between: Index, values: Array) -> Array:
    """Values (m, ...) of the old vertices carried over to all (n, ...), halfway to new vertices.

    ``between`` (n, 2) is that of a refinement of m vertices, see :attr:`Refined.between`.
    """
    found = np.empty((len(between), *values.shape[1:]))
    first = len(values)
    found[:first] = values
    while first < len(between):
        # The next ones that lie between vertices that have their values by now.
        later = (between[first:] >= first).any(axis=1)
        last = first + int(later.argmax()) if later.any() else len(between)
        found[first:last] = found[between[first:last]].mean(axis=1)
        first = last
    return found
