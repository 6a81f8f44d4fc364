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

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.checker.dart_lists import WholeSubCell, whole_subcells
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.solution import CellDivision
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Curve, Step
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
        return replace(
            self.old,
            vertices=self.mesh.points,
            faces=self.mesh.corners,
            vertex_colors=tuple([self.old.vertex_colors[vertex] for vertex in origin]),
            cracks=tuple(cracks),
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


def subcells_on_surface(cell: CellDivision, seams: set[int]) -> list[WholeSubCell]:
    """The sub-cells of a cell that cross an edge of it; if none does, one of them.

    The cell's loops are merged into one cyclic list by seams, which are given by their ids.
    """
    whole = whole_subcells(cell, seams)
    return [subcell for subcell in whole if subcell.strands] or whole[:1]


def steps_by_edge(
    refined: Refined, old_curves: Mapping[int, Curve], curves: Iterable[Curve]
) -> dict[int, list[Step]]:
    """The steps of each topological edge on the refined mesh, its left cell on their left.

    Args:
        old_curves: the edges on the surface that was refined, by their ids.
        curves: the edges on the refined surface, in any order and direction.
    """
    dart_of: dict[Step, int] = {}
    for edge, curve in old_curves.items():
        for a, b in curve:
            dart_of[a, b] = edge
            dart_of.setdefault((b, a), -edge)
    count, old_count = len(refined.mesh.points), len(refined.old.vertices)
    origin = refined.stands_for.tolist()
    found: dict[int, list[Step]] = {}
    for curve in curves:
        # Vertices beyond the last close the holes of the mesh, in the same order on both.
        a, b = (origin[v] if v < count else v - count + old_count for v in curve[0])
        dart = dart_of[a, b]
        found[abs(dart)] = list(curve) if dart > 0 else [(b, a) for a, b in reversed(curve)]
    return found


def choose_gates(
    subcells: Sequence[Sequence[WholeSubCell]], divided: set[int], steps: dict[int, list[Step]]
) -> tuple[dict[Strand, int], list[int]]:
    """The gate of each dart in state 1 of a divided cell.

    The strands in use share an edge evenly, and the two darts of a strand get the two ends of one
    mesh edge.

    Args:
        subcells: those of each cell.
        divided: the cells with several.
        steps: of each topological edge, in order.

    Returns:
        The gates, and the edges that cross fewer mesh edges than they have strands in use, which
        get none.
    """
    used: dict[int, set[int]] = {}
    for cell in sorted(divided):
        for subcell in subcells[cell]:
            for dart, strand in subcell.strands:
                used.setdefault(abs(dart), set()).add(strand)
    gates: dict[Strand, int] = {}
    short = []
    for edge, numbers in used.items():
        along = steps[edge]
        if len(numbers) > len(along):
            short.append(edge)
            continue
        places = (2 * np.arange(len(numbers)) + 1) * len(along) // (2 * len(numbers))
        for strand, place in zip(sorted(numbers), places.tolist(), strict=True):
            gates[edge, strand], gates[-edge, strand] = along[place]
    return gates, short
