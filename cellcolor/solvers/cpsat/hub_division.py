"""A division in which hubs are divided just as the bound counts their links (docs/routes.md).

1. Each hub's darts are put into groups with many links (``hub_groups``).
2. Seams between a hub's loops are led through the areas of its groups (``hub_seams``).
3. All other cells are painted whole.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from cellcolor.data.cells_and_edges import Strand, twin
from cellcolor.data.solution import Seam
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.hubs import joinable_colors, links_bound
from cellcolor.solvers.cpsat.hub_groups import many_links
from cellcolor.solvers.cpsat.hub_seams import Area, lead_seams
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
        hubs: no two of which share a live edge; the links of each are limited.
        whole: a color for each other cell. One with a single dart takes that of the hub's group.
        seed: of the attempts where hubs have several loops.
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
                    painting[beyond][0].darts.add(graph.number_of[twin(strand)])
                block.darts.add(graph.number_of[strand])
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
