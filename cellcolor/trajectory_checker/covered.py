"""How much of the reachable area the passes come near, measured along the surface."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import Deadline
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.trajectory_checker.contact import Contact
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located

FAR, NEAR = 1.5, 0.75  # spacings; from a pass to what counts as covered, as closely covered


@dataclass(frozen=True)
class Reached:
    """What the passes come near to, and what they rightly do not.

    Attributes:
        fine: the surface, refined.
        spacing: the setup's, between passes, m.
        areas: (n,) how much area with a color each vertex of the fine mesh stands for, m².
        distance: (n,) to the nearest pass along the surface, m; infinite beyond ``FAR`` spacings.
        right: (n,) which are rightly left out.
    """

    fine: FineMesh
    spacing: float
    areas: Array
    distance: Array
    right: Mask

    @property
    def total(self) -> float:
        """All of the area with a color, m²."""
        return float(self.areas.sum())

    @property
    def near(self) -> Mask:
        """(n,) which are covered."""
        return np.asarray(self.distance <= FAR * self.spacing)

    @property
    def missed(self) -> Mask:
        """(n,) which have area and are not closely covered, whether that is right or not."""
        return np.asarray((self.areas > 0) & (self.distance > NEAR * self.spacing))

    @property
    def uncovered(self) -> Mask:
        """(n,) what no pass comes near to, and is not rightly left out."""
        return self.missed & ~self.near & ~self.right

    def share(self, of: Mask) -> float:
        """What share of the area some vertices (n,) have."""
        return float(self.areas[of].sum() / self.total) if self.total else 0.0

    def patches(self, of: Mask) -> list[tuple[float, Array]]:
        """The connected parts of some vertices: area in m² and a place (3,), largest first."""
        rows = np.flatnonzero(of & (self.areas > 0))
        if not len(rows):
            return []
        part = connected_components(self.fine.near[rows][:, rows], directed=False)[1]
        sizes = np.bincount(part, self.areas[rows])
        found = []
        for number in np.argsort(-sizes, kind="stable").tolist():
            own = rows[part == number]
            middle = np.average(self.fine.vertices[own], axis=0, weights=self.areas[own])
            nearest = own[np.argmin(np.linalg.norm(self.fine.vertices[own] - middle, axis=1))]
            found.append((float(sizes[number]), self.fine.vertices[nearest]))
        return found


def covered_by(
    built: BuildResult,
    contact: Contact,
    fine: FineMesh,
    spacing: float,
    stated: Iterable[int],
    deadline: Deadline,
) -> Reached:
    """What passes cover, and what is rightly left out.

    The trajectory has to state that it leaves something out. Beside a pass of a segment of which
    that is stated, the configuration of the segment's own branch must not be valid. Far from every
    pass nothing tells which segment is meant, so there no branch may be valid.

    Args:
        stated: the segments of which the trajectory states to leave something out.
    """
    distance, nearest = reach(fine, contact.at, FAR * spacing)
    right = np.zeros(len(fine.vertices), dtype=bool)
    # Of each vertex of the fine mesh what is part of a vertex with a color.
    colored: Mask = np.any(built.node_color >= 0, axis=1)
    third = np.where(colored[fine.owner], fine.mesh.area_faces, 0.0) / 3
    areas = np.bincount(fine.triangles.ravel(), np.repeat(third, 3), len(fine.vertices))
    found = Reached(fine, spacing, areas.astype(np.float64), distance, right)
    beside = np.append(contact.segment, -1)[nearest]
    every = np.arange(len(built.branches))
    regions = [(beside == one, contact.branches[contact.segment == one]) for one in sorted(stated)]
    if regions:
        regions.append((beside < 0, every))
    for region, own in regions:
        asked = np.flatnonzero(found.missed & region)
        places, normals = fine.vertices[asked], fine.normals[asked]
        right[asked] = _out_of_reach(built.prepared, places, normals, own[own >= 0], deadline)
    return found


def reach(fine: FineMesh, located: Located, farthest: float) -> tuple[Array, Index]:
    """Distances along the surface from where the tool has been, up to ``farthest`` (m).

    Ways lead from the places of contact to the corners of their small triangles and their
    neighbors, and on from vertex to vertex.

    Returns:
        Of each vertex of the fine mesh (n,) the distance to the nearest place, infinite beyond the
        farthest, and which place that is, -1 beyond it.
    """
    n, places = len(fine.vertices), len(located.points)
    if not places:
        return np.full(n, np.inf), np.full(n, -1)
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
    return distance, np.where(np.isfinite(distance), nearest - n, -1)


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


_AREA_SHARE = 1.25  # of the stated area; the planner measures on another mesh than the judge


def judge_left_out(
    prepared: PreparedScene,
    contact: Contact,
    reached: Reached,
    faults: FaultList,
    deadline: Deadline,
) -> None:
    """Note stated places that could have been covered, and stated areas that are not true.

    A stated place is rightly left out if its nearest vertex is, or if the branches of its segment
    fail there: the planner tests other points than the vertices of the fine mesh. A segment that is
    not driven at all has every branch.
    """
    left_out, fine, spacing = faults.trajectory.left_out, reached.fine, reached.spacing
    total, out = reached.total, float(reached.areas[reached.right].sum())
    stated = sum(part.area_m2 for part in left_out)
    if left_out and out > _AREA_SHARE * stated + np.pi * spacing**2:
        faults.add("claim", f"{stated:.6f} m² are announced as left out, and {out:.6f} m² are")
    wrong = reached.uncovered
    for part in left_out:
        place = np.array(part.place)
        if not 0 <= part.area_m2 <= total:
            text = f"segment {part.segment}: {part.area_m2:.6f} m² left out of {total:.6f} m²"
            faults.add("claim", text, place=place)
        apart = np.linalg.norm(fine.vertices - place, axis=1)
        at = int(np.argmin(apart))
        if apart[at] > spacing:
            text = f"segment {part.segment}: a place announced as left out is not on the surface"
            faults.add("claim", text, place=place)
        elif wrong[at]:
            there = fine.locate(place[None], fine.normals[at][None], deadline)
            own = contact.branches[(contact.segment == part.segment) & (contact.branches >= 0)]
            branches = own if len(own) else np.arange(len(prepared.arm.kinematics.branches))
            if not _out_of_reach(prepared, there.points, there.normals, branches, deadline)[0]:
                text = (
                    f"segment {part.segment}: announced as left out ({part.reason}), but reachable"
                )
                faults.add("claim", text, place=place)
