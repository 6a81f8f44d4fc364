"""Seams led through a drawing of groups in a cell with several loops (docs/routes.md, "Hubs").

A drawing says in which cyclic order each loop has its darts, and in which each group's area has
them. So the faces between areas and loops are known: the next dart of a loop, then the one before
it in its area, and so on. A seam runs through faces, and from one to the next across an area, by
the fewest areas. Each area is then two, with a side of one of the seam's strands each, and two
loops are one. That is a drawing again, for the next seam.
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
    widths = [drawing.lead(seam, loop) for seam, loop in zip(seams, loops[1:], strict=True)]
    return drawing.areas, widths


class _Drawing:
    """Areas and loops, of which the first grows by each seam."""

    def __init__(self, loops: Sequence[Sequence[Strand]], areas: Sequence[Area]) -> None:
        self.areas = list(areas)
        self._first = list(loops[0])
        self._others = [list(loop) for loop in loops[1:]]
        self._before: dict[Strand, Strand] = {}

    def lead(self, seam: Seam, loop: Sequence[Strand]) -> int:
        """Lead a seam to the first of the other loops; how many areas it crosses."""
        crossed = self._way(self._first[0], loop[0])
        there: list[Strand] = []
        for strand, (number, entry, leave) in enumerate(crossed, start=1):
            area = self.areas[number]
            turned = _from(area.darts, entry)
            at = turned.index(leave)
            # Who enters before one dart and leaves before another has the darts from the one to
            # the other on the right.
            self.areas[number] = Area(area.color, (*turned[at:], (seam.id, strand)))
            self.areas.append(Area(area.color, (*turned[:at], (-seam.id, strand))))
            there.append((seam.id, strand))
        back = [(-dart, strand) for dart, strand in reversed(there)]
        self._first[1:1] = [*there, *loop[1:], loop[0], *back]
        self._others.remove(list(loop))
        return len(crossed)

    def _way(self, start: Strand, goal: Strand) -> list[tuple[int, Strand, Strand]]:
        """The fewest areas from the corner after one dart to that after another, in order.

        Of each its number, and the darts before which it is entered and left. Where no way leads,
        the two are in different parts of the drawing. Either can be put into a face of the other,
        so that they face each other, and no area is crossed.
        """
        face_of, entries = self._faces()
        area_of = {dart: number for number, area in enumerate(self.areas) for dart in area.darts}
        came: dict[int, tuple[int, tuple[int, Strand, Strand]] | None] = {face_of[start]: None}
        queue = [face_of[start]]
        for face in queue:
            for entry in entries[face]:
                number = area_of[entry]
                for leave in self.areas[number].darts:
                    beyond = face_of[self._before[leave]]
                    if beyond not in came:
                        came[beyond] = face, (number, entry, leave)
                        queue.append(beyond)
        way = []
        step = came.get(face_of[goal])
        while step is not None:
            way.append(step[1])
            step = came[step[0]]
        return way[::-1]

    def _faces(self) -> tuple[dict[Strand, int], list[list[Strand]]]:
        """The face at the corner after each dart; of each face the darts before which it is."""
        after = {
            dart: following
            for loop in (self._first, *self._others)
            for dart, following in zip(loop, [*loop[1:], loop[0]], strict=True)
        }
        self._before = {following: dart for dart, following in after.items()}
        beside = {
            dart: area.darts[place - 1]
            for area in self.areas
            for place, dart in enumerate(area.darts)
        }
        face_of: dict[Strand, int] = {}
        entries: list[list[Strand]] = []
        for first in after:
            if first in face_of:
                continue
            entries.append([])
            dart = first
            while dart not in face_of:
                face_of[dart] = len(entries) - 1
                entries[-1].append(after[dart])
                dart = beside[after[dart]]
        return face_of, entries


def _from(darts: Sequence[Strand], first: Strand) -> tuple[Strand, ...]:
    at = darts.index(first)
    return (*darts[at:], *darts[:at])
