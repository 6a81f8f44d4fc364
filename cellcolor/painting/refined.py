"""A labelled surface refined without asking anybody what reaches the new vertices.

A new vertex lies in the middle of a mesh edge and copies one end of it: it has that end's colors,
and stands for that end in all that follows. A mesh edge between vertices that stand for the same
old vertex has no crack; any other has the crack of the old mesh edge that it stands for.
Contracting every group of vertices that stand for one old vertex gives the old mesh again, so the
topological graph of the refined surface is that of the old one (docs/painting.md).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge

__all__ = ["MOST_VERTICES", "Refined", "interpolated", "unrefined"]

MOST_VERTICES = 250_000
"""No surface is refined beyond that, so that painting it stays within the memory that is promised
(docs/painting.md has what was measured)."""


@dataclass(frozen=True)
class Refined:
    """A refinement of a labelled surface.

    Attributes:
        old: the surface that was refined.
        vertices: (n, 3) m; those of the old surface come first, in their order.
        faces: (m, 3).
        stands_for: (n,) the old vertex that each vertex stands for; itself for an old one.
        between: (n, 2) the two earlier vertices in whose middle each new vertex lies; an old one
            lies between itself and itself.
    """

    old: LabelledSurface
    vertices: Array
    faces: Index
    stands_for: Index
    between: Index

    def surface(self, deadline: Deadline = NEVER) -> LabelledSurface:
        """The refined surface, to be decomposed, saved and planned on like any other."""
        if len(self.vertices) == len(self.old.vertices):
            return self.old
        origin = self.stands_for.tolist()
        cracks = []
        for a, b in deadline.watch(_edges(self.faces).tolist()):
            if colors := self.old.cracked(origin[a], origin[b]):
                cracks.append(Crack(a, b, tuple(colors)))
        given_up = set(self.old.given_up)
        return LabelledSurface(
            name=self.old.name,
            colors=self.old.colors,
            vertices=self.vertices,
            faces=self.faces,
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
            OutOfTime: the deadline came first.
            TooLarge: there would be more than ``MOST_VERTICES``.
        """
        edges = _edges(self.faces)
        parted = edges[roomy[edges].any(axis=1)]
        needed = len(self.vertices) + len(parted)
        if needed > MOST_VERTICES:
            most = f"at most {MOST_VERTICES:,} are made"
            raise TooLarge(f"the painting would need {needed:,} vertices, {most}")
        copied = np.where(roomy[parted[:, 0]], parted[:, 0], parted[:, 1])
        first = len(self.vertices)
        middle = {
            (a, b): first + number for number, (a, b) in enumerate(map(tuple, parted.tolist()))
        }
        faces: list[tuple[int, int, int]] = []
        for a, b, c in deadline.watch(self.faces.tolist()):
            faces += _parted_face((a, b, c), middle)
        places = (self.vertices[parted[:, 0]] + self.vertices[parted[:, 1]]) / 2
        return Refined(
            self.old,
            np.concatenate([self.vertices, places]),
            np.array(faces, dtype=np.int64),
            np.concatenate([self.stands_for, self.stands_for[copied]]),
            np.concatenate([self.between, parted]),
        )


def unrefined(surface: LabelledSurface) -> Refined:
    """The surface as it is."""
    same = np.arange(len(surface.vertices))
    return Refined(surface, surface.vertices, surface.faces, same, np.stack([same, same], axis=1))


def interpolated(between: Index, values: Array) -> Array:
    """Values (m, ...) of the old vertices carried over to all (n, ...), halfway to new vertices.

    Args:
        between: (n, 2) of a refinement of m vertices, see :attr:`Refined.between`.
        values: one row for each old vertex.
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


def _edges(faces: Index) -> Index:
    """All mesh edges, (k, 2), the smaller vertex first."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def _parted_face(
    face: tuple[int, int, int], middle: dict[tuple[int, int], int]
) -> list[tuple[int, int, int]]:
    """One triangle parted so that its neighbors, parted in the same way, fit."""
    found = [
        middle.get((min(p, q), max(p, q))) for p, q in zip(face, face[1:] + face[:1], strict=True)
    ]
    count = sum(m is not None for m in found)
    if count == 0:
        return [face]
    # Turned so that the first side is parted and, of two, the second as well.
    turn = next(
        k for k in range(3) if found[k] is not None and (count != 2 or found[k - 2] is not None)
    )
    a, b, c = face[turn:] + face[:turn]
    ab, bc, ca = found[turn:] + found[:turn]
    assert ab is not None
    if bc is None:
        return [(a, ab, c), (ab, b, c)]
    if ca is None:
        return [(ab, b, bc), (a, ab, bc), (a, bc, c)]
    return [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
