"""Three planners that choose a color for each vertex and do not look for the fewest segments.

The color of a vertex is the branch of joint configurations that it is covered in. All three return
a plan as the oracle takes it: a color for each vertex, None where it has none.

Valid plans of many sorts, and what would contradict the verdicts on them.

Segments are counted here by networkx, from triangles and cracks alone.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import networkx as nx
import numpy as np

import cellcolor
from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.oracle import Verdict

Colors = list[int | None]
_FULL = 2 * np.pi


def largest_set_first(surface: LabelledSurface) -> Colors:
    """The color with the largest connected set of vertices, then that of what is left, and so on.

    Sets are compared by their number of vertices; of two alike the lower color goes first.
    """
    colors: Colors = [None] * len(surface.vertices)
    meshes = [_mesh_of(surface, color) for color in range(len(surface.colors))]
    while any(meshes):
        largest = [max(nx.connected_components(mesh), key=len, default=set()) for mesh in meshes]
        color = max(range(len(meshes)), key=lambda number: len(largest[number]))
        for vertex in largest[color]:
            colors[vertex] = color
        for mesh in meshes:
            mesh.remove_nodes_from(largest[color])
    return colors


def random_branches(surface: LabelledSurface, random: np.random.Generator) -> Colors:
    """A random color for each vertex, then mended to connected sets by majorities.

    A vertex takes the color of more of its neighbors than show its own, until there is none left
    to do so. Each time more mesh edges have one color at both ends, so this comes to an end.
    """
    colors: Colors = [int(random.choice(own)) if own else None for own in surface.vertex_colors]
    neighbors = [set[int]() for _ in surface.vertices]
    for a, b in surface.left_of:
        neighbors[a].add(b)
        neighbors[b].add(a)
    changed = True
    while changed:
        changed = False
        for vertex in random.permutation(len(colors)).tolist():
            shown = Counter(
                color
                for other in neighbors[vertex]
                if (color := colors[other]) in surface.vertex_colors[vertex]
                and color not in surface.cracked(vertex, other)
            )
            best = max(sorted(shown), key=lambda color: shown[color], default=None)
            if best is not None and shown[best] > shown[colors[vertex]]:
                colors[vertex], changed = best, True
    return colors


def nearest_along_raster(surface: LabelledSurface, configurations: Array, angle: float) -> Colors:
    """Vertices in the order of a raster, each in the branch that is nearest to the one before.

    The first vertex takes the first of its colors.

    Args:
        surface: the labelled surface.
        configurations: (n, colors, joints) of each color at each vertex, rad.
        angle: of the raster, rad.
    """
    colors: Colors = [None] * len(surface.vertices)
    last: Array | None = None
    for vertex in _raster_order(surface, angle).tolist():
        own = surface.vertex_colors[vertex]
        if not own:
            continue
        here = configurations[vertex, list(own)]
        turns = np.zeros_like(here) if last is None else here - last
        away = np.linalg.norm(turns - _FULL * np.round(turns / _FULL), axis=1)
        chosen = int(np.argmin(away))
        colors[vertex], last = own[chosen], here[chosen]
    return colors


def configurations_of(surface: LabelledSurface, table: CandidateTable) -> Array:
    """The configuration of each color at each vertex (n, colors, joints), rad; NaN without one."""
    joints = table.configurations.shape[2]
    found = np.full((len(surface.vertices), len(surface.colors), joints), np.nan)
    vertices, branches = np.nonzero(table.node_color >= 0)
    found[vertices, table.node_color[vertices, branches]] = table.configurations[vertices, branches]
    return found


def configurations_without_arm(surface: LabelledSurface, random: np.random.Generator) -> Array:
    """Configurations (n, colors, 3) for a surface that no arm stands behind, rad.

    Each color has one of its own, which turns slowly along the surface.
    """
    fixed = random.uniform(-np.pi, np.pi, (1, len(surface.colors), 3))
    slope = random.normal(size=(3, len(surface.colors), 3))
    found: Array = fixed + np.einsum("nk,kcj->ncj", surface.vertices, slope)
    return found


def _mesh_of(surface: LabelledSurface, color: int) -> nx.Graph[int]:
    """The vertices that a color reaches, joined where it goes on from one to the other."""
    mesh: nx.Graph[int] = nx.Graph()
    mesh.add_nodes_from(v for v, own in enumerate(surface.vertex_colors) if color in own)
    mesh.add_edges_from(
        (a, b)
        for a, b in surface.left_of
        if a in mesh and b in mesh and color not in surface.cracked(a, b)
    )
    return mesh


def _raster_order(surface: LabelledSurface, angle: float) -> Index:
    """All vertices, row after row and back and forth; rows are as wide as mesh edges are long.

    Rows lie in the plane in which the vertices spread most.
    """
    points = surface.vertices - surface.vertices.mean(axis=0)
    plane = np.linalg.svd(points, full_matrices=False)[2][:2]
    turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    along, across = turned @ plane @ points.T
    ends = surface.vertices[np.array(list(surface.left_of))]
    width = np.median(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1))
    row = np.floor((across - across.min()) / width).astype(np.int64)
    order: Index = np.lexsort((np.where(row % 2, -along, along), row))
    return order


Random = np.random.Generator


def segments_counted(surface: LabelledSurface, colors: Sequence[int | None]) -> int:
    """The connected components of vertices in one color, across mesh edges without a crack."""
    mesh: nx.Graph[int] = nx.Graph()
    mesh.add_nodes_from(vertex for vertex, color in enumerate(colors) if color is not None)
    cracks = {frozenset((crack.i, crack.j)): crack.colors for crack in surface.cracks}
    for a, b, c in surface.faces.tolist():
        for one, other in ((a, b), (b, c), (c, a)):
            same = colors[one] is not None and colors[one] == colors[other]
            if same and colors[one] not in cracks.get(frozenset((one, other)), ()):
                mesh.add_edge(one, other)
    return nx.number_connected_components(mesh)


def any_colors(surface: LabelledSurface, random: Random) -> Colors:
    """A color for each vertex by chance."""
    return [int(random.choice(own)) if own else None for own in surface.vertex_colors]


def in_patches(surface: LabelledSurface, random: Random) -> Colors:
    """A few centers; each vertex takes the first color that it has in the order of the nearest."""
    centers = surface.vertices[random.choice(len(surface.vertices), 4)]
    ranks = [random.permutation(len(surface.colors)) for _ in centers]
    away = np.linalg.norm(surface.vertices[:, None] - centers[None], axis=2).argmin(axis=1)
    return [
        min(own, key=lambda color: ranks[nearest][color]) if own else None
        for nearest, own in zip(away.tolist(), surface.vertex_colors, strict=True)
    ]


def mutated(surface: LabelledSurface, best: Sequence[int | None], random: Random) -> Colors:
    """The best plan found, with up to five of its vertices in other colors of theirs."""
    colors = list(best)
    several = [vertex for vertex, own in enumerate(surface.vertex_colors) if len(own) > 1]
    for vertex in random.permutation(several)[: int(random.integers(6))].tolist():
        colors[vertex] = int(random.choice(surface.vertex_colors[vertex]))
    return colors


def _by_raster(surface: LabelledSurface, random: Random, configurations: Array | None) -> Colors:
    if configurations is None:
        configurations = configurations_without_arm(surface, random)
    return nearest_along_raster(surface, configurations, float(random.uniform(0, np.pi)))


SORTS = ("by chance", "in patches", "best, mutated", "greedy", "random, mended", "raster")


def valid_plans(
    oracle: cellcolor.Oracle, random: Random, configurations: Array | None = None
) -> Iterator[tuple[str, Colors]]:
    """Plans of all sorts in turn, without an end, each with its sort.

    Args:
        oracle: of the surface.
        random: what draws.
        configurations: (n, colors, joints) in rad, if an arm stands behind the surface.
    """
    surface, best = oracle.surface, oracle.best
    plans: dict[str, Callable[[], Colors]] = {
        "by chance": lambda: any_colors(surface, random),
        "in patches": lambda: in_patches(surface, random),
        "greedy": lambda: largest_set_first(surface),
        "random, mended": lambda: random_branches(surface, random),
        "raster": lambda: _by_raster(surface, random, configurations),
    }
    if best is not None:
        plans["best, mutated"] = lambda: mutated(surface, best.on_mesh.vertex_colors, random)
    turn = 0
    while True:
        for sort in SORTS:
            # There is one greedy plan of a surface.
            if sort in plans and (turn == 0 or sort != "greedy"):
                yield sort, plans[sort]()
        turn += 1


def contradictions(
    oracle: cellcolor.Oracle, colors: Colors, verdict: Verdict, fewest: int
) -> list[str]:
    """What in a verdict on a valid plan is not as it has to be.

    Args:
        oracle: what gave it.
        colors: the plan.
        verdict: the verdict.
        fewest: segments of the best plan that is known of this surface.
    """
    if not verdict.valid:
        return [f"refused: {verdict}"]
    own, bounds, better = (
        segments_counted(oracle.surface, colors),
        oracle.bounds,
        verdict.improvement,
    )
    wrong = []
    if verdict.segments != own:
        wrong.append(f"{verdict.segments} segments, {own} by networkx")
    if min(own, fewest) < bounds.lower:
        wrong.append(f"{min(own, fewest)} segments, below the bound {bounds.lower}")
    if verdict.beatable_by == 0 and fewest < own:
        wrong.append(f"cannot be beaten with {own} segments, another has {fewest}")
    if verdict.optimal and (verdict.beatable_by != 0 or own != bounds.lower):
        wrong.append(f"optimal with {own} segments, {verdict.beatable_by} fewer are enough")
    if verdict.beatable_by and better is not None:
        painted, on_mesh = better.better.painted, better.better.on_mesh
        counted = segments_counted(painted.surface, painted.plan.vertex_colors)
        if counted != better.segments or counted > own - verdict.beatable_by:
            wrong.append(f"{counted} segments in what has {verdict.beatable_by} fewer than {own}")
        if segments_counted(oracle.surface, on_mesh.vertex_colors) != better.segments_on_mesh:
            wrong.append("another number of segments on the mesh as it is")
    if verdict.beatable_by and better is None and oracle.best is not None:
        wrong.append(f"{verdict.beatable_by} fewer are enough, and nothing says where")
    return wrong
