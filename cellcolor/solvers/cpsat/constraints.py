"""The constraints of the model, one function for each group (docs/formulation.md).

The numbers are those of that page. ``DEFINING`` groups make the model correct and complete. Each
``REDUNDANT`` group may be left out, and the minimum stays the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ortools.sat.python import cp_model

from cellcolor.solvers.bounds.cover import set_cover
from cellcolor.solvers.bounds.grouping import best_grouping
from cellcolor.union_find import UnionFind

if TYPE_CHECKING:
    from cellcolor.solvers.cpsat.formulation import SectorModel


def add_variables(m: SectorModel, *, only_centers: bool) -> None:
    """The variables; ``only_centers`` says whether only centers of cells can be roots."""
    model, v, sectors = m.model, m.variables, m.sectors
    size = [sum(len(sectors.nodes[cell]) for cell in cells) for _, cells in m.regions]
    for sector, cell in enumerate(m.deadline.watch(sectors.cell)):
        name = f"{cell},{sector - sectors.nodes[cell][0]}"
        colors = sorted(m.colors(sector))
        for c in colors:
            v.color[sector, c] = (
                m.true if len(colors) == 1 else model.new_bool_var(f"color[{name},{c}]")
            )
            if not only_centers or sector == sectors.nodes[cell][-1]:
                v.root[sector, c] = model.new_bool_var(f"root[{name},{c}]")
        most = max(size[m.region_of[cell, c]] for c in colors)
        v.rank.append(model.new_int_var(0, most - 1, f"rank[{name}]"))
    for here, own in enumerate(m.deadline.watch(m.neighbors)):
        for there in own:
            v.parent[here, there] = model.new_bool_var(f"parent[{here},{there}]")


def one_color(m: SectorModel) -> None:
    """(1) Each sector has one color."""
    for sector in range(len(m.sectors.cell)):
        m.model.add_exactly_one(m.variables.color[sector, c] for c in m.colors(sector))


def parent_or_root(m: SectorModel) -> None:
    """(2) Each sector has a parent, or it is the root of its segment in its color."""
    v = m.variables
    for sector, own in enumerate(m.deadline.watch(m.neighbors)):
        roots = [v.root[sector, c] for c in m.colors(sector) if (sector, c) in v.root]
        m.model.add_bool_or([v.parent[sector, other] for other in own] + roots)
    for (sector, c), literal in v.root.items():
        m.model.add_implication(literal, v.color[sector, c])


def parent_of_one_color(m: SectorModel) -> None:
    """(3) A sector has the color of its parent, and that color is joinable between the two."""
    v = m.variables
    for (here, there), literal in m.deadline.watch(v.parent.items()):
        joinable = m.neighbors[here][there]
        for c in sorted(m.colors(here)):
            same = [v.color[there, c]] if c in joinable else []
            m.model.add_bool_or([~literal, ~v.color[here, c], *same])


def no_circles(m: SectorModel) -> None:
    """(4) Ranks fall from each sector to its parent, so that parents lead to a root."""
    v = m.variables
    for (here, there), literal in m.deadline.watch(v.parent.items()):
        m.model.add(v.rank[here] >= v.rank[there] + 1).only_enforce_if(literal)


def undivided(m: SectorModel) -> None:
    """(5) A root is the center of an undivided cell.

    That no other sector can be one is said by ``add_variables``.
    """
    v = m.variables
    for (sector, c), literal in v.root.items():
        for node in m.sectors.nodes[m.sectors.cell[sector]]:
            m.model.add_implication(literal, v.color[node, c])


def fixed_roots(m: SectorModel) -> None:
    """(6) A region with one-colored cells has a root in one of them, whichever is chosen."""
    for number, cell in m.fixed_root.items():
        root = m.variables.root[m.sectors.nodes[cell][-1], m.regions[number][0]]
        m.model.add_bool_or([root])


def regions_in_use(m: SectorModel) -> None:
    """(7) A region in use has a root, and each cell lies in a region in use."""
    model, v = m.model, m.variables
    for (sector, c), literal in m.deadline.watch(v.color.items()):
        model.add_implication(literal, m.used[m.region_of[m.sectors.cell[sector], c]])
    roots: list[list[cp_model.IntVar]] = [[] for _ in m.regions]
    for (sector, c), literal in v.root.items():
        roots[m.region_of[m.sectors.cell[sector], c]].append(literal)
    for used, own in zip(m.used, roots, strict=True):
        model.add(sum(own) >= used)
    for cell, colors in enumerate(m.sectors.graph.colors):
        model.add_bool_or(m.used[m.region_of[cell, c]] for c in sorted(colors))


def cover(m: SectorModel) -> None:
    """(8) There are as many regions in use as a smallest set cover has, and as many segments."""
    m.fewest_regions = set_cover(m.regions, m.deadline).bound
    m.model.add(sum(m.used) >= m.fewest_regions)
    m.model.add(sum(m.variables.root.values()) >= m.fewest_regions)


def company(m: SectorModel) -> None:
    """(9) Each sector is a root, or has a neighbor of its color."""
    v = m.variables
    for (sector, c), literal in m.deadline.watch(v.color.items()):
        near = [v.color[other, c] for other, own in m.neighbors[sector].items() if c in own]
        own = [v.root[sector, c]] if (sector, c) in v.root else []
        m.model.add_bool_or([~literal, *near, *own])


def euler(m: SectorModel) -> None:
    """(10) Euler's formula: there are as many segments as borders divide the surface into.

    Where b border lines meet at a face of the sector graph, they add (b - 2) / 2 areas.
    """
    v, sectors = m.variables, m.sectors
    of_part: UnionFind[int] = UnionFind(range(len(sectors.cell)))
    for one, other, _ in sectors.links:
        of_part.union(one, other)
    roots = {of_part[sector] for sector in range(len(sectors.cell))}
    parts = {root: m.model.new_bool_var(f"border[{n}]") for n, root in enumerate(sorted(roots))}
    for (one, _, _), (apart, _) in zip(sectors.links, m.apart, strict=True):
        m.model.add_implication(apart, parts[of_part[one]])
    alone = sum(not own for own in sectors.around)  # each of these has one face that is no walk
    faces = sectors.faces[1] + alone
    characteristic = len(sectors.cell) - len(sectors.links) + faces
    m.model.add(
        2 * sum(v.root.values())
        >= 2 * (characteristic - len(parts) + sum(parts.values())) + sum(m.surplus.values())
    )


def connections(m: SectorModel) -> None:
    """(11) No cell has more connections than its best grouping of darts.

    A cell with s sub-cells has as many connections as joined darts less s. By Euler's formula in
    the cell, s is half of 2, its surplus and the changes of color along its border together.
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
    for cell, darts in enumerate(graph.lists):
        if not sectors.rings[cell]:
            continue
        colors = [graph.darts[dart].colors for dart in darts]
        most = len(darts) - len(best_grouping(colors, m.deadline))
        joined = [1 - m.apart[m.link_at[dart]][0] for dart in darts]
        changes = [m.apart[link][0] for link in m.ring_of[cell]]
        m.model.add(sum(own.get(cell, [])) + 2 + sum(changes) >= 2 * (sum(joined) - most))


def zeros(m: SectorModel) -> None:
    """(12) The color changes along a cell's border only at a joined dart.

    A dart in state 0 shows the color of the sub-cell before it.
    """
    for cell, ring in m.ring_of.items():
        for place, dart in enumerate(m.sectors.graph.lists[cell]):
            m.model.add_implication(m.apart[ring[place - 1]][0], ~m.apart[m.link_at[dart]][0])


_Group = Callable[["SectorModel"], None]


def _named(*groups: _Group) -> dict[str, _Group]:
    return {group.__name__.replace("_", " "): group for group in groups}


DEFINING = _named(one_color, parent_or_root, parent_of_one_color, no_circles)
REDUNDANT = _named(
    undivided, fixed_roots, regions_in_use, cover, company, euler, connections, zeros
)
