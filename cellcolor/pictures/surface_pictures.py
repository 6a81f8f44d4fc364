"""A labelled surface by cell, by one color's domain, by segment, and by reason.

A solution says which borders the sub-cells of a divided cell own, not where the cutting path
runs. What is drawn is its painting (:mod:`cellcolor.painting.paint`): one of the ways in which the
cut can run, on a mesh that is refined where it has to be.
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
from cellcolor.data.wording import count, listed
from cellcolor.decomposition import Decomposition
from cellcolor.errors import InputError
from cellcolor.painting.paint import paint
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, FAINT, GREY, REASONS, WARNING, assign
from cellcolor.pictures.picture import Picture3D

_CUT = "#666666"


def draw_cells(surface: LabelledSurface, decomposition: Decomposition) -> Picture3D:
    """Every cell in a fill of its own, or at least in another one than its neighbors."""
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
    """Where one color is available, and where others are."""
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
    """Every segment of a valid solution in a fill of its own."""
    return draw_surface(*by_solution(surface, decomposition, solution))


def by_solution(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> tuple[LabelledSurface, SurfaceView]:
    """Every segment in a fill of its own, and the surface to draw that on.

    Args:
        surface: the surface.
        decomposition: its topological graph, on the mesh.
        solution: a valid solution of the graph, one that was found.

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
    else:  # where the edges lie is not known: each cell has the first of its segments
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
    lift_offs = count(solution.lift_offs or 0, "lift-off")
    view = SurfaceView(
        f"{surface.name}: {count(segments, 'segment')}, {lift_offs}",
        labels,
        classes,
        # A number for each part of a cell in one segment, so that cuts are drawn as well.
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
    lift_offs = count(max(0, segments - 1), "lift-off")
    title = f"{surface.name}: plan with {count(segments, 'segment')}, {lift_offs}"
    return draw_surface(
        surface, SurfaceView(title, labels, classes, cracks=cracks, notes=tuple(notes))
    )


def draw_reasons(
    surface: LabelledSurface, reasons: CandidateTable, branch: int | None = None
) -> Picture3D:
    """Why vertices are out of reach: see :func:`by_reason`."""
    return draw_surface(surface, by_reason(surface, reasons, branch))


def by_reason(
    surface: LabelledSurface, reasons_of: CandidateTable, branch: int | None = None
) -> SurfaceView:
    """Why vertices are not reachable.

    Args:
        surface: the labelled surface.
        reasons_of: what became of its candidates.
        branch: look at this branch alone. None: at the branch that passed the most
            tests; a vertex is reachable if it has any color.
    """
    rows = slice(None) if branch is None else slice(branch, branch + 1)
    codes, colors = reasons_of.reasons[:, rows], reasons_of.node_color[:, rows]
    valid = (codes == VALID).any(axis=1)
    given_up = len(reasons_of.reason_names)
    # Codes are in the order of the tests; in old files a blocked tip came last, which is the same
    # here, as it is blocked for all branches that reach there.
    labels = np.where(valid, VALID, codes.max(axis=1)).astype(np.int64)
    # A sliver policy takes colors away from what is valid.
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
    """The classes (n,) of vertices without colors, as if all were: see :func:`bare_classes`.

    Args:
        surface: the surface.
        first: the class of what is unreachable; that of what was given up is the one after it.
    """
    labels = np.full(len(surface.vertices), first, dtype=np.int64)
    labels[list(surface.given_up)] = first + 1
    return labels


def bare_classes(unreachable: str, given_up: str) -> list[VertexClass]:
    """What no segment covers, with their shares as text."""
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
    """The classes next to each class 0 … count - 1 over mesh edges; others are not counted."""
    found: dict[int, set[int]] = {label: set() for label in range(count)}
    ends = labels[surface.mesh.edges]
    for a, b in sorted(set(map(tuple, np.concatenate([ends, ends[:, ::-1]]).tolist()))):
        if a != b and a in found and b in found:
            found[a].add(b)
    return found
