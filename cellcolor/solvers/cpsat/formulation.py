"""The coloring as a CP-SAT model: which color each sector has, and where segments have their roots.

docs/formulation.md has the same in mathematics, with proofs. The numbers of constraints are those
of that page. Each function below adds one group of constraints. ``DEFINING`` groups make the model
correct and complete; every other group may be left out, and the minimum stays the same.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from ortools.sat.python import cp_model

from cellcolor.data.solution import ModelSize
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, TooLarge
from cellcolor.solvers.bounds.cover import Region, smallest_cover
from cellcolor.solvers.bounds.grouping import best_grouping
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.drawing import sector_colors
from cellcolor.solvers.cpsat.painting import Painting
from cellcolor.solvers.cpsat.sectors import painting_of_sectors, sector_graph
from cellcolor.union_find import UnionFind

MOST_LITERALS = 100_000
"""The most literals for the colors of sectors; the model has about 25 times as many constraints."""

Pair = tuple[int, int]


@dataclass(frozen=True)
class Variables:
    """The variables of a model, by sector, color and link of the sector graph.

    Attributes:
        color: per sector and color: the sector has that color.
        parent: per two neighboring sectors: the second is the parent of the first.
        root: per sector and color: the sector is the root of its segment, in that color.
        rank: per sector: larger than its parent's.
        attached: per leaf dart's sector and host: the one is attached to the other.
    """

    color: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    parent: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    root: dict[Pair, cp_model.IntVar] = field(default_factory=dict)
    rank: list[cp_model.IntVar] = field(default_factory=list)
    attached: dict[Pair, cp_model.IntVar] = field(default_factory=dict)


class Formulation:
    """The model on the sector graph of some cells.

    Args:
        graph: the darts of the cells, leaf darts apart.
        regions: the color regions of the cells.
        groups: the names of the ``REDUNDANT`` groups of constraints; None for all of them.
        deadline: of building it.

    Attributes:
        model: the model; it minimizes the number of segments.
        variables: its variables.
        sectors: the sector graph.
        regions: the color regions.
        segments: the objective.
        fewest_regions: the size of a smallest cover, where the group ``cover`` is there; else 0.
        fixed_root: for each region with a one-colored cell, the cell that has its segment's root.

    Raises:
        InputError: there is no such group.
        TooLarge: there are too many sectors.
        OutOfTime: the deadline came first.
    """

    def __init__(
        self,
        graph: DartGraph,
        regions: Sequence[Region],
        groups: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> None:
        wanted = REDUNDANT.keys() if groups is None else groups
        if unknown := sorted(set(wanted) - REDUNDANT.keys()):
            raise InputError(None, "groups", f"there is no group {unknown[0]!r}")
        self.sectors, self.regions = sector_graph(graph, deadline=deadline), regions
        literals = sum(len(self.colors(sector)) for sector in range(len(self.sectors.cell)))
        if literals > MOST_LITERALS:
            message = f"{literals} literals for the colors of sectors, {MOST_LITERALS} are the most"
            raise TooLarge(f"The model was not built: it would need {message}.")
        self.model = cp_model.CpModel()
        self.variables = Variables()
        self.region_of = {(c, color): n for n, (color, cells) in enumerate(regions) for c in cells}
        self.fixed_root = self._fixed_roots()
        self.fewest_regions = 0
        _add_variables(self, only_centers="undivided" in wanted)
        for name, group in {**DEFINING, **REDUNDANT}.items():
            if name in DEFINING or name in wanted:
                deadline.check()
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
        attached = {leaf: h for (leaf, h), own in v.attached.items() if solver.boolean_value(own)}
        return painting_of_sectors(self.sectors, colors, attached)

    def hint(self, painting: Painting) -> None:
        """Hint a canonical painting of the dart graph: all variables, as far as it can be drawn.

        A segment without an undivided cell gets its root wherever it begins.
        """
        model, v = self.model, self.variables
        colors, attached = sector_colors(self.sectors, painting)
        parent, rank = self._trees(colors, attached)
        for (sector, c), literal in v.color.items():
            if len(self.colors(sector)) > 1:
                model.add_hint(literal, colors[sector] == c)
        for (sector, c), literal in v.root.items():
            model.add_hint(literal, colors[sector] == c and sector not in parent)
        for (here, there), literal in v.parent.items():
            model.add_hint(literal, parent.get(here) == there)
        for sector, own in enumerate(v.rank):
            model.add_hint(own, rank[sector])
        for (leaf, host), literal in v.attached.items():
            model.add_hint(literal, attached.get(leaf) == host)

    def _trees(
        self, colors: Sequence[int], attached: Mapping[int, int]
    ) -> tuple[dict[int, int], list[int]]:
        """The parent of each sector that is no root, and the rank of each."""
        sectors = self.sectors
        fixed = {(cell, self.regions[number][0]) for number, cell in self.fixed_root.items()}

        def order(sector: int) -> tuple[bool, bool, int]:
            cell = sectors.cell[sector]
            whole = len({colors[node] for node in sectors.nodes[cell]}) == 1
            center = whole and sector == sectors.center(cell)
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
                    if rank[there] >= 0 or colors[there] != colors[here]:
                        continue
                    if colors[here] not in joinable or not self._linked(here, there, attached):
                        continue
                    parent[there], rank[there] = here, rank[here] + 1
                    reached.append(there)
        return parent, rank

    def _linked(self, one: int, other: int, attached: Mapping[int, int]) -> bool:
        """Whether two neighbors are linked, or one of them is attached to the other."""
        hosts = self.sectors.hosts
        if one in hosts and other in hosts[one]:
            return attached.get(one) == other
        return other not in hosts or one not in hosts[other] or attached.get(other) == one

    @cached_property
    def neighbors(self) -> list[dict[int, frozenset[int]]]:
        """For each sector its neighbors, with the colors in which the two can be joined."""
        found: list[dict[int, frozenset[int]]] = [{} for _ in self.sectors.cell]
        for one, other, dart in self.sectors.links:
            colors = self._joinable(one, dart)
            for here, there in ((one, other), (other, one)):
                found[here][there] = found[here].get(there, frozenset()) | colors
        for leaf, hosts in self.sectors.hosts.items():
            for host in hosts:
                found[leaf][host] = found[host][leaf] = self._joinable(leaf, -1)
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
        return [self._apart(number) for number in range(len(self.sectors.links))]

    def _apart(self, number: int) -> tuple[cp_model.IntVar, cp_model.IntVar | None]:
        model, color = self.model, self.variables.color
        one, other, dart = self.sectors.links[number]
        colors = [self.colors(sector) for sector in (one, other)]
        joinable, shared = self._joinable(one, dart), colors[0] & colors[1]
        if not joinable:
            return self.true, None
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
        around: list[list[tuple[cp_model.IntVar, cp_model.IntVar | None]]]
        around = [[] for _ in range(count)]
        for own, faces in zip(self.apart, sides, strict=True):
            for face in faces:
                around[face].append(own)
        found = {}
        for face, own in enumerate(around):
            alike = [literal for _, literal in own if literal is not None]
            if len(own) > 2 or alike:
                least, most = -len(alike), max(0, len(own) - 2)
                found[face] = self.model.new_int_var(least, most, f"surplus[{face}]")
                self.model.add(found[face] >= sum(literal for literal, _ in own) - 2)
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
            if dart < 0 and len(found.get(cell, ())) < len(self.sectors.graph.loops[cell][0]):
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
            own = [cell for cell in sorted(cells) if len(graph.colors[cell]) == 1]
            if own:
                found[number] = max(own, key=lambda cell: len(graph.lists[cell]))
        return found


def _add_variables(m: Formulation, *, only_centers: bool) -> None:
    """The variables.

    Args:
        only_centers: whether only centers of cells can be roots.
    """
    model, v, sectors = m.model, m.variables, m.sectors
    size = [sum(len(sectors.nodes[cell]) for cell in cells) for _, cells in m.regions]
    for sector, cell in enumerate(sectors.cell):
        name = f"{cell},{sector - sectors.nodes[cell][0]}"
        colors = sorted(m.colors(sector))
        for c in colors:
            v.color[sector, c] = (
                m.true if len(colors) == 1 else model.new_bool_var(f"color[{name},{c}]")
            )
            if not only_centers or sector == sectors.center(cell):
                v.root[sector, c] = model.new_bool_var(f"root[{name},{c}]")
        most = max(size[m.region_of[cell, c]] for c in colors)
        v.rank.append(model.new_int_var(0, most - 1, f"rank[{name}]"))
    for leaf, hosts in sectors.hosts.items():
        for host in hosts:
            v.attached[leaf, host] = model.new_bool_var(f"attached[{leaf},{host}]")
    for here, own in enumerate(m.neighbors):
        for there in own:
            v.parent[here, there] = model.new_bool_var(f"parent[{here},{there}]")


def one_color(m: Formulation) -> None:
    """(1) Each sector has one color."""
    for sector in range(len(m.sectors.cell)):
        m.model.add_exactly_one(m.variables.color[sector, c] for c in m.colors(sector))


def parent_or_root(m: Formulation) -> None:
    """(2) Each sector has a parent, or it is the root of its segment in its color."""
    v = m.variables
    for sector, own in enumerate(m.neighbors):
        roots = [v.root[sector, c] for c in m.colors(sector) if (sector, c) in v.root]
        m.model.add_bool_or([v.parent[sector, other] for other in own] + roots)
    for (sector, c), literal in v.root.items():
        m.model.add_implication(literal, v.color[sector, c])


def parent_of_one_color(m: Formulation) -> None:
    """(3) A sector has the color of its parent, and that color is joinable between the two."""
    v = m.variables
    for (here, there), literal in v.parent.items():
        joinable = m.neighbors[here][there]
        for c in sorted(m.colors(here)):
            same = [v.color[there, c]] if c in joinable else []
            m.model.add_bool_or([~literal, ~v.color[here, c], *same])


def no_circles(m: Formulation) -> None:
    """(4) Ranks fall from each sector to its parent, so that parents lead to a root."""
    v = m.variables
    for (here, there), literal in v.parent.items():
        m.model.add(v.rank[here] >= v.rank[there] + 1).only_enforce_if(literal)


def one_host(m: Formulation) -> None:
    """(5) A leaf dart is attached to one sector of its cell at most, in one color with it."""
    v = m.variables
    for leaf, hosts in m.sectors.hosts.items():
        m.model.add_at_most_one(v.attached[leaf, host] for host in hosts)
        for host in hosts:
            attached = v.attached[leaf, host]
            m.model.add_implication(v.parent[leaf, host], attached)
            m.model.add_implication(v.parent[host, leaf], attached)
            for c in sorted(m.colors(leaf)):
                m.model.add_bool_or([~attached, ~v.color[leaf, c], v.color[host, c]])


def undivided(m: Formulation) -> None:
    """(6) A root is the center of an undivided cell.

    That no other sector can be one is said by ``_add_variables``.
    """
    v = m.variables
    for (sector, c), literal in v.root.items():
        for node in m.sectors.nodes[m.sectors.cell[sector]]:
            m.model.add_implication(literal, v.color[node, c])


def fixed_roots(m: Formulation) -> None:
    """(7) A region with one-colored cells has a root in one of them, whichever is chosen."""
    for number, cell in m.fixed_root.items():
        root = m.variables.root[m.sectors.center(cell), m.regions[number][0]]
        m.model.add_bool_or([root])


def regions_in_use(m: Formulation) -> None:
    """(8) A region in use has a root, and each cell lies in a region in use."""
    model, v = m.model, m.variables
    for (sector, c), literal in v.color.items():
        model.add_implication(literal, m.used[m.region_of[m.sectors.cell[sector], c]])
    roots: list[list[cp_model.IntVar]] = [[] for _ in m.regions]
    for (sector, c), literal in v.root.items():
        roots[m.region_of[m.sectors.cell[sector], c]].append(literal)
    for used, own in zip(m.used, roots, strict=True):
        model.add(sum(own) >= used)
    for cell, colors in enumerate(m.sectors.graph.colors):
        model.add_bool_or(m.used[m.region_of[cell, c]] for c in sorted(colors))


def cover(m: Formulation) -> None:
    """(9) There are as many regions in use as a smallest set cover has, and as many segments."""
    m.fewest_regions = smallest_cover(m.regions, len(m.sectors.nodes))
    m.model.add(sum(m.used) >= m.fewest_regions)
    m.model.add(sum(m.variables.root.values()) >= m.fewest_regions)


def company(m: Formulation) -> None:
    """(10) Each sector is a root, or has a neighbor of its color."""
    v = m.variables
    for (sector, c), literal in v.color.items():
        near = [v.color[other, c] for other, own in m.neighbors[sector].items() if c in own]
        own = [v.root[sector, c]] if (sector, c) in v.root else []
        m.model.add_bool_or([~literal, *near, *own])


def euler(m: Formulation) -> None:
    """(11) Euler's formula: there are as many segments as borders divide the surface into.

    Where b border lines meet at a face of the sector graph, they add (b - 2) / 2 regions.
    """
    v, sectors = m.variables, m.sectors
    of_part: UnionFind[int] = UnionFind(range(len(sectors.cell)))
    for one, other, _ in sectors.links:
        of_part.union(one, other)
    parts = {of_part[sector]: m.model.new_bool_var("") for sector in range(len(sectors.cell))}
    for (one, _, _), (apart, _) in zip(sectors.links, m.apart, strict=True):
        m.model.add_implication(apart, parts[of_part[one]])
    alone = sum(not own for own in sectors.around)  # each of these has one face that is no walk
    faces = sectors.faces[1] + alone
    characteristic = len(sectors.cell) - len(sectors.links) + faces
    m.model.add(
        2 * (sum(v.root.values()) + sum(v.attached.values()))
        >= 2 * (characteristic - len(parts) + sum(parts.values())) + sum(m.surplus.values())
    )


def links(m: Formulation) -> None:
    """(12) No cell has more links than its best grouping of darts.

    A cell with s sub-cells has as many links as joined darts less s, and by Euler's formula in the
    cell s is half of 2, its surplus and the changes of color along its border together.
    """
    sectors, graph = m.sectors, m.sectors.graph
    own: dict[int, list[cp_model.IntVar]] = {}
    inside = [set[int]() for _ in range(sectors.faces[1])]
    for (one, _, dart), faces in zip(sectors.links, sectors.faces[0], strict=True):
        for face in faces:
            inside[face].add(-1 if dart >= 0 else sectors.cell[one])
    for face, surplus in m.surplus.items():
        if len(inside[face]) == 1 and -1 not in inside[face]:
            own.setdefault(inside[face].pop(), []).append(surplus)
    for cell, loops in enumerate(graph.loops):
        if not sectors.rings[cell]:
            continue
        colors = [graph.darts[dart].colors for dart in loops[0]]
        most = best_grouping(colors).links
        # A dart may have its neighbor's color and still not be joined where few colors are joinable.
        joined = [
            1 - m.apart[m.link_at[dart]][0]
            for dart in loops[0]
            if dart in m.link_at and m.apart[m.link_at[dart]][1] is None
        ]
        changes = [m.apart[link][0] for link in m.ring_of[cell]]
        m.model.add(sum(own.get(cell, [])) + 2 + sum(changes) >= 2 * (sum(joined) - most))


def zeros(m: Formulation) -> None:
    """(13) The color changes along a cell's border only at a joined dart.

    A dart in state 0 shows the color of the sub-cell before it.
    """
    sectors, graph, v = m.sectors, m.sectors.graph, m.variables
    for cell, ring in m.ring_of.items():
        darts = graph.loops[cell][0]
        for place, dart in enumerate(darts):
            change = m.apart[ring[place - 1]][0]
            if dart in m.link_at:
                m.model.add_bool_or([~change, ~m.apart[m.link_at[dart]][0]])
            for c in sorted(graph.colors[cell] - graph.darts[dart].colors):
                m.model.add_bool_or([~change, ~v.color[sectors.at[dart], c]])


DEFINING: Mapping[str, Callable[[Formulation], None]] = {
    "one color": one_color,
    "parent or root": parent_or_root,
    "parent of one color": parent_of_one_color,
    "no circles": no_circles,
    "one host": one_host,
}

REDUNDANT: Mapping[str, Callable[[Formulation], None]] = {
    "undivided": undivided,
    "fixed roots": fixed_roots,
    "regions in use": regions_in_use,
    "cover": cover,
    "company": company,
    "euler": euler,
    "links": links,
    "zeros": zeros,
}
