"""The pattern ``back-and-forth``: parallel lines, walked to and fro, joined at their ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.sparse import csr_matrix

from cellcolor.arrays import Array, Index, stretches, unit
from cellcolor.deadline import Deadline
from cellcolor.errors import InputError
from cellcolor.tool_paths.contour import EVENED, FINEST
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.triangles import (
    Row,
    Triangles,
    evened,
    level_lines,
    off_border,
    slice_along,
    ways_from,
    with_room_inside,
)

_SPUR = 2.0  # spacings of rows that are missing, for each turn of spurs
_WEAVES = 0.6  # of the inset
_FLAT = 1e-3  # spacings; a part where all is in one row says nothing about directions
_TRIED = 12  # directions, for the fewest turns, besides those of
_BINS = 180  # directions of border edges, the two most common ones
_OPEN = 0.1  # of the area, the least that faces one way on a part that is not closed
_INSET = 0.5  # spacings: how far from the border lines end


def lay_back_and_forth(mesh: Triangles, spacing: float, deadline: Deadline, rows: str = "") -> Laid:
    """Lines at equal distances from one in the middle, each walked once, the nearest one next.

    Args:
        rows: which way they run: ``X,Y,Z`` along that vector, ``around:X,Y,Z`` around that axis,
            ``fewest-turns``; as few lines as possible without.

    Raises:
        InputError: ``rows`` is something else.
    """
    fields = fields_of(rows)
    mesh = mesh.refined(FINEST * spacing)
    if mesh.border.any():  # the line along which lines end is there to be walked along
        mesh = slice_along(mesh, mesh.from_border, np.array([_INSET * spacing])).mesh
    found: list[tuple[Triangles, list[Row]]] = []
    for field in fields(mesh):
        deadline.check()
        if not np.ptp(field) > _FLAT * spacing:  # of a vector along the normal, or of a closed part
            (field,) = fields_of("")(mesh)
        found.append(_rows(*_from_the_middle(mesh, field), spacing))
    cut, lines = min(found, key=lambda one: _turns(one[0], one[1], spacing))
    cut = with_room_inside(cut)
    return Laid(cut, _one_after_the_other(cut, lines, spacing, deadline) if lines else [])


def _turns(mesh: Triangles, rows: list[Row], spacing: float) -> float:
    """About how often the path turns: at each row, and on spurs to what rows leave out."""
    lengths = [np.linalg.norm(np.diff(mesh.points[row], axis=0), axis=1).sum() for row, _ in rows]
    missing = float(mesh.areas.sum()) / spacing - float(sum(lengths))
    return len(rows) + max(0.0, missing) / (_SPUR * spacing)


def _rows(mesh: Triangles, field: Array, spacing: float) -> tuple[Triangles, list[Row]]:
    """A mesh with level lines of a field among its edges, and these, whether they close or not."""
    field = evened(mesh, field, EVENED * spacing)
    low, high = float(field.min()), float(field.max())
    count = max(1, round((high - low) / spacing))
    levels = low + (high - low) * (np.arange(count) + 0.5) / count
    sliced = slice_along(mesh, field, levels)
    lines = sorted(level_lines(sliced), key=lambda line: int(sliced.level[line[0][0]]))
    return sliced.mesh, [row for line in lines for row in _inside(sliced.mesh, line, spacing)]


def fields_of(rows: str) -> Callable[[Triangles], Sequence[Array]]:
    """What gives the fields (n,) whose level lines are tried as rows.

    Raises:
        InputError: ``rows`` is no direction.
    """
    if not rows:
        return lambda mesh: [min(_coordinates(mesh, 4), key=lambda field: float(np.ptp(field)))]
    if rows == "fewest-turns":
        return _all_around
    try:
        vector = np.array([float(one) for one in rows.removeprefix("around:").split(",")])
    except ValueError:
        vector = np.zeros(0)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        message = (
            f"rows of back-and-forth run along X,Y,Z, around:X,Y,Z or fewest-turns, not {rows!r}"
        )
        raise InputError(None, "pattern", message)
    if rows.startswith("around:"):
        return lambda mesh: [mesh.points @ unit(vector)]

    return lambda mesh: [mesh.points @ np.cross(unit(vector), _normal(mesh))]


def _normal(mesh: Triangles) -> Array:
    """The mean unit normal (3,) of a part; 0 of a closed one."""
    total = mesh.area_vectors.sum(axis=0) / 2
    return unit(total) if np.linalg.norm(total) > _OPEN * mesh.areas.sum() else np.zeros(3)


def _all_around(mesh: Triangles) -> list[Array]:
    """Coordinates (n,) across the mean normal at even angles, and one for each straight border."""
    normal = _normal(mesh)
    if not normal.any():
        return _coordinates(mesh, _TRIED)
    u = unit(np.cross(normal, np.eye(3)[np.abs(normal).argmin()]))
    v = np.cross(normal, u)
    steps = np.diff(mesh.points[mesh.edges[mesh.triangles_at == 1]], axis=1)[:, 0]
    angles = np.arctan2(steps @ v, steps @ u) % np.pi
    lengths, bounds = np.histogram(angles, _BINS, (0, np.pi), weights=np.linalg.norm(steps, axis=1))
    best = bounds[:-1][np.argsort(lengths)[-2:]] + np.pi / _BINS / 2
    turns = [*(np.pi * np.arange(_TRIED) / _TRIED), *best]
    return [mesh.points @ (np.cos(turn) * v - np.sin(turn) * u) for turn in turns]


def _from_the_middle(mesh: Triangles, field: Array) -> tuple[Triangles, Array]:
    """The distance of vertices from the level line of a field through the middle, with a sign.

    So level lines are parallel on a curved surface as well.

    Returns:
        The mesh with the middle line among its edges, and the distances, m.
    """
    # Line 0 lies midway between both ends, if the part has something there.
    field = field - (field.min() + field.max()) / 2
    sliced = slice_along(mesh, field, np.array([0.0]))
    line = np.flatnonzero(sliced.level == 0)
    if not len(line):
        return mesh, field
    return sliced.mesh, np.sign(sliced.values) * sliced.mesh.distances_from(line)


def _coordinates(mesh: Triangles, count: int) -> list[Array]:
    """So many coordinates of the vertices (n,) at even angles, the first across the part.

    For two points p and q at distances a and b, (a² - b²) / (2 pq) is in a plane how far a point
    is along the line from p to q.
    """
    far = mesh.distances_from(np.array([0]))
    first = int(far.argmax())
    along = _coordinate(mesh, first, int(mesh.distances_from(np.array([first])).argmax()))
    middle = np.flatnonzero(np.abs(along) <= mesh.lengths.max())
    if len(middle) < 2:
        return [along]
    one = int(middle[mesh.distances_from(middle[:1])[middle].argmax()])
    other = int(middle[mesh.distances_from(np.array([one]))[middle].argmax()])
    across = _coordinate(mesh, one, other) if one != other else along
    turns = np.pi * np.arange(count) / count
    return [np.cos(turn) * across + np.sin(turn) * along for turn in turns]


def _coordinate(mesh: Triangles, p: int, q: int) -> Array:
    """How far each vertex is along the line from one vertex to another, 0 midway."""
    a, b = (mesh.distances_from(np.array([end])) for end in (p, q))
    return np.asarray((a**2 - b**2) / (2 * max(float(a[q]), 1e-12)))


def _inside(mesh: Triangles, line: Row, spacing: float) -> list[Row]:
    """The stretches of a line that keep away from the border."""
    row, closed = np.array(line[0]), line[1]
    if not mesh.border.any():
        return [line]
    kept = mesh.from_border[row] > 0.9 * _INSET * spacing
    # A row beside the border weaves across the line where others end: it is one row.
    near = mesh.from_border[row] > _WEAVES * _INSET * spacing
    for first, after in stretches(~kept):
        if first > 0 and after < len(row):
            kept[first:after] = near[first:after].all()
    if kept.all():
        return [line]
    if closed:  # begin where it is interrupted
        start = int(np.flatnonzero(~kept)[0])
        row, kept = np.roll(row, -start), np.roll(kept, -start)
    kept_runs = [row[first:after].tolist() for first, after in stretches(kept)]
    return [(run, False) for run in kept_runs if len(run) > 1]


def _one_after_the_other(
    mesh: Triangles, rows: list[Row], spacing: float, deadline: Deadline
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
