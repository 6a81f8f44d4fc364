"""Pictures of a labelled surface: by cell, by one color's domain, by segment, by reason.

A solution does not say where a cutting path runs inside a divided cell. So the picture by segment
shows a painting of it (:mod:`cellcolor.painting.paint`), that is, one possible cut, on a mesh that
is refined where necessary.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.candidate_table import VALID, CandidateTable
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.plan import Plan
from cellcolor.data.shares import GIVEN_UP, UNREACHABLE, percent, shares_of
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count, listed, segments_and_lift_offs
from cellcolor.decomposition import Decomposition
from cellcolor.errors import InputError
from cellcolor.painting.paint import paint
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, FAINT, GREY, REASONS, WARNING, assign
from cellcolor.pictures.picture import Picture3D

_CUT = "#666666"


def draw_cells(surface: LabelledSurface, decomposition: Decomposition) -> Picture3D:
    """Every cell in its own fill; with many cells, fills repeat but never between neighbors."""
    instance = decomposition.instance
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    number = len(instance.cells)
    labels = np.where(cells == OUTSIDE, bare_labels(surface, number), cells)
    share = shares(surface, labels, number + 2)
    fills = assign(neighboring(surface, cells, number))
    classes = [
        VertexClass(
            f"cell {cell.id} {{{', '.join(map(str, cell.colors))}}}  {share[cell.id]}",
            fill,
            str(cell.id),
        )
        for cell, fill in zip(instance.cells, fills, strict=True)
    ]
    classes += bare_classes(*share[number:])
    notes = ["Cell: {available colors}, share of the surface."]
    if number > len(AREAS):
        notes.append("Fills repeat: the numbers identify the cells.")
    notes += [f"{number}: {name}" for number, name in enumerate(surface.colors)]
    title = f"{surface.name}: {count(number, 'cell')}"
    cracks = surface.crack_colors
    return draw_surface(
        surface, SurfaceView(title, labels, classes, cracks=cracks, notes=tuple(notes))
    )


def draw_color(surface: LabelledSurface, color: int) -> Picture3D:
    """Where one color is available, and where only others are."""
    covered = np.array(
        [0 if color in own else 1 if own else 2 for own in surface.vertex_colors], dtype=np.int64
    )
    labels = np.where(covered == 2, bare_labels(surface, 2), covered)
    share = shares(surface, labels, 4)
    name = surface.colors[color]
    classes = [
        VertexClass(f"{name}  {share[0]}", AREAS[0]),
        VertexClass(f"other colors only  {share[1]}", AREAS[2]),
        *bare_classes(*share[2:]),
    ]
    cracks = [pair for pair, colors in surface.crack_colors.items() if color in colors]
    note = "Shares of the surface. Cracks are those of this color."
    title = f"{surface.name}: color {color}, {name}"
    return draw_surface(surface, SurfaceView(title, labels, classes, cracks=cracks, notes=(note,)))


def draw_segments(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> Picture3D:
    """Every segment of a valid solution in its own fill."""
    return draw_surface(*by_solution(surface, decomposition, solution))


def by_solution(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> tuple[LabelledSurface, SurfaceView]:
    """The surface to draw a solution on, and every segment there in its own fill.

    Args:
        decomposition: its topological graph.
        solution: a valid solution of the graph, with a division.

    Raises:
        TooLarge: a painting would need too many vertices.
    """
    instance = decomposition.instance
    segments = solution.segments or 0
    divided = [
        cell.id for cell in solution.cells or () if len({sub.segment for sub in cell.subcells}) > 1
    ]
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    if decomposition.curves or not instance.edges:
        painted = paint(surface, decomposition, solution)
        fine, stands_for, segment_of = painted.surface, painted.stands_for, painted.segment_of
    else:  # the mesh does not tell where edges run: each cell gets the first of its segments
        first = np.array([cell.subcells[0].segment for cell in solution.cells or ()] + [-1])
        fine, stands_for, segment_of = surface, np.arange(len(cells)), first[cells]
    labels = np.where(segment_of >= 0, segment_of, bare_labels(fine, segments + 1))
    uncolored = np.where(cells == OUTSIDE, bare_labels(surface, 1), 0)
    bare = shares(surface, uncolored, 3)[1:]
    if not decomposition.curves:
        labels[np.isin(cells, divided)] = segments
    color = {sub.segment: sub.color for cell in solution.cells or () for sub in cell.subcells}
    share = shares_of(instance, solution)
    classes = segment_classes(
        [instance.colors[color[number]] for number in range(segments)],
        [percent(*own) for own in share.segments],
        assign(neighboring(fine, labels, segments)),
    )
    classes.append(VertexClass("cut between segments", _CUT))
    classes += bare_classes(*bare)
    notes = [f"Status: {solution.status}. Shares of the surface. Black lines: borders of cells."]
    if not share.certain:
        notes.append("Ranges: the cut through a divided cell may run anywhere.")
    if segments > len(AREAS):
        notes.append("Fills repeat: the numbers identify the segments.")
    if divided:
        named = f"{'cell' if len(divided) == 1 else 'cells'} {listed(divided)}"
        drawn = "One possible cut is drawn, also in black."
        notes.append(f"Divided: {named}. {drawn if decomposition.curves else 'Not painted.'}")
    if added := len(fine.vertices) - len(surface.vertices):
        notes.append(f"The mesh is refined for this: {count(added, 'vertex', 'vertices')} more.")
    view = SurfaceView(
        f"{surface.name}: {segments_and_lift_offs(segments)}",
        labels,
        classes,
        # Borders separate these numbers: one for each pair of cell and segment, so that cuts are
        # drawn as well.
        borders=cells[stands_for] * (int(labels.max(initial=0)) + 1) + labels,
        cracks=fine.crack_colors,
        notes=tuple(notes),
    )
    return fine, view


def draw_plan(surface: LabelledSurface, plan: Plan) -> Picture3D:
    """The segments of another planner's plan, or the vertices that make it invalid.

    Raises:
        InputError: the plan has another number of vertices.
    """
    if len(plan.vertex_colors) != len(surface.vertices):
        given, wanted = len(plan.vertex_colors), len(surface.vertices)
        message = f"has {given} entries for {count(wanted, 'vertex', 'vertices')}"
        raise InputError(None, "vertex_colors", message)
    report = check_plan(surface, plan)
    cracks = surface.crack_colors
    if report.segments is None:
        labels = np.zeros(len(surface.vertices), dtype=np.int64)
        labels[[fault.vertex for fault in report.violations]] = 1
        wrong = count(len(report.violations), "vertex", "vertices")
        classes = [
            VertexClass("nothing wrong", AREAS[0]),
            VertexClass("wrong color, or none", WARNING),
        ]
        title = f"{surface.name}: no valid plan, {wrong} wrong"
        return draw_surface(surface, SurfaceView(title, labels, classes, cracks=cracks))
    segments, own = report.segments, np.array(report.segment_of, dtype=np.int64)
    labels = np.where(own >= 0, own, bare_labels(surface, segments))
    share = shares(surface, labels, segments + 2)
    color_of = dict(zip(report.segment_of, plan.vertex_colors, strict=True))
    classes = segment_classes(
        [surface.colors[color_of[number] or 0] for number in range(segments)],
        share[:segments],
        assign(neighboring(surface, labels, segments)),
    )
    classes += bare_classes(*share[segments:])
    notes = ["A plan: one color per vertex. Shares of the surface."]
    if segments > len(AREAS):
        notes.append("Fills repeat: the numbers identify the segments.")
    title = f"{surface.name}: plan with {segments_and_lift_offs(segments)}"
    return draw_surface(
        surface, SurfaceView(title, labels, classes, cracks=cracks, notes=tuple(notes))
    )


def draw_reasons(
    surface: LabelledSurface, reasons: CandidateTable, branch: int | None = None
) -> Picture3D:
    """Why vertices cannot be reached: see :func:`by_reason`."""
    return draw_surface(surface, by_reason(surface, reasons, branch))


def by_reason(
    surface: LabelledSurface, reasons_of: CandidateTable, branch: int | None = None
) -> SurfaceView:
    """Every vertex in the fill of its reason for being out of reach.

    Args:
        reasons_of: the verdict on every configuration that was tried.
        branch: show this branch alone. None shows for each vertex the branch that passed the most
            tests; then a vertex is reachable if it has any color.
    """
    rows = slice(None) if branch is None else slice(branch, branch + 1)
    codes, colors = reasons_of.reasons[:, rows], reasons_of.node_color[:, rows]
    valid = (codes == VALID).any(axis=1)
    given_up = len(reasons_of.reason_names)
    # Codes ascend in the order of the tests, so the largest is that of the branch that got
    # farthest. In old files "tip blocked" is the largest code. That makes no difference, because
    # a blocked tip is blocked in all branches that reach the vertex.
    labels = np.where(valid, VALID, codes.max(axis=1)).astype(np.int64)
    # Valid, but without color: the sliver policy took it away.
    labels[valid & (colors < 0).all(axis=1)] = given_up
    share = shares(surface, labels, given_up + 1)
    counts = np.bincount(labels, minlength=given_up + 1)
    names = [*reasons_of.reason_names, GIVEN_UP]
    names[VALID] = "reachable" if branch is None else "valid"
    fills = [REASONS[(code - 1) % len(REASONS)] for code in range(given_up + 1)]
    fills[VALID] = FAINT
    classes = [
        VertexClass(f"{names[code]}  {share[code]}, {counts[code]} vertices", fills[code])
        for code in range(given_up + 1)
    ]
    who = "any branch" if branch is None else reasons_of.branches[branch]
    notes = ["Shares of the surface."]
    if branch is None:
        notes.insert(0, "The reason of the branch that passed the most tests.")
    return SurfaceView(f"{surface.name}: reach of {who}", labels, classes, notes=tuple(notes))


def segment_classes(
    colors: Sequence[str], share: Sequence[str], fills: Sequence[str], between: str = "  "
) -> list[VertexClass]:
    """Segments 0, 1, … by their colors, their shares as text and their fills."""
    return [
        VertexClass(f"segment {number}: {color}{between}{own}", fill, str(number))
        for number, (color, own, fill) in enumerate(zip(colors, share, fills, strict=True))
    ]


def bare_labels(surface: LabelledSurface, first: int) -> Labels:
    """For every vertex (n,) the class that it has if it has no color: see :func:`bare_classes`.

    Args:
        first: the class "unreachable"; the next number is the class "given up".
    """
    labels = np.full(len(surface.vertices), first, dtype=np.int64)
    labels[list(surface.given_up)] = first + 1
    return labels


def bare_classes(unreachable: str, given_up: str) -> list[VertexClass]:
    """The two classes of vertices without color, with their shares as text."""
    return [
        VertexClass(f"{UNREACHABLE}  {unreachable}", FAINT),
        VertexClass(f"{GIVEN_UP}  {given_up}", GREY),
    ]


def shares(surface: LabelledSurface, labels: Labels, count: int) -> list[str]:
    """Each class's share of the surface, as text."""
    owned = surface.vertex_areas
    sums = np.bincount(labels, owned, minlength=count)
    whole = float(owned.sum()) or 1.0
    return [percent(value / whole, value / whole) for value in sums]


def neighboring(surface: LabelledSurface, labels: Labels, count: int) -> dict[int, set[int]]:
    """For each class 0 … count - 1 those of them that are next to it across a mesh edge."""
    found: dict[int, set[int]] = {label: set() for label in range(count)}
    ends = labels[surface.mesh.edges]
    for a, b in sorted(set(map(tuple, np.concatenate([ends, ends[:, ::-1]]).tolist()))):
        if a != b and a in found and b in found:
            found[a].add(b)
    return found
