"""A solution painted: a color for every vertex of a surface, refined where it must be."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass

import networkx as nx
import numpy as np

from cellcolor.checker.dart_lists import Strand, strand_of, twin
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import CellDivision, Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition.borders import Borders, ClosedMesh, Step
from cellcolor.errors import CellcolorError, InputError
from cellcolor.painting.refined import Refined, unrefined
from cellcolor.painting.trees import TooNarrow, grow_trees

__all__ = ["Painted", "paint"]

_MOST_ROUNDS = 12


@dataclass(frozen=True)
class Painted:
    """A painted solution.

    Attributes:
        surface: the labelled surface, refined where it had to be; the vertices that were there
            before come first.
        plan: one color per vertex of that surface.
        segments: how many the plan has, counted by the checker on the mesh.
        vertex_segments: the segment of the solution that each vertex belongs to, None where it
            has no color.
        stands_for: the vertex of the given surface whose colors each vertex has.
    """

    surface: LabelledSurface
    plan: Plan
    segments: int
    vertex_segments: tuple[int | None, ...]
    stands_for: tuple[int, ...]


class NotPainted(CellcolorError):
    """The painting is not what the solution says: a bug of this package."""


def paint(
    surface: LabelledSurface, instance: Instance, solution: Solution, deadline: Deadline = NEVER
) -> Painted:
    """Paint every vertex of a surface in the colors of a solution.

    Args:
        surface: the labelled surface.
        instance: its topological graph, as :func:`~cellcolor.decomposition.decompose` makes it.
        solution: a valid solution of that instance, one with a division.
        deadline: when to give up.

    Returns:
        A valid plan with at most as many segments as the solution, and exactly as many if these
        are proved to be the fewest for the surface. Two segments of a solution with more than
        needed may have one color and touch; then they are one when painted.

    Raises:
        InputError: the solution has no division.
        OutOfTime: the deadline came first.
    """
    if solution.cells is None:
        raise InputError(None, "cells", "holds no division to paint")
    areas = _areas(surface, instance)
    plans = [_blocks(cell, {seam.id for seam in solution.seams}) for cell in solution.cells]
    divided = {number for number, blocks in enumerate(plans) if len(blocks) > 1}
    old = _Curves(unrefined(surface), areas)
    refined = unrefined(surface)
    for _ in range(_MOST_ROUNDS):
        deadline.check()
        curves = _Curves(refined, areas) if len(refined.vertices) > len(surface.vertices) else old
        steps = curves.by_edge(old)
        gates, short = _gates(plans, divided, steps)
        owner: dict[int, int] = {}
        narrow = set()
        for cell in sorted(divided):
            if any(strand not in gates for _, strands in plans[cell] for strand in strands):
                continue
            terminals = [[gates[strand] for strand in sorted(held)] for _, held in plans[cell]]
            own = np.flatnonzero(curves.areas == cell).tolist()
            try:
                trees = grow_trees(own, curves.mesh.third, curves.cracked, terminals)
            except TooNarrow:
                narrow.add(cell)
                continue
            owner |= {vertex: plans[cell][block][0] for vertex, block in trees.items()}
        if not narrow and not short:
            return _painted(refined, curves, plans, divided, owner, solution)
        roomy = np.isin(curves.areas, sorted(narrow))
        roomy[[vertex for edge in short for step in steps[edge] for vertex in step]] = True
        refined = refined.halved(roomy)
    raise NotPainted(f"cells {sorted(narrow)} leave no room after {_MOST_ROUNDS} refinements")


def _areas(surface: LabelledSurface, instance: Instance) -> np.ndarray:
    if instance.surface is None or instance.surface.vertex_cell is None:
        raise InputError(None, "surface", "the instance names no surface")
    return np.array(instance.surface.vertex_cell, dtype=np.int64)


def _blocks(cell: CellDivision, seams: set[int]) -> list[tuple[int, frozenset[Strand]]]:
    """The sub-cells of a cell as they are on the surface: segment and darts in state 1."""
    holder = {strand_of(n): k for k, sub in enumerate(cell.subcells) for n in sub.darts}
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(range(len(cell.subcells)))
    graph.add_edges_from(
        (k, holder[twin(s)]) for s, k in holder.items() if abs(s[0]) in seams and twin(s) in holder
    )
    blocks = []
    for parts in nx.connected_components(graph):
        strands = frozenset(
            s for k in parts for s in map(strand_of, cell.subcells[k].darts) if abs(s[0]) not in seams
        )
        blocks.append((cell.subcells[min(parts)].segment, strands))
    return [block for block in blocks if block[1]] or blocks[:1]


class _Curves:
    """The borders of the cells on one refinement."""

    def __init__(self, refined: Refined, old_areas: np.ndarray) -> None:
        self.refined = refined
        surface = refined.surface()
        self.mesh = ClosedMesh(surface)
        self.areas = old_areas[refined.stands_for]
        sets = [frozenset(c) for c in surface.vertex_colors]
        sets += [frozenset()] * (self.mesh.vertex_count - self.mesh.real_count)
        self._cracks = {(c.i, c.j): frozenset(c.colors) for c in surface.cracks}
        area = [*self.areas.tolist(), *[OUTSIDE] * (self.mesh.vertex_count - self.mesh.real_count)]
        self.curves = Borders(
            self.mesh,
            area,
            lambda a, b: (sets[a] & sets[b]) - self._cracks.get((min(a, b), max(a, b)), frozenset()),
            self.cracked,
        ).curves()

    def cracked(self, a: int, b: int) -> bool:
        return ((a, b) if a < b else (b, a)) in self._cracks

    def _old(self, step: Step) -> Step:
        """The step of the old surface that a step stands for."""
        count = self.mesh.real_count
        origin = self.refined.stands_for
        old_count = len(self.refined.old.vertices)
        a, b = (int(origin[v]) if v < count else old_count + v - count for v in step)
        return a, b

    def by_edge(self, old: _Curves) -> dict[int, list[Step]]:
        """The steps of each topological edge, in order, the edge's left cell on their left."""
        number_of: dict[Step, tuple[int, int]] = {}
        for number, curve in enumerate(old.curves, start=1):
            for place, (a, b) in enumerate(curve.steps):
                number_of[a, b] = number, place
                number_of.setdefault((b, a), (-number, place))
        found: dict[int, list[Step]] = {}
        for curve in self.curves:
            steps = list(curve.steps)
            number, _ = number_of[self._old(steps[0])]
            if number < 0:
                steps = [(b, a) for a, b in reversed(steps)]
            found[abs(number)] = steps
        return found


def _gates(
    plans: Sequence[Sequence[tuple[int, frozenset[Strand]]]],
    divided: set[int],
    steps: dict[int, list[Step]],
) -> tuple[dict[Strand, int], list[int]]:
    """The vertex beside which each dart in state 1 of a divided cell crosses its edge.

    The strands of an edge share it evenly, and both of a strand's sides use the same place. The
    edges that cross fewer mesh edges than they have strands come apart.
    """
    used: dict[int, set[int]] = {}
    for cell in divided:
        for _, strands in plans[cell]:
            for dart, strand in strands:
                used.setdefault(abs(dart), set()).add(strand)
    gates: dict[Strand, int] = {}
    short = []
    for edge, numbers in used.items():
        along = steps[edge]
        if len(numbers) > len(along):
            short.append(edge)
            continue
        for rank, strand in enumerate(sorted(numbers)):
            place = (2 * rank + 1) * len(along) // (2 * len(numbers))
            gates[edge, strand], gates[-edge, strand] = along[place]
    return gates, short


def _painted(
    refined: Refined,
    curves: _Curves,
    plans: Sequence[Sequence[tuple[int, frozenset[Strand]]]],
    divided: set[int],
    owner: dict[int, int],
    solution: Solution,
) -> Painted:
    surface = refined.surface()
    segment: list[int | None] = [None] * len(surface.vertices)
    for vertex, cell in enumerate(curves.areas.tolist()):
        if cell != OUTSIDE and cell not in divided:
            segment[vertex] = plans[cell][0][0]
    for vertex, number in _spread(refined, curves, owner).items():
        segment[vertex] = number
    color = {sub.segment: sub.color for cell in solution.cells or () for sub in cell.subcells}
    plan = Plan(tuple([None if number is None else color[number] for number in segment]))
    report = check_plan(surface, plan)
    if report.segments is None:
        raise NotPainted(f"the painting is not valid: {report.problems[0]}")
    assert solution.segments is not None
    exact = solution.proved_for_surface
    if report.segments > solution.segments or (exact and report.segments < solution.segments):
        raise NotPainted(f"painted {report.segments} segments, the solution has {solution.segments}")
    return Painted(
        surface, plan, report.segments, tuple(segment), tuple(refined.stands_for.tolist())
    )


def _spread(refined: Refined, curves: _Curves, owner: dict[int, int]) -> dict[int, int]:
    """Every vertex of the divided cells given to the tree that is nearest along the mesh."""
    around: dict[int, list[int]] = {}
    cells = set(curves.areas[list(owner)].tolist())
    area = curves.areas.tolist()
    for a, b in curves.mesh.third:
        if a < len(area) and b < len(area) and area[a] == area[b] and area[a] in cells:
            if not curves.cracked(a, b):
                around.setdefault(a, []).append(b)
    places = refined.vertices
    segment: dict[int, int] = {}
    queue = [(0.0, vertex, number) for vertex, number in sorted(owner.items())]
    heapq.heapify(queue)
    while queue:
        far, vertex, number = heapq.heappop(queue)
        if vertex in segment:
            continue
        segment[vertex] = number
        for other in around.get(vertex, ()):
            if other not in segment:
                length = float(np.linalg.norm(places[vertex] - places[other]))
                heapq.heappush(queue, (far + length, other, number))
    return segment
