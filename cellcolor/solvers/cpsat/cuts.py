"""Fewest cutting paths once the number of segments is known (docs/encodings/fewest-cuts.md)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import ceil, inf, isfinite

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model.full import (
    LARGEST_MODEL,
    SECONDS_A_TERM,
    model_size,
    not_built,
    seams_size,
)
from cellcolor.solvers.cpsat.model.loops_apart import build_apart, loops_apart, read_apart
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, moved
from cellcolor.solvers.cpsat.model.seams import Seamed, SeamWriter
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.union_find import UnionFind


class FewestCuts:
    """Among the divisions with a number of segments, one with the fewest cutting paths.

    Three models are solved until the best division meets the bound: one without seams
    that also has divisions which cannot be drawn, one with seams of the fewest sub-cells, and one
    of the divisions whose cutting paths connect no loops.

    Args:
        colors: the colors each cell may be painted in, all or some of its own.
        strands: strands of each live edge that are enough.
        written: strands of each live edge in the division that is handed out.
        segments: the fewest segments there are.

    Attributes:
        bound: no division with ``segments`` segments has fewer cutting paths.
        best: the best division so far, written with seams; None as long as no better one than the
            first was found.
        notes: what was left out and why, a sentence each.
    """

    def __init__(
        self,
        instance: Instance,
        colors: Sequence[frozenset[int]],
        strands: Mapping[int, int],
        written: Mapping[int, int],
        segments: int,
        runner: Runner,
    ) -> None:
        self._instance = instance
        self._colors = colors
        self._regions = color_regions(instance, colors)
        self._strands = strands
        self._segments = segments
        self._runner = runner
        self._writer = SeamWriter(instance, written, self._solve)
        self._holed = [cell for cell, loops in enumerate(instance.live_loops) if len(loops) > 1]
        self._cuts = 0
        self.bound = 0
        self.best: Seamed | None = None
        self.notes: list[str] = []

    def run(self, graph: DartGraph, painting: Painting) -> None:
        """Search until the bound is met or there is no time left.

        Args:
            graph: a dart graph of the instance.
            painting: a legal painting of it with the fewest segments.
        """
        self._cuts = count_cuts(self._instance, graph, painting)
        self._offer(graph, painting)
        if not self._done and self._holed:
            self._raise_bound(self._fewest_subcells((), groups=True))
        if not self._done:
            least = self._fewest_subcells(self._holed)
            self._raise_bound(least)
            if self._holed and not self._done:
                self._raise_bound(min(self._fewest_subcells(()), least + 1))

    @property
    def _done(self) -> bool:
        return self._cuts <= self.bound or self._runner.over

    def _raise_bound(self, bound: float) -> None:
        self.bound = max(self.bound, int(min(bound, self._cuts)))

    def _fewest_subcells(self, seamed: Collection[int], groups: bool = False) -> float:
        """The fewest sub-cells beyond the first of each cell.

        Args:
            seamed: cells with seams between their loops; whatever their cutting paths connect.
            groups: whether cutting paths may connect loops of the other cells. Each loop so
                connected counts like a sub-cell.

        Returns:
            A number that no such division is below; infinity if there is none.
        """
        apart = loops_apart(self._instance, set(self._holed) - set(seamed))
        colors = [self._colors[cell] for cell in apart.origin]
        seams = seams_of(apart.instance, colors, self._strands, None)
        if (size := seams_size(seams)) <= LARGEST_MODEL:
            graph = dart_graph(apart.instance, colors, self._strands, seams)
            size = model_size(graph)
        if size > LARGEST_MODEL:
            self.notes.append(not_built(size))
            return 0.0
        if size * SECONDS_A_TERM > self._runner.left:
            return 0.0
        built = build_apart(apart, graph, self._regions, self._segments, groups=groups)
        solver, status = self._solve(built.model)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._offer(graph, read_apart(apart, graph, built.variables, solver))
        if status == cp_model.INFEASIBLE:
            return inf
        # As many joins as a forest needs: sub-cells less segments.
        spare = len(self._instance.cells) - self._segments
        joins = solver.best_objective_bound if isfinite(solver.best_objective_bound) else 0.0
        return max(0.0, ceil(joins - 1e-6) - spare)

    def _offer(self, graph: DartGraph, painting: Painting) -> None:
        """Keep a painting's canonical form if it has fewer cutting paths than the best so far."""
        free = self._writer.graph
        whole = [unseamed(graph, blocks) for blocks in painting]
        settled = canonical(free, moved(graph, whole, free))
        cuts = count_cuts(self._instance, free, settled)
        if cuts < self._cuts and (seamed := self._writer.write(settled)) is not None:
            self._cuts, self.best = cuts, seamed

    def _solve(self, model: cp_model.CpModel) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = self._runner.portfolio()
        return solver, self._runner.solve(solver, model)


def count_cuts(instance: Instance, graph: DartGraph, painting: Painting) -> int:
    """The fewest curves that divide the cells into the painting's sub-cells.

    Args:
        graph: its dart graph, seams put in.
        painting: a legal painting of it.
    """
    return sum(
        _cuts_of_cell(
            cell,
            [{graph.darts[dart].name[0] for dart in block.darts} for block in unseamed(graph, own)],
        )
        for cell, own in zip(instance.cells, painting, strict=True)
    )


def unseamed(graph: DartGraph, blocks: Sequence[Block]) -> list[Block]:
    """A cell's sub-cells on the surface: seams neither divide them nor have darts."""
    seams = {seam.id for seam in graph.seams}
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    whole: UnionFind[int] = UnionFind(range(len(blocks)))
    virtual = {dart for dart in holder if abs(graph.darts[dart].name[0]) in seams}
    for dart in virtual:
        if graph.darts[dart].twin in virtual:
            whole.union(holder[dart], holder[graph.darts[dart].twin])
    return [
        Block(
            blocks[min(parts)].color,
            {dart for part in parts for dart in blocks[part].darts if dart not in virtual},
        )
        for parts in whole.sets()
    ]


def _cuts_of_cell(cell: Cell, subcells: Sequence[set[int]]) -> int:
    """Sub-cells less one, and one more for each loop that has to be joined to another.

    As long as the graph of loops and the sub-cells that meet them has a circle, its loops are put
    together, one circle after the other (docs/semantics.md, section 8).
    """
    if len(subcells) == 1:
        return 0
    import networkx as nx  # slow to import, and most instances do without

    loops: UnionFind[int] = UnionFind(range(len(cell.loops)))
    loop_of = {dart: number for number, loop in enumerate(cell.loops) for dart in loop}
    together = 0
    while True:
        meetings: nx.Graph[tuple[str, int]] = nx.Graph()
        for number, darts in enumerate(subcells):
            meetings.add_edges_from(
                (("sub-cell", number), ("loop", loops[loop_of[dart]])) for dart in darts
            )
        try:
            circle = nx.find_cycle(meetings)
        except nx.NetworkXNoCycle:
            return len(subcells) - 1 + together
        met = {number for edge in circle for kind, number in edge if kind == "loop"}
        loops.union(*met)
        together += len(met) - 1
