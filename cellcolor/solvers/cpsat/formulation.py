"""The coloring as a CP-SAT model: which color each sector has, and where segments have their roots.

docs/formulation.md has the same in mathematics, with proofs; ``constraints`` has a function for
each group of constraints.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from ortools.sat.python import cp_model

from cellcolor.data.solution import ModelSize
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.constraints import DEFINING, REDUNDANT, add_variables
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Painting
from cellcolor.solvers.cpsat.sectors import painting_of_sectors, sector_colors, sector_graph

Pair = tuple[int, int]


@dataclass(frozen=True)
class Variables:
    """The variables of a model.

    Attributes:
        color: per sector and color: the sector has that color.
        parent: per two neighboring sectors: the second is the parent of the first.
        root: per sector and color: the sector is the root of its segment, in that color.
        rank: per sector: larger than its parent's.
    """

    color: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    parent: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    root: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    rank: list[cp_model.IntVar] = field(default_factory=list)


class SectorModel:
    """The model on the sector graph of some cells.

    Args:
        regions: the color regions of the cells.
        most_literals: for the colors of sectors; a larger model is not built.
        groups: the names of the ``REDUNDANT`` groups of constraints; None for all of them.
        deadline: of building it.

    Attributes:
        model: minimizes ``segments``.
        fewest_regions: the size of a smallest cover, where the group ``cover`` is there; else 0.
        fixed_root: for each region with a one-colored cell, the cell that has its segment's root.

    Raises:
        InputError: there is no such group.
        TooLarge: there are too many sectors.
    """

    def __init__(
        self,
        graph: DartGraph,
        regions: Sequence[Region],
        most_literals: int,
        groups: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> None:
        wanted = REDUNDANT.keys() if groups is None else groups
        if unknown := sorted(set(wanted) - REDUNDANT.keys()):
            raise InputError(None, "groups", f"there is no group {unknown[0]!r}")
        self.sectors = sector_graph(graph, None, deadline, most_literals)
        self.regions, self.deadline = regions, deadline
        self.model = cp_model.CpModel()
        self.variables = Variables()
        self.region_of = {(c, color): n for n, (color, cells) in enumerate(regions) for c in cells}
        self.fixed_root = self._fixed_roots()
        self.fewest_regions = 0
        add_variables(self, only_centers="undivided" in wanted)
        for name, group in {**DEFINING, **REDUNDANT}.items():
            if name in DEFINING or name in wanted:
                group(self)
        self.segments = sum(self.variables.root.values())
        self.model.minimize(self.segments)

    @property
    def size(self) -> ModelSize:
        """How many variables and constraints the model has."""
        return ModelSize(len(self.model.proto.variables), len(self.model.proto.constraints))

    def painting(self, solver: cp_model.CpSolver) -> Painting:
        """The division that a solver has found, on the dart graph."""
        v = self.variables
        colors = [0] * len(self.sectors.cell)
        for (sector, c), literal in v.color.items():
            if solver.boolean_value(literal):
                colors[sector] = c
        return painting_of_sectors(self.sectors, colors)

    def hint(self, painting: Painting) -> None:
        """Hint a canonical painting of the dart graph: all variables, as far as it can be drawn.

        A segment without an undivided cell gets its root wherever it begins.
        """
        model, v = self.model, self.variables
        colors = sector_colors(self.sectors, painting)
        parent, rank = self._trees(colors)
        for (sector, c), literal in v.color.items():
            if len(self.colors(sector)) > 1:
                model.add_hint(literal, colors[sector] == c)
        for (sector, c), literal in v.root.items():
            model.add_hint(literal, colors[sector] == c and sector not in parent)
        for (here, there), literal in self.deadline.watch(v.parent.items()):
            model.add_hint(literal, parent.get(here) == there)
        for sector, own in enumerate(v.rank):
            model.add_hint(own, rank[sector])

    def _trees(self, colors: Sequence[int]) -> tuple[dict[int, int], list[int]]:
        """The parent of each sector that is no root, and the rank of each."""
        sectors = self.sectors
        fixed = {(cell, self.regions[number][0]) for number, cell in self.fixed_root.items()}
        whole = [len({colors[node] for node in nodes}) == 1 for nodes in sectors.nodes]

        def order(sector: int) -> tuple[bool, bool, int]:
            cell = sectors.cell[sector]
            center = whole[cell] and sector == sectors.nodes[cell][-1]
            return not (center and (cell, colors[sector]) in fixed), not center, sector

        parent: dict[int, int] = {}
        rank = [-1] * len(colors)
        for root in sorted(range(len(colors)), key=order):
            if rank[root] >= 0:
                continue
            rank[root] = 0
            reached = [root]
            for here in reached:
                for there, joinable in self.neighbors[here].items():
                    same = colors[there] == colors[here] and colors[here] in joinable
                    if rank[there] < 0 and same:
                        parent[there], rank[there] = here, rank[here] + 1
                        reached.append(there)
        return parent, rank

    @cached_property
    def neighbors(self) -> list[dict[int, frozenset[int]]]:
        """For each sector its neighbors, with the colors in which the two can be joined."""
        found: list[dict[int, frozenset[int]]] = [{} for _ in self.sectors.cell]
        for one, other, dart in self.sectors.links:
            colors = self._joinable(one, dart)
            for here, there in ((one, other), (other, one)):
                found[here][there] = found[here].get(there, frozenset()) | colors
        return found

    def _joinable(self, sector: int, dart: int) -> frozenset[int]:
        graph = self.sectors.graph
        return graph.colors[self.sectors.cell[sector]] if dart < 0 else graph.darts[dart].colors

    @cached_property
    def apart(self) -> list[tuple[cp_model.IntVar, cp_model.IntVar | None]]:
        """Per link a literal: the two sectors are not joined across it.

        The second literal says that they have one color nevertheless, which is not joinable there;
        None where that cannot be.
        """
        return [self._apart(n) for n in self.deadline.watch(range(len(self.sectors.links)))]

    def _apart(self, number: int) -> tuple[cp_model.IntVar, cp_model.IntVar | None]:
        model, color = self.model, self.variables.color
        one, other, dart = self.sectors.links[number]
        colors = [self.colors(sector) for sector in (one, other)]
        joinable, shared = self._joinable(one, dart), colors[0] & colors[1]
        if len(colors[0]) == len(colors[1]) == 1:
            return self.false, None
        apart = model.new_bool_var(f"apart[{number}]")
        for here, there, own in ((one, other, colors[0]), (other, one, colors[1])):
            for c in sorted(own):
                same = [color[there, c]] if c in joinable else []
                model.add_bool_or([apart, ~color[here, c], *same])
        for c in sorted(joinable):
            model.add_bool_or([~apart, ~color[one, c], ~color[other, c]])
        if shared == joinable:
            return apart, None
        alike = model.new_bool_var(f"alike[{number}]")
        model.add_implication(alike, apart)
        for c in sorted(shared - joinable):
            model.add_bool_or([~color[one, c], ~color[other, c], alike])
        return apart, alike

    @cached_property
    def surplus(self) -> dict[int, cp_model.IntVar]:
        """By face how many border lines meet there besides two, or 0 where none do."""
        sides, count = self.sectors.faces
        around: list[list[int]] = [[] for _ in range(count)]
        for link, faces in enumerate(sides):
            for face in faces:
                around[face].append(link)
        found = {}
        for face, links in enumerate(self.deadline.watch(around)):
            alike = [own for link in links if (own := self.apart[link][1]) is not None]
            if len(links) > 2 or alike:
                least, most = -len(alike), max(0, len(links) - 2)
                found[face] = self.model.new_int_var(least, most, f"surplus[{face}]")
                self.model.add(found[face] >= sum(self.apart[link][0] for link in links) - 2)
                # A single line ends where a color stops being joinable.
                self.model.add(found[face] >= -sum(alike))
        return found

    @cached_property
    def used(self) -> list[cp_model.IntVar]:
        """By region whether it is in use."""
        return [self.model.new_bool_var(f"used[{n}]") for n in range(len(self.regions))]

    @cached_property
    def link_at(self) -> dict[int, int]:
        """The link across each dart."""
        found = {}
        for number, (_, _, dart) in enumerate(self.sectors.links):
            if dart >= 0:
                found[dart] = found[self.sectors.graph.darts[dart].twin] = number
        return found

    @cached_property
    def ring_of(self) -> dict[int, list[int]]:
        """The links along the outer ring of each cell with rings, from each dart to the next."""
        found: dict[int, list[int]] = {}
        for number, (one, _, dart) in enumerate(self.sectors.links):
            cell = self.sectors.cell[one]
            if dart < 0 and len(found.get(cell, ())) < len(self.sectors.graph.lists[cell]):
                found.setdefault(cell, []).append(number)
        return found

    def colors(self, sector: int) -> frozenset[int]:
        """The colors of a sector's cell."""
        return self.sectors.graph.colors[self.sectors.cell[sector]]

    @cached_property
    def true(self) -> cp_model.IntVar:
        """A literal that is true."""
        return self.model.new_constant(1)

    @cached_property
    def false(self) -> cp_model.IntVar:
        """A literal that is false."""
        return self.model.new_constant(0)

    def _fixed_roots(self) -> dict[int, int]:
        """For each region that has a one-colored cell, one such cell: its segment's root."""
        graph = self.sectors.graph
        found: dict[int, int] = {}
        for number, (_, cells) in enumerate(self.regions):
            if own := [cell for cell in sorted(cells) if len(graph.colors[cell]) == 1]:
                found[number] = max(own, key=lambda cell: len(graph.lists[cell]))
        return found
