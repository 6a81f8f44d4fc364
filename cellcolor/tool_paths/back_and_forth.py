"""The pattern ``back-and-forth``: parallel lines, walked to and fro, joined at their ends."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.contour import EVENED, FINEST
from cellcolor.tool_paths.distances import evened, off_border, ways_from
from cellcolor.tool_paths.interface import Laid
from cellcolor.tool_paths.level_lines import LevelLine, level_lines, slice_along
from cellcolor.tool_paths.triangles import Triangles

_INSET = 0.5  # spacings: how far from the border lines end


def lay_back_and_forth(mesh: Triangles, spacing: float, deadline: Deadline) -> Laid:
    """Lines at equal distances from one in the middle, each walked once, the nearest one next."""
    mesh = mesh.refined(FINEST * spacing)
    if mesh.border.any():  # the line along which lines end is there to be walked along
        mesh = slice_along(mesh, mesh.from_border, np.array([_INSET * spacing])).mesh
    mesh, field = _sweep_field(mesh)
    deadline.check()
    field = evened(mesh, field, EVENED * spacing)
    low, high = float(field.min()), float(field.max())
    count = max(1, round((high - low) / spacing))
    levels = low + (high - low) * (np.arange(count) + 0.5) / count
    sliced = slice_along(mesh, field, levels)
    mesh = sliced.mesh
    lines = sorted(level_lines(sliced), key=lambda line: line.level)
    rows = [row for line in lines for row in _inside(mesh, line, spacing)]
    return Laid(mesh, _one_after_the_other(mesh, rows, spacing, deadline) if rows else [])


def _sweep_field(mesh: Triangles) -> tuple[Triangles, Array]:
    """A mesh and the distance of its vertices from a line through its middle, m, with a sign.

    For two points p and q at distances a and b, (a² - b²) / (2 pq) is in a plane how far a point
    is along the line from p to q. Four such coordinates are tried: along the part, across it and
    between the two. The one that the part is narrowest along is kept, and its line 0 is where
    distances are measured from, so that level lines are parallel on a curved surface as well.

    Returns:
        The mesh with the middle line among its edges, and the field, from its least to its
        greatest value where the part is narrow.
    """
    far = mesh.distances_from(np.array([0]))
    first = int(far.argmax())
    along = _coordinate(mesh, first, int(mesh.distances_from(np.array([first])).argmax()))
    middle = np.flatnonzero(np.abs(along) <= mesh.lengths.max())
    if len(middle) < 2:
        return mesh, along
    one = int(middle[mesh.distances_from(middle[:1])[middle].argmax()])
    other = int(middle[mesh.distances_from(np.array([one]))[middle].argmax()])
    across = _coordinate(mesh, one, other) if one != other else along
    tried = [across, along, (along + across) / np.sqrt(2), (along - across) / np.sqrt(2)]
    chosen = min(tried, key=lambda field: float(np.ptp(field)))
    # Line 0 lies midway between both ends, if the part has something there.
    chosen = chosen - (chosen.min() + chosen.max()) / 2
    sliced = slice_along(mesh, chosen, np.array([0.0]))
    line = np.flatnonzero(sliced.level == 0)
    if not len(line):
        return mesh, chosen
    return sliced.mesh, np.sign(sliced.values) * sliced.mesh.distances_from(line)


def _coordinate(mesh: Triangles, p: int, q: int) -> Array:
    """How far each vertex is along the line from one vertex to another, 0 midway."""
    a, b = (mesh.distances_from(np.array([end])) for end in (p, q))
    return np.asarray((a**2 - b**2) / (2 * max(float(a[q]), 1e-12)))


def _inside(mesh: Triangles, line: LevelLine, spacing: float) -> list[tuple[list[int], bool]]:
    """The stretches of a line that keep away from the border, and whether they close."""
    row = line.vertices
    if not mesh.border.any():
        return [(row.tolist(), line.closed)]
    kept = mesh.from_border[row] > 0.9 * _INSET * spacing
    if kept.all():
        return [(row.tolist(), line.closed)]
    if line.closed:  # begin where it is interrupted
        start = int(np.flatnonzero(~kept)[0])
        row, kept = np.roll(row, -start), np.roll(kept, -start)
    pieces = np.split(row, np.flatnonzero(np.diff(kept)) + 1)
    wanted = [bool(kept[0]) ^ bool(number % 2) for number in range(len(pieces))]
    return [
        (piece.tolist(), False)
        for piece, own in zip(pieces, wanted, strict=True)
        if own and len(piece) > 1
    ]


def _one_after_the_other(
    mesh: Triangles, rows: list[tuple[list[int], bool]], spacing: float, deadline: Deadline
) -> list[int]:
    """All lines, from the first on; after each the one with an end nearest to where it ends."""
    graph = mesh.graph(off_border(mesh, spacing / 2))
    left = set(range(len(rows)))
    owner = np.full(len(mesh.points), -1, dtype=np.int64)
    for number, (row, closed) in enumerate(rows):
        owner[row if closed else [row[0], row[-1]]] = number
    left.discard(0)
    owner[rows[0][0]] = -1
    walk = list(rows[0][0])
    while left:
        deadline.check()
        way = _nearest(graph, walk[-1], owner, spacing)
        row, closed = rows[int(owner[way[-1]])]
        left.discard(int(owner[way[-1]]))
        owner[row] = -1
        at = row.index(way[-1])
        if closed:
            row = row[at:] + row[:at]
        elif at:
            row = row[::-1]
        walk += [*way[1:-1], *row]
    return walk


def _nearest(graph: csr_matrix, start: int, owner: Index, spacing: float) -> list[int]:
    """The shortest way to an end of a line that is still to be walked."""
    ends = np.flatnonzero(owner >= 0)
    for limit in (4 * spacing, 16 * spacing, np.inf):
        ways = ways_from(graph, np.array([start]), limit)
        if np.isfinite(ways.lengths[ends]).any():
            break
    return ways.back_from(int(ends[ways.lengths[ends].argmin()]))[::-1]
