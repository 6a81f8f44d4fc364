"""A division in which hubs are divided just as the bound counts their links (docs/routes.md).

1. **Groups with many links.** A hub with one loop has the best grouping of ``bounds/hubs``. Several
   loops are merged to one first. Let a group have dart a on one loop and dart b on another. A cut
   from a to b within the group's area makes one loop of the two, in which a and b stand together
   in two places: where the walk along the one loop goes over to the other, and where it comes back.
   No more is needed to know where a cut runs, because all cells with so many loops look alike after
   it. So loops are merged by random pairs of darts of one color.
2. **Seams led through the groups.** The groups are a drawing: it says in which cyclic order each
   loop and each group's area has its darts. So the faces between areas and loops are known: the
   next dart of a loop, then the one before it in its area, and so on. A seam runs through faces,
   and from one to the next across an area, by the fewest areas. Each area is then two, with a side
   of one of the seam's strands each, and two loops are one. That is a drawing again.
3. **All other cells are painted whole.**
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice, product
from typing import NamedTuple

from cellcolor.data.cells_and_edges import Strand, twin
from cellcolor.data.solution import Seam
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.hubs import (
    Group,
    Grouping,
    best_grouping,
    joinable_colors,
    links_bound,
)
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.solvers.cpsat.parts import ConnectedPart


def divide_hubs(
    part: ConnectedPart,
    hubs: Iterable[int],
    whole: Mapping[int, int],
    seed: int,
    deadline: Deadline,
) -> tuple[DartGraph, Painting]:
    """Divide hubs into groups of darts with many links, and paint all other cells whole.

    Args:
        part: the cells.
        hubs: no two of which share a live edge; the links of each are limited.
        whole: a color for each other cell. One with a single dart takes that of the hub's group.
        seed: of what is tried where hubs have several loops.
        deadline: when to give up.

    Raises:
        OutOfTime: the deadline came first.
    """
    instance = part.instance
    color_of = dict(whole)
    areas: dict[int, list[Area]] = {}
    seams = {seam.id: seam for seam in part.seams}
    for hub in hubs:
        areas[hub], own = _divided(part, hub, seed, deadline)
        seams |= {seam.id: seam for seam in own}
        for area in areas[hub]:
            edges = (dart for dart, _ in area.darts if abs(dart) not in seams)
            for beyond in map(instance.across, edges):
                if sum(map(len, instance.live_loops[beyond])) == 1:
                    color_of[beyond] = area.color
    graph = dart_graph(
        instance,
        [frozenset(cell.colors) for cell in instance.cells],
        dict.fromkeys(instance.live_edges, 1),
        tuple(seams.values()),
        part.loops,
    )
    index = {dart.name: number for number, dart in enumerate(graph.darts)}
    painting = [
        [] if cell in areas else [Block(color_of[cell], set())]
        for cell in range(len(instance.cells))
    ]
    for hub, own_areas in areas.items():
        for area in own_areas:
            block = Block(area.color, set())
            for strand in area.darts:
                if abs(strand[0]) not in seams:
                    beyond = instance.across(strand[0])
                    if color_of[beyond] != area.color:
                        continue
                    painting[beyond][0].darts.add(index[twin(strand)])
                block.darts.add(index[strand])
            if block.darts:
                painting[hub].append(block)
        painting[hub] = painting[hub] or [Block(own_areas[0].color, set())]
    return graph, painting


def _divided(
    part: ConnectedPart, hub: int, seed: int, deadline: Deadline
) -> tuple[list[Area], list[Seam]]:
    """The areas of a hub with two darts and more, and its seams as wide as these need them."""
    colors = joinable_colors(part.instance, hub)
    enough = links_bound(colors, deadline)
    assert enough is not None  # or it would be no hub
    grouping = many_links(colors, enough, seed, deadline)
    live = [dart for loop in part.instance.live_loops[hub] for dart in loop]
    areas = [
        Area(group.color, tuple((live[place], 1) for place in group.darts))
        for group in grouping.groups
    ]
    loops: list[list[Strand]] = [[(dart, 1) for dart in loop] for loop in part.loops[hub]]
    drawn = {dart for area in areas for dart in area.darts}
    # What is dead here still lies on its loop, where a seam may begin or end.
    areas += [Area(0, (dart,)) for loop in loops for dart in loop if dart not in drawn]
    seams = [seam for seam in part.seams if seam.cell == hub]
    areas, widths = lead_seams(loops, areas, seams)
    return (
        [area for area in areas if len(area.darts) > 1] or areas[:1],
        [replace(seam, strands=width) for seam, width in zip(seams, widths, strict=True)],
    )


CANDIDATES = 12
"""Pairs of darts that are tried for each merger."""

EFFORT = 600
"""Darts in all attempts together. For most hubs the first one is enough."""


class _Merger(NamedTuple):
    """Two darts or places that a cut connects, and the places where they stand together.

    Attributes:
        near: on the one loop.
        far: on the other.
        there: the place where the walk goes from the one loop to the other.
        back: the place where it comes back.
    """

    near: int
    far: int
    there: int
    back: int


def many_links(
    loops: Sequence[Sequence[frozenset[int]]], enough: int, seed: int, deadline: Deadline
) -> Grouping:
    """The grouping with the most links that a few random mergers lead to.

    Args:
        loops: the colors that each dart can be joined in, loop by loop, in cyclic order.
        enough: no more links are looked for.
        seed: of the mergers.
        deadline: when to be content with the best so far.

    Raises:
        OutOfTime: the deadline came before the first attempt ended.
    """
    rng = random.Random(seed)
    best = _Merging(loops, rng, deadline).run()
    with suppress(OutOfTime):
        for _ in range(EFFORT // sum(map(len, loops)) if len(loops) > 1 else 0):
            if best.links >= enough:
                break
            best = max(best, _Merging(loops, rng, deadline).run(), key=lambda found: found.links)
    return best


class _Loop(NamedTuple):
    """A loop of the cell, or what several were merged to.

    Attributes:
        elements: darts, and both places of each merger, in cyclic order.
        mergers: by which it came about, the last one last.
    """

    elements: list[int]
    mergers: list[_Merger]


class _Merging:
    """One attempt."""

    def __init__(
        self, loops: Sequence[Sequence[frozenset[int]]], rng: random.Random, deadline: Deadline
    ) -> None:
        self._rng = rng
        self._deadline = deadline
        self._colors = [own for loop in loops for own in loop]
        darts = iter(range(len(self._colors)))
        self._loops = [_Loop(list(islice(darts, len(loop))), []) for loop in loops]

    def run(self) -> Grouping:
        """Merge loops as long as any two have a color in common; the best grouping after that."""
        self._rng.shuffle(self._loops)
        found: list[Group] = []
        while self._loops:
            loop = self._loops.pop()
            for number in self._rng.sample(range(len(self._loops)), len(self._loops)):
                longer = self._merged(loop, self._loops[number])
                if longer is not None:
                    # It comes last, so that the other loops join it one by one.
                    self._loops[number : number + 1] = []
                    self._loops.append(longer)
                    break
            else:
                found += self._best(loop).groups
        return Grouping(tuple(found))

    def _merged(self, loop: _Loop, other: _Loop) -> _Loop | None:
        """Two loops made one by some pair of darts; None if none have a color in common."""
        pairs = [
            (near, far)
            for near, far in product(range(len(loop.elements)), range(len(other.elements)))
            if not self._colors[loop.elements[near]].isdisjoint(self._colors[other.elements[far]])
        ]
        there, back = len(self._colors), len(self._colors) + 1
        most, best, its_color = -1, None, frozenset[int]()
        for near, far in self._rng.sample(pairs, min(CANDIDATES, len(pairs))):
            merger = _Merger(loop.elements[near], other.elements[far], there, back)
            shared = self._colors[merger.near] & self._colors[merger.far]
            color = frozenset({self._rng.choice(sorted(shared))})
            self._colors[there:] = [color, color]
            tried = _Loop(
                [there, *_after(other.elements, far), back, *_after(loop.elements, near)],
                [*other.mergers, *loop.mergers, merger],
            )
            links = self._best(tried).links
            if links > most:
                most, best, its_color = links, tried, color
        if best is not None:
            self._colors[there:] = [its_color, its_color]
        return best

    def _best(self, loop: _Loop) -> Grouping:
        """A grouping of the darts on a loop in which the last merger's group is no ring."""
        colors = [self._colors[element] for element in loop.elements]
        apart = loop.elements.index(loop.mergers[-1].back) if loop.mergers else None
        groups: dict[int, Group] = {}
        for group in best_grouping(colors, apart, self._deadline).groups:
            own = Group(group.color, tuple(loop.elements[place] for place in group.darts))
            groups |= dict.fromkeys(own.darts, own)
        for merger in reversed(loop.mergers):
            _glue(merger, groups)
        return Grouping(tuple(dict.fromkeys(groups.values())))


def _after(loop: Sequence[int], place: int) -> list[int]:
    """The other elements of a cyclic list, from the next one on."""
    return [*loop[place + 1 :], *loop[:place]]


def _glue(merger: _Merger, groups: dict[int, Group]) -> None:
    """Put two groups together along a cut; ``groups`` has the group of each element.

    In the order of the area's border come the near dart, what the group at the way back has, the
    far dart, and what the group at the way there has. Two groups that are one already are a ring
    round one of the loops. Opened somewhere it is two groups, and there is one link less.
    """
    there, back = groups.pop(merger.there), groups.pop(merger.back)
    at = there.darts.index(merger.there)
    after_there = _after(there.darts, at)
    if there is back:
        at = after_there.index(merger.back)
        after_there, after_back = after_there[:at], after_there[at + 1 :]
    else:
        at = back.darts.index(merger.back)
        after_back = _after(back.darts, at)
    whole = Group(there.color, (merger.near, *after_back, merger.far, *after_there))
    groups |= dict.fromkeys(whole.darts, whole)


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
