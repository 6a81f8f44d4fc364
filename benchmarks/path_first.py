"""What planners pay that choose the path first: ``python benchmarks/path_first.py [SCENE.toml …]``.

Measures, for each scene, the fewest changes of branch along a raster path over the part of the
surface that a solution covers: the best, the median and the worst of 18 directions, beside the
proved minimum. Going from one sample to the next in the same branch counts as continuous, and
passing what is out of reach costs nothing, so no planner that follows this path pays less.
docs/paper.md has the table.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

import cellcolor
from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.surface import LabelledSurface
from cellcolor.frontend import BuildResult, build_surface

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = [ROOT / "instances" / "scenes", ROOT / "instances" / "parts"]
REFUSED = "torus_refused"  # no minimum to compare with
DIRECTIONS = 18
SPACING = 0.010  # m, as in the setups
_STEP, _TURN = 0.0025, np.radians(2.0)  # m, rad; samples are not farther apart
_CLOSED = 0.2  # of its area: a surface whose normals add up to less has no side to be seen from

# A place on the mesh: on the mesh edge from the first vertex to the second, this part of the way.
_Place = tuple[int, int, float]


@dataclass(frozen=True)
class Raster:
    """A path over a surface, in samples; from each one to the next it goes straight in a triangle.

    Attributes:
        points: (n, 3), m.
        normals: (n, 3), outward unit vectors, interpolated in the triangles.
        starts: samples that the path does not go to from the one before, the first among them: the
            surface falls apart there.
    """

    points: Array
    normals: Array
    starts: Index


def fewest_lift_offs(valid: Mask) -> Index:
    """Where the branch changes along a path, for the fewest changes.

    Staying in a branch for as long as any lasts is best: whoever changes earlier is not further on
    at the next change.

    Args:
        valid: (n, branches) which branches reach each point of the path, one at least.

    Returns:
        The samples at which another branch begins, without the first.
    """
    changes = []
    left = valid[0]
    for sample, here in enumerate(valid):
        left = left & here
        if not left.any():
            changes.append(sample)
            left = here
    return np.array(changes, dtype=np.int64)


def counted(built: BuildResult, angle: float) -> tuple[Raster, Mask, Index]:
    """The raster path in one direction, (n,) its samples in reach, and the changes among these."""
    prepared = built.prepared
    # Points that a sliver policy gave up are left out on both sides of the comparison.
    covered = (built.node_color >= 0).any(axis=1)
    path = raster(built.surface, prepared.surface.normals, covered, angle, SPACING)
    found = prepared.arm.inverse(path.points, -path.normals)
    verdicts = prepared.judge(found.reshape(-1, found.shape[2]))
    valid: Mask = (verdicts.reasons == VALID).reshape(found.shape[:2])
    reached: Mask = valid.any(axis=1)
    return path, reached, fewest_lift_offs(valid[reached])


def raster(
    surface: LabelledSurface, normals: Array, reachable: Mask, angle: float, spacing: float
) -> Raster:
    """A raster path over the part of a surface that can be reached.

    The surface is cut by planes at the spacing. They contain the line of sight along which its
    normals point on average, or the vertical if it is closed. Of the passes that one plane gives
    the nearest is next, and between passes the path goes along mesh edges, the shortest way. Where
    the surface runs along the planes, passes are farther apart.

    Args:
        surface: the surface.
        normals: (n, 3) outward, at its vertices.
        reachable: (n,) only triangles are cut of which all vertices are.
        angle: of the planes about that line of sight, rad.
        spacing: between planes, m.
    """
    vertices, faces = surface.vertices, surface.faces[reachable[surface.faces].all(axis=1)]
    across = vertices @ _across(surface, angle)
    i, j = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
    pairs = np.unique(np.sort(np.stack([i, j], axis=1), axis=1), axis=0).T
    lengths = np.linalg.norm(vertices[pairs[0]] - vertices[pairs[1]], axis=1)
    edges = coo_array((lengths, tuple(pairs)), shape=(len(vertices),) * 2).tocsr()
    trail: list[_Place] = []
    starts = [0]
    for level in np.arange(across[faces].min() + spacing / 2, across[faces].max(), spacing):
        passes = _passes(faces, across, float(level))
        while passes:
            chosen = _nearest(vertices, trail, passes)
            if trail:
                way = _way(vertices, edges, trail[-1], chosen[0])
                if way is None:
                    starts.append(len(trail))
                else:
                    trail += way
            trail += chosen
    return _sampled(vertices, normals, trail, starts)


def _across(surface: LabelledSurface, angle: float) -> Array:
    """The unit vector (3,) on which planes stand."""
    sight = surface.mesh.area_vectors.sum(axis=0)
    if np.linalg.norm(sight) < _CLOSED * 2 * surface.mesh.areas.sum():
        sight = np.array([0.0, 0.0, 1.0])
    # The two other right singular vectors of the line of sight are a basis of the plane.
    plane = np.linalg.svd(sight[None])[2][1:]
    across: Array = plane[1] * np.cos(angle) - plane[0] * np.sin(angle)
    return across


def _passes(faces: Index, across: Array, level: float) -> list[list[_Place]]:
    """The polylines in which a plane cuts triangles; a closed one ends where it begins."""
    above = across > level
    cut = faces[above[faces].any(axis=1) & ~above[faces].all(axis=1)]
    ends: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for corners in cut.tolist():
        first, second = [
            (min(a, b), max(a, b))
            for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
            if above[a] != above[b]
        ]
        ends.setdefault(first, []).append(second)
        ends.setdefault(second, []).append(first)
    found = []
    # Open polylines first, from one of their ends; what is left then is closed.
    for start in [edge for edge in ends if len(ends[edge]) == 1] + list(ends):
        if start not in ends:
            continue
        chain, here = [start], start
        while ends.get(here):
            after = ends[here].pop()
            ends[after].remove(here)
            if not ends[here]:
                del ends[here]
            chain.append(after)
            here = after
        ends.pop(here, None)
        parts = [(level - across[a]) / (across[b] - across[a]) for a, b in chain]
        found.append([(a, b, float(part)) for (a, b), part in zip(chain, parts, strict=True)])
    return found


def _nearest(vertices: Array, trail: list[_Place], passes: list[list[_Place]]) -> list[_Place]:
    """Take out the pass that begins nearest to the end of the trail, and turn it to begin there."""
    if not trail:
        return passes.pop(0)
    here = _points(vertices, trail[-1:])
    begins = [
        (number, k)
        for number, places in enumerate(passes)
        for k in (range(len(places)) if places[0] == places[-1] else (0, len(places) - 1))
    ]
    away = _points(vertices, [passes[number][k] for number, k in begins]) - here
    number, k = begins[int(np.linalg.norm(away, axis=1).argmin())]
    places = passes.pop(number)
    if places[0] == places[-1]:
        return places[k:-1] + places[: k + 1]
    return places if k == 0 else places[::-1]


def _way(vertices: Array, edges: coo_array, start: _Place, end: _Place) -> list[_Place] | None:
    """The shortest way along mesh edges between two places, None if there is none."""
    if shared := set(start[:2]) & set(end[:2]):
        return [(min(shared), min(shared), 0.0)]
    begin, finish = _points(vertices, [start, end])
    sources, goals = list(set(start[:2])), list(set(end[:2]))
    lengths, before = dijkstra(edges, False, sources, return_predecessors=True)
    total = lengths[:, goals] + np.linalg.norm(vertices[goals] - finish, axis=1)
    total += np.linalg.norm(vertices[sources] - begin, axis=1)[:, None]
    source, goal = np.unravel_index(int(total.argmin()), total.shape)
    if np.isinf(total[source, goal]):
        return None
    way, vertex = [], goals[goal]
    while vertex >= 0:
        way.append((vertex, vertex, 0.0))
        vertex = int(before[source, vertex])
    return way[::-1]


def _points(vertices: Array, places: list[_Place]) -> Array:
    """Where places are, (n, 3) in m."""
    a, b, part = (np.array(column) for column in zip(*places, strict=True))
    return np.asarray((1 - part[:, None]) * vertices[a] + part[:, None] * vertices[b])


def _sampled(vertices: Array, normals: Array, trail: list[_Place], starts: list[int]) -> Raster:
    """The trail in samples that are close to each other."""
    points, slanted = _points(vertices, trail), _points(normals, trail)  # linear in the triangles
    upright = slanted / np.linalg.norm(slanted, axis=1, keepdims=True)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    turns = np.linalg.norm(np.diff(upright, axis=0), axis=1)
    pieces = np.maximum(1, np.ceil(np.maximum(steps / _STEP, turns / _TURN))).astype(int)
    pieces[np.array(starts[1:], dtype=np.int64) - 1] = 1
    firsts = np.concatenate([[0], np.cumsum(pieces)])
    # Place number 1.5 is half way from the second to the third.
    numbers = np.interp(np.arange(firsts[-1] + 1), firsts, np.arange(len(points)))
    low = np.minimum(numbers.astype(int), len(points) - 2)
    way = (numbers - low)[:, None]
    fine = (1 - way) * points[low] + way * points[low + 1]
    tilted = (1 - way) * slanted[low] + way * slanted[low + 1]
    unit = tilted / np.linalg.norm(tilted, axis=1, keepdims=True)
    return Raster(fine, unit, firsts[np.array(starts, dtype=np.int64)])


def row(file: Path) -> str:
    """The table's row of one scene."""
    built = build_surface(file)
    each = [len(counted(built, angle)[2]) for angle in np.arange(DIRECTIONS) * np.pi / DIRECTIONS]
    proved = cellcolor.solve(built).solution
    assert proved.proved_for_surface
    return f"| {file.stem} | {min(each)}, {median(each):g}, {max(each)} | {proved.lift_offs} |"


def main(files: list[Path]) -> None:
    """Print the table."""
    print("| scene | path first: best, median, worst | fewest, proved |\n|---|--:|--:|")
    for file in files or [file for folder in FOLDERS for file in sorted(folder.glob("*.toml"))]:
        if file.stem != REFUSED:
            print(row(file), flush=True)


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
