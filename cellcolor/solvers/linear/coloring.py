"""The fewest segments as a 0-1 linear model (search space ``paper``, cells with one live loop).

Each segment is a tree of sub-cells with pointers to a root; the objective counts the roots, and the
cells in which nothing is joined. ``docs/models.md`` explains every group of constraints below, each
of which is a function here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from itertools import combinations
from typing import NamedTuple

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError, TooLarge
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.joined_chains import only_loops
from cellcolor.solvers.linear.model import Model


class Region(NamedTuple):
    """A color region of two cells or more.

    Attributes:
        cell: the first of its cells.
        color: which one continues.
        longest_way: no path in a tree of sub-cells crosses more edges.
    """

    cell: int
    color: int
    longest_way: int


def regions_by_cell(instance: Instance) -> dict[tuple[int, int], Region]:
    """The region of each (cell, color) that can be joined to a neighbor."""
    found: dict[tuple[int, int], Region] = {}
    for color, cells in color_regions(instance):
        exits = [
            [
                dart
                for loop in instance.live_loops[cell]
                for dart in loop
                if color in instance.joinable(dart)
            ]
            for cell in cells
        ]
        edges = {abs(dart) for darts in exits for dart in darts}
        # A cell with one exit is an end: a way meets two such cells at most.
        ends = {abs(darts[0]) for darts in exits if len(darts) == 1}
        if edges:
            region = Region(min(cells), color, len(edges) - len(ends) + min(2, len(ends)))
            found |= {(cell, color): region for cell in cells}
    return found


MOST_TERMS = 5_000_000
"""The most literals that the constraints of a model may have: some 100 MB as a file, and below 2 GB
in a solver that holds it a few times over."""


def estimated_terms(instance: Instance) -> int:
    """About how many literals the model of an instance has, found without making it.

    Nearly all literals are in the constraints on crossings and on ranks.
    """
    regions = regions_by_cell(instance)
    total = 0
    for cell in instance.cells:
        darts = sum(map(len, instance.live_loops[cell.id]))
        own = [regions[cell.id, color] for color in cell.colors if (cell.id, color) in regions]
        highest = max((region.longest_way for region in own), default=0)
        total += darts**3 // 3 + darts**2 * (len(cell.colors) * 4 + highest * 3) + 8 * darts
    return total


class Coloring:
    """The model of an instance; a solution is read off ``joined`` and ``link``.

    Attributes:
        joined: (edge, color) -> the edge is joined in this color.
        link: (dart, later dart of the same cell) -> the one follows the other in one sub-cell.
    """

    def __init__(self, instance: Instance) -> None:
        """Write the model down.

        Raises:
            InputError: a cell has several loops with live darts, which the model cannot divide.
            TooLarge: the model would have more than ``MOST_TERMS`` literals.
        """
        self._loops = only_loops(instance)
        terms = estimated_terms(instance)
        if terms > MOST_TERMS:
            raise TooLarge(f"the 0-1 model would have {terms} literals, {MOST_TERMS} at most")
        self._instance = instance
        self._regions = regions_by_cell(instance)
        self.model = Model()
        self.joined: dict[tuple[int, int], int] = {}
        self.link: dict[tuple[int, int], int] = {}
        self._is_one: dict[int, int] = {}  # edge -> it is in state 1
        self._up: dict[int, int] = {}  # dart -> the parent lies across its edge
        self._ways: dict[int, list[int]] = defaultdict(list)  # dart -> where it can point
        self._alone: list[int] = []  # cell -> nothing is joined in it
        self._root: dict[int, int] = {}  # dart -> it is the root of its segment
        self._one_color()
        for loop in self._loops:
            self._one_chain(loop)
            self._no_crossing(loop)
        self._roots()
        self._one_pointer()
        self._no_circles()
        self._cover()

    def _one_color(self) -> None:
        """An edge is joined in one color or in none; across it lies the parent of one side."""
        model = self.model
        for edge in self._instance.live_edges:
            one = self._is_one[edge] = model.new("one", edge)
            for color in self._instance.joinable(edge):
                self.joined[edge, color] = model.new("joined", edge, color)
            colors = self._instance.joinable(edge)
            model.exactly([-one, *(self.joined[edge, color] for color in colors)])
            for dart in (edge, -edge):
                self._up[dart] = model.new("up", dart)
                self._ways[dart].append(self._up[dart])
            model.exactly([-one, self._up[edge], self._up[-edge]])

    def _one_chain(self, loop: tuple[int, ...]) -> None:
        """A sub-cell is a chain of darts of one color, each linked to the next. Of two linked darts
        one points at the other, so that all lead to the one that points across its edge."""
        model = self.model
        sides: dict[tuple[int, int, int], list[int]] = defaultdict(list)
        for dart, other in combinations(loop, 2):
            common = [c for c in self._instance.joinable(dart) if (abs(other), c) in self.joined]
            if not common:
                continue
            link = self.link[dart, other] = model.new("link", dart, other)
            colored = {c: model.new("linked", dart, other, c) for c in common[1:]}
            if colored:  # with one common color the link itself stands for it
                colored[common[0]] = model.new("linked", dart, other, common[0])
                model.exactly([-link, *colored.values()])
            for color in common:
                sides[dart, 1, color].append(colored.get(color, link))
                sides[other, -1, color].append(colored.get(color, link))
            ways = [model.new("points", dart, other), model.new("points", other, dart)]
            self._ways[dart].append(ways[0])
            self._ways[other].append(ways[1])
            model.exactly([-link, *ways])
        for (dart, _, color), links in sides.items():
            model.one_at_most([*links, -self.joined[abs(dart), color]])

    def _no_crossing(self, loop: tuple[int, ...]) -> None:
        """Links are arcs over a line of darts that do not cross, and no dart has two on a side.

        Take two darts. Arcs from before the first to the second, and arcs from the first to beyond
        the second, cross each other or share an end: at most one of all these is there.
        """
        into: dict[int, list[tuple[int, int]]] = defaultdict(list)
        out: dict[int, list[tuple[int, int]]] = defaultdict(list)
        place = {dart: at for at, dart in enumerate(loop)}
        for dart, other in combinations(loop, 2):
            if (dart, other) in self.link:
                into[place[other]].append((place[dart], self.link[dart, other]))
                out[place[dart]].append((place[other], self.link[dart, other]))
        for at in range(len(loop)):
            self.model.one_at_most(link for _, link in into[at])
            self.model.one_at_most(link for _, link in out[at])
        for at, end in combinations(range(len(loop)), 2):
            over = [link for begin, link in into[end] if begin < at]
            beyond = [link for last, link in out[at] if last > end]
            if over and beyond:
                self.model.one_at_most([*over, *beyond])

    def _roots(self) -> None:
        """What is counted: roots, and cells that are alone, with no dart in state 1.

        A root is the first dart in state 1 of an undivided cell; every segment has such a cell
        (docs/formulation.md).
        """
        model = self.model
        for cell, loop in enumerate(self._loops):
            alone = model.new("alone", cell)
            self._alone.append(alone)
            model.some(alone, *(self._is_one[abs(dart)] for dart in loop))
            model.costs.append(alone)
            for at, dart in enumerate(loop):
                root = self._root[dart] = model.new("root", dart)
                model.costs.append(root)
                self._ways[dart].append(root)
                for earlier in loop[:at]:
                    model.some(-root, -self._is_one[abs(earlier)])
                for later in loop[at + 1 :]:
                    links = [self.link[d, later] for d in loop if (d, later) in self.link]
                    model.some(-root, -self._is_one[abs(later)], *links)

    def _one_pointer(self) -> None:
        """A dart in state 1 points across its edge, along its chain, or is a root: one of them."""
        for dart, ways in self._ways.items():
            self.model.exactly([-self._is_one[abs(dart)], *ways])

    def _no_circles(self) -> None:
        """Ranks are equal along chains and fall towards the parent, so pointers form no cycle.

        They are in unary (order encoding): ``rank[dart, n]`` says that the rank is n or more. Ranks
        count joined edges on the way to the root, so none is higher than the longest way in the
        color region.
        """
        model = self.model
        cell_of = {dart: cell for cell, loop in enumerate(self._loops) for dart in loop}
        highest = {
            dart: max(
                self._regions[cell, color].longest_way for color in self._instance.joinable(dart)
            )
            for dart, cell in cell_of.items()
        }
        rank = {
            (dart, level): model.new("rank", dart, level)
            for dart in cell_of
            for level in range(1, highest[dart] + 1)
        }
        for (dart, level), literal in rank.items():
            if level > 1:
                model.some(-literal, rank[dart, level - 1])
        for dart, up in self._up.items():
            model.some(-up, rank[dart, 1])
            for level in range(1, highest[-dart] + 1):
                higher = [rank[dart, level + 1]] if level < highest[dart] else []
                model.some(-up, -rank[-dart, level], *higher)
        for (dart, other), link in self.link.items():
            for one, two in ((dart, other), (other, dart)):
                for level in range(1, highest[one] + 1):
                    same = [rank[two, level]] if level <= highest[two] else []
                    model.some(-link, -rank[one, level], *same)

    def _cover(self) -> None:
        """Redundant, so that the linear relaxation knows the set cover: a color region in use has a
        root in it, and every cell touches one in use or is alone."""
        model = self.model
        used: dict[Region, int] = {}
        inside: dict[Region, list[int]] = defaultdict(list)
        for cell, loop in enumerate(self._loops):
            for dart in loop:
                colors = self._instance.joinable(dart)
                root_in = {color: model.new("rootin", dart, color) for color in colors}
                model.exactly([-self._root[dart], *root_in.values()])
                for color, literal in root_in.items():
                    region = self._regions[cell, color]
                    if region not in used:
                        used[region] = model.new("used", *region)
                    inside[region].append(literal)
                    model.some(-literal, self.joined[abs(dart), color])
                    model.some(-self.joined[abs(dart), color], used[region])
        for region, literals in inside.items():
            model.some(-used[region], *literals)
        for place, alone in enumerate(self._alone):
            colors = self._instance.cells[place].colors
            regions = [self._regions[place, c] for c in colors if (place, c) in self._regions]
            model.some(alone, *(used[region] for region in regions))


def require_solution(coloring: Coloring, true: Collection[int]) -> None:
    """Refuse values that break a constraint; variables above the model's own are left alone.

    Raises:
        InputError: a constraint does not hold; the first is identified by its variables.
    """
    model = coloring.model
    for sense, literals in model.rows():
        count = sum((literal > 0) == (abs(literal) in true) for literal in literals)
        if (count > 1 and sense != ">=") or (count < 1 and sense != "<="):
            names = ", ".join(
                f"{'not ' if literal < 0 else ''}{' '.join(map(str, model.names[abs(literal)]))}"
                for literal in literals[:4]
            )
            more = ", …" if len(literals) > 4 else ""
            message = (
                f"is not a solution of the model: of ({names}{more}) {count} hold, not {sense} 1"
            )
            raise InputError(None, None, message)


def joined_and_linked(
    coloring: Coloring, true: Collection[int]
) -> tuple[dict[int, int], dict[int, int]]:
    """The color of each edge that is joined, and the dart that follows each linked dart."""
    color = {edge: c for (edge, c), variable in coloring.joined.items() if variable in true}
    after = {dart: d for (dart, d), variable in coloring.link.items() if variable in true}
    return color, after
