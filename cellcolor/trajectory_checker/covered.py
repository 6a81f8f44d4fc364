"""How much of the reachable area the passes come near, measured along the surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located


@dataclass(frozen=True)
class Reached:
    """How near the passes come to the vertices of the fine mesh.

    Attributes:
        distance: (n,) to the nearest pass along the surface, m; infinite beyond the limit.
        nearest: (n,) which configuration in contact is there, -1 beyond the limit.
    """

    distance: Array
    nearest: Index


def reachable_areas(built: BuildResult, fine: FineMesh) -> Array:
    """How much area (n,) of each vertex of the fine mesh is part of a vertex with a color, m²."""
    colored: Mask = np.any(built.node_color >= 0, axis=1)
    third = np.where(colored[fine.owner], fine.areas, 0.0) / 3
    areas = np.zeros(len(fine.vertices))
    for corner in range(3):
        np.add.at(areas, fine.triangles[:, corner], third)
    return areas


def reach(fine: FineMesh, located: Located, farthest: float) -> Reached:
    """Distances along the surface from where the tool has been, up to ``farthest`` (m).

    Ways lead from the places of contact to the corners of their small triangles and their
    neighbors, and on from vertex to vertex.
    """
    n, places = len(fine.vertices), len(located.points)
    if not places:
        return Reached(np.full(n, np.inf), np.full(n, -1))
    # From each place to all that is near a corner of its triangle, the corners included.
    corners = fine.triangles[located.triangle]
    order = np.repeat(np.arange(places), 3)
    at = csr_array(
        (np.ones(3 * places, dtype=np.int8), (order, corners.ravel())), shape=(places, n)
    )
    pattern = fine.near.copy()
    pattern.data = np.ones(len(pattern.data), dtype=np.int8)
    place, vertex = (at + at @ pattern).tocoo().coords
    apart = np.linalg.norm(located.points[place] - fine.vertices[vertex], axis=1)
    ways = fine.near.tocoo()
    i, j = ways.coords
    # A length of zero would be no way at all.
    graph = csr_array(
        (
            np.maximum(np.concatenate([ways.data, apart]), 1e-12),
            (np.concatenate([i, place + n]), np.concatenate([j, vertex])),
        ),
        shape=(n + places, n + places),
    )
    sources = np.arange(n, n + places)
    distance, _, nearest = dijkstra(
        graph, indices=sources, min_only=True, limit=farthest, return_predecessors=True
    )
    distance, nearest = distance[:n], nearest[:n].astype(np.int64)
    return Reached(distance, np.where(np.isfinite(distance), nearest - n, -1))


def excused(
    prepared: PreparedScene,
    stated: list[int],
    segment: Index,
    branches: Index,
    fine: FineMesh,
    reached: Reached,
    missed: Mask,
    deadline: Deadline,
) -> Mask:
    """Which vertices (n,) of the fine mesh are rightly left out.

    The trajectory has to state that it leaves something out. Beside a pass of a segment of which
    that is stated, the configuration of the segment's own branch must not be valid. Far from every
    pass nothing tells which segment is meant, so there no branch may be valid.

    Args:
        stated: the segments of which the trajectory states to leave something out.
        segment: (c,) of each row in contact; ``branches`` (c,) of these.
        missed: (n,) the vertices to be asked about.
    """
    right = np.zeros(len(fine.vertices), dtype=bool)
    near = np.append(segment, -1)[reached.nearest]
    every = np.arange(len(prepared.kinematics.branches))
    regions = [(near == number, branches[segment == number]) for number in stated]
    if stated:
        regions.append((near < 0, every))
    for region, own in regions:
        asked = np.flatnonzero(missed & region)
        places, normals = fine.vertices[asked], fine.normals[asked]
        right[asked] = _out_of_reach(prepared, places, normals, own[own >= 0], deadline)
    return right


def _out_of_reach(
    prepared: PreparedScene, places: Array, normals: Array, branches: Index, deadline: Deadline
) -> Mask:
    """At which places (k, 3), with unit normals (k, 3), none of some branches is valid."""
    left = np.arange(len(places))
    for branch in np.unique(branches).tolist():
        of = np.full(len(left), branch, dtype=np.intp)
        found = prepared.arm.follow(places[left], -normals[left], of)
        left = left[prepared.judge(found, deadline).reasons != VALID]
    out = np.zeros(len(places), dtype=bool)
    out[left] = True
    return out


def failing_places(
    prepared: PreparedScene,
    trajectory: Trajectory,
    segment: Index,
    branches: Index,
    fine: FineMesh,
    deadline: Deadline,
) -> Mask:
    """At which of the places that are stated to be left out (p,) no branch of the segment is valid.

    A segment that is not driven at all has every branch.

    Args:
        segment: (c,) of each row in contact; ``branches`` (c,) of these.
    """
    failing = np.zeros(len(trajectory.left_out), dtype=bool)
    if not len(failing):
        return failing
    places = np.array([part.place for part in trajectory.left_out])
    nearest = cKDTree(fine.vertices).query(places)[1]
    at = fine.locate(places, fine.normals[nearest], deadline)
    stated = np.array([part.segment for part in trajectory.left_out])
    every = np.arange(len(prepared.kinematics.branches))
    for number in np.unique(stated).tolist():
        own = branches[(segment == number) & (branches >= 0)]
        asked = np.flatnonzero(stated == number)
        failing[asked] = _out_of_reach(
            prepared, at.points[asked], at.normals[asked], own if len(own) else every, deadline
        )
    return failing


def patches(fine: FineMesh, areas: Array, uncovered: Mask) -> list[tuple[float, Array]]:
    """The parts of what is not covered: area in m² and a place (3,) in each, largest first."""
    rows = np.flatnonzero(uncovered & (areas > 0))
    if not len(rows):
        return []
    part = connected_components(fine.near[rows][:, rows], directed=False)[1]
    sizes = np.bincount(part, areas[rows])
    found = []
    for number in np.argsort(-sizes, kind="stable").tolist():
        own = rows[part == number]
        middle = np.average(fine.vertices[own], axis=0, weights=areas[own])
        nearest = own[np.argmin(np.linalg.norm(fine.vertices[own] - middle, axis=1))]
        found.append((float(sizes[number]), fine.vertices[nearest]))
    return found
