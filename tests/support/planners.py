"""Three planners that choose a color for each vertex and do not look for the fewest segments.

The color of a vertex is the branch of joint configurations that it is covered in. All three return
a plan as the oracle takes it: a color for each vertex, None where it has none.
"""

from __future__ import annotations

from collections import Counter

import networkx as nx
import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface

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
