"""Random divisions of an instance: legal to draw, whatever they cost."""

from __future__ import annotations

import random
from collections import defaultdict
from itertools import pairwise

import networkx as nx

from cellcolor.checker.dart_lists import live_lists
from cellcolor.data.darts import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Division, Seam, SubCell


def random_seams(instance: Instance, strands: int, rng: random.Random) -> tuple[Seam, ...]:
    """Seams that connect all live loops of each cell, from random darts to random darts."""
    number = max((edge.id for edge in instance.edges), default=0)
    seams = []
    for cell in instance.cells:
        live = [loop for loop in cell.loops if any(instance.joinable(abs(d)) for d in loop)]
        for near, far in pairwise(live):
            number += 1
            seams.append(
                Seam(number, cell.id, rng.choice(near), rng.choice(far), rng.randint(0, strands))
            )
    return tuple(seams)


def random_division(
    instance: Instance, seams: tuple[Seam, ...], strands: int, rng: random.Random
) -> Division:
    """Each cell's darts in random non-crossing blocks of random colors; equal ones are joined."""
    blocks: list[list[list[Strand]]] = []
    colors: list[list[int]] = []
    favorite = rng.randrange(len(instance.colors))
    for cell, darts in zip(instance.cells, live_lists(instance, seams, strands), strict=True):
        blocks.append(_noncrossing(darts, rng))
        liked = favorite if favorite in cell.colors and rng.random() < 0.5 else None
        colors.append(
            [
                rng.choice(cell.colors) if liked is None or rng.random() < 0.5 else liked
                for _ in blocks[-1]
            ]
        )
    at = {
        strand: (cell, block)
        for cell, own in enumerate(blocks)
        for block, held in enumerate(own)
        for strand in held
    }
    virtual = {seam.id for seam in seams}
    kept: dict[tuple[int, int], list[Strand]] = defaultdict(list)
    graph: nx.Graph[tuple[int, int]] = nx.Graph()
    for (dart, strand), here in at.items():
        there = at.get((-dart, strand))
        if there is None or dart < 0:
            continue
        color = colors[here[0]][here[1]]
        allowed = abs(dart) in virtual or color in instance.joinable(abs(dart))
        if allowed and colors[there[0]][there[1]] == color:
            kept[here].append((dart, strand))
            kept[there].append((-dart, strand))
            graph.add_edge(here, there)
    segment: dict[tuple[int, int], int] = {}
    for number, parts in enumerate(nx.connected_components(graph)):
        segment |= dict.fromkeys(parts, number)
    count = len(set(segment.values()))
    cells = []
    for cell, own in zip(instance.cells, blocks, strict=True):
        held = [block for block in range(len(own)) if kept[cell.id, block]]
        if not held:
            cells.append(CellDivision(cell.id, (SubCell(rng.choice(cell.colors), (), count),)))
            count += 1
            continue
        cells.append(
            CellDivision(
                cell.id,
                tuple(
                    [
                        SubCell(
                            colors[cell.id][block],
                            tuple(
                                [
                                    dart if strands == 1 and not seams else (dart, strand)
                                    for dart, strand in kept[cell.id, block]
                                ]
                            ),
                            segment[cell.id, block],
                        )
                        for block in held
                    ]
                ),
            )
        )
    return tuple(cells)


def _noncrossing(darts: list[Strand], rng: random.Random) -> list[list[Strand]]:
    """A random non-crossing partition of a cyclic list."""
    if not darts:
        return [[]]
    blocks: list[list[Strand]] = []
    open_blocks: list[list[Strand]] = []
    for dart in darts:
        # Going back to an open block closes those that were opened after it.
        if open_blocks and rng.random() < 0.6:
            del open_blocks[rng.randrange(len(open_blocks)) + 1 :]
        else:
            open_blocks.append([])
            blocks.append(open_blocks[-1])
        open_blocks[-1].append(dart)
    return blocks
