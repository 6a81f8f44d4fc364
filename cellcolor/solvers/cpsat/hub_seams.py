"""Seams led through the areas of a hub's groups, so that a solution can write the groups down.

Loops and areas are a drawing on a sphere: each loop and each area is a point, each dart a line from
its loop to its area. The cyclic orders of the darts around loops and areas (a rotation system) say
what the faces between them are. A seam runs through faces, and from a face to the next one across
an area. It takes the way across the fewest areas (breadth-first search). Each area that it crosses
becomes two, which are joined across one strand of the seam; and two loops become one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.solution import Seam


class Area(NamedTuple):
    """The area of a group.

    Attributes:
        color: its color.
        darts: strands of edges and seams that it touches, in cyclic order, that of a loop if they
            are all on one.
    """

    color: int
    darts: tuple[Strand, ...]


def lead_seams(
    loops: Sequence[Sequence[Strand]], areas: Sequence[Area], seams: Sequence[Seam]
) -> tuple[list[Area], list[int]]:
    """The areas that seams leave, and how many strands each seam needs.

    Args:
        loops: all darts of the cell, loop by loop, in cyclic order.
        areas: the drawing; every dart is in one of them.
        seams: one to each further loop, from the first dart of the first loop to its first dart.
    """
    drawing = _Drawing(loops, areas)
    widths = [drawing.lead(seam) for seam in seams]
    return drawing.areas, widths


class _Crossing(NamedTuple):
    """Where a seam crosses an area: its number, and the darts before which it enters and leaves."""

    area: int
    entry: Strand
    leave: Strand


class _Drawing:
    """Areas and loops. Each seam adds a loop to the first one."""

    def __init__(self, loops: Sequence[Sequence[Strand]], areas: Sequence[Area]) -> None:
        self.areas = list(areas)
        self._loops = [list(loop) for loop in loops]

    def lead(self, seam: Seam) -> int:
        """Lead a seam from the first loop to the second one; how many areas it crosses."""
        first, second, *others = self._loops
        crossings = self._way(first[0], second[0])
        there: list[Strand] = []
        for strand, (number, entry, leave) in enumerate(crossings, start=1):
            area = self.areas[number]
            at = area.darts.index(entry)
            turned = (*area.darts[at:], *area.darts[:at])
            at = turned.index(leave)
            # The darts from the entry to the place where the seam leaves are on its right.
            self.areas[number] = Area(area.color, (*turned[at:], (seam.id, strand)))
            self.areas.append(Area(area.color, (*turned[:at], (-seam.id, strand))))
            there.append((seam.id, strand))
        back = [(-dart, strand) for dart, strand in reversed(there)]
        whole = [first[0], *there, *second[1:], second[0], *back, *first[1:]]
        self._loops = [whole, *others]
        return len(crossings)

    def _way(self, start: Strand, goal: Strand) -> list[_Crossing]:
        """The fewest crossings on a way from the corner after one dart to that after another.

        If no way leads there, the two corners are in different parts of the drawing. Either part
        can be put into a face of the other, so that they face each other, and no area is crossed.
        """
        before = {
            following: dart
            for loop in self._loops
            for dart, following in zip(loop, [*loop[1:], loop[0]], strict=True)
        }
        faces = self._faces()
        face_of = {before[dart]: number for number, face in enumerate(faces) for dart in face}
        area_of = {dart: number for number, area in enumerate(self.areas) for dart in area.darts}
        came: dict[int, tuple[int, _Crossing] | None] = {face_of[start]: None}
        queue = [face_of[start]]
        for face in queue:
            for entry in faces[face]:
                number = area_of[entry]
                for leave in self.areas[number].darts:
                    beyond = face_of[before[leave]]
                    if beyond not in came:
                        came[beyond] = face, _Crossing(number, entry, leave)
                        queue.append(beyond)
        way = []
        step = came.get(face_of[goal])
        while step is not None:
            way.append(step[1])
            step = came[step[0]]
        return way[::-1]

    def _faces(self) -> list[list[Strand]]:
        """For each face the darts before which it lies, on their loops.

        A walk around a face goes to the next dart of a loop, and over to the dart before it in its
        area.
        """
        after = {
            dart: following
            for loop in self._loops
            for dart, following in zip(loop, [*loop[1:], loop[0]], strict=True)
        }
        beside = {
            dart: area.darts[place - 1]
            for area in self.areas
            for place, dart in enumerate(area.darts)
        }
        faces: list[list[Strand]] = []
        seen: set[Strand] = set()
        for dart in after:
            if dart in seen:
                continue
            faces.append([])
            while dart not in seen:
                seen.add(dart)
                faces[-1].append(after[dart])
                dart = beside[after[dart]]
        return faces
