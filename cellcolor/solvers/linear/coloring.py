"""The fewest segments as a 0-1 linear model (search space ``paper``, cells with one live loop).

Each segment is a tree of sub-cells, hung up at one of them, its root; the objective counts the
roots, and the cells in which nothing is joined. ``docs/models.md`` explains every group of
constraints below, each of which is a function here.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import combinations

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError, TooLarge
from cellcolor.solvers.linear.constraints import Model
from cellcolor.solvers.linear.regions import Region, color_regions

MOST_TERMS = 5_000_000
"""The most literals that the constraints of a model may have: some 100 MB as a file, and below 2 GB
in a solver that holds it a few times over."""


def estimated_terms(instance: Instance) -> int:
    """About how many literals the model of an instance has, found without making it.

    Nearly all are those that keep cutting paths from crossing and those of ranks.
    """
    levels = _levels(color_regions(instance))
    total = 0
    for cell in instance.cells:
        darts = sum(map(len, instance.live_loops[cell.id]))
        highest = max((levels.get((cell.id, color), 0) for color in cell.colors), default=0)
        total += darts**3 // 3 + darts**2 * (len(cell.colors) * 4 + highest * 3) + 8 * darts
    return total


class Coloring:
    """The model of an instance; ``joined`` and ``link`` are what a solution is read off.

    Attributes:
        model: the constraints.
        joined: (edge, color) -> the edge is joined in this color.
        link: (dart, later dart of the same cell) -> the one follows the other in one sub-cell.
    """

    def __init__(self, instance: Instance) -> None:
        """Write the model down.

        Raises:
            InputError: a cell has several loops with live darts, which the model cannot divide.
            TooLarge: the model would have more than ``MOST_TERMS`` literals.
        """
        for cell, loops in enumerate(instance.live_loops):
            if len(loops) > 1:
                message = f"the model knows one live loop, here are {len(loops)}"
                raise InputError(None, f"cells[{cell}].loops", message)
        terms = estimated_terms(instance)
        if terms > MOST_TERMS:
            raise TooLarge(f"the 0-1 model would have {terms} literals, {MOST_TERMS} at most")
        self._instance = instance
        self._loops = [loops[0] if loops else () for loops in instance.live_loops]
        self._regions = color_regions(instance)
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
        """A sub-cell is a chain of darts of one color; of two that are linked one points at the
        other, so that all lead to the one that points across its edge."""
        model = self.model
        sides: dict[tuple[int, int, int], list[int]] = defaultdict(list)
        for dart, other in combinations(loop, 2):
            common = [c for c in self._instance.joinable(dart) if (abs(other), c) in self.joined]
            if not common:
                continue
            link = self.link[dart, other] = model.new("link", dart, other)
            colored = {c: model.new("linked", dart, other, c) for c in common[1:]}
            if colored:  # else the link has the one color that there is
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
        """Of the links that come from before a dart and end at a later one, and those that start at
        the dart and go beyond, there is one at most. With no dart before: one link either way."""
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
        """A root is the first dart in state 1 of an undivided cell. A cell is alone if it has no
        dart in state 1. Roots, and cells that are alone, are what is counted."""
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
        """Ranks are equal along chains and fall towards the parent, so that no circle is counted.

        ``rank[dart, n]`` says that the rank is n or more.
        """
        model = self.model
        levels = _levels(self._regions)
        cell_of = {dart: cell for cell, loop in enumerate(self._loops) for dart in loop}
        highest = {
            dart: max(levels[cell, color] for color in self._instance.joinable(dart))
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
        """Redundant: a color region in use has a root in it, and every cell touches one in use or
        is alone. So the linear relaxation knows the set cover."""
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


def _levels(regions: dict[tuple[int, int], Region]) -> dict[tuple[int, int], int]:
    """For each (cell, color) the highest rank that a tree in its color region can have.

    Ranks count joined edges on the way to the root. That way meets an edge once, and of the edges
    to cells in which the color goes no further one where it begins and one where it ends.
    """
    return {place: region.longest_way for place, region in regions.items()}
