"""Pictures of a labelled surface: by cell, by one color's domain, by segment, by reason.

A solution does not say where a cutting path runs inside a divided cell. So the picture by segment
shows a painting of it (:mod:`cellcolor.painting.paint`), that is, one possible cut, on a mesh that
is refined where necessary.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Index
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
from cellcolor.painting.paint import Painted, paint
from cellcolor.pictures.mesh_picture import SurfaceView, draw_surface
from cellcolor.pictures.picture import (
    FAINT,
    GREY,
    PAINTS,
    REASONS,
    WARNING,
    Picture3D,
    VertexClass,
    mixed,
    paints_of,
)

CUT, OTHERS = "#666666", "#F3F1EA"
_MOST_MARKED = 8  # vertices of a plan that is not valid


def draw_cells(surface: LabelledSurface, decomposition: Decomposition) -> Picture3D:
    """Every cell in the paint of its color; of several colors their paints are mixed."""
    cells = decomposition.instance.cells
    classes = [
        VertexClass(
            f"cell {cell.id} {{{', '.join(map(str, cell.colors))}}}",
            fill_of(surface, cell.colors),
            str(cell.id),
        )
        for cell in cells
    ]
    title = f"{surface.name}: {count(len(cells), 'cell')}"
    view = with_shares(surface, title, np.array(decomposition.vertex_cell, dtype=np.int64), classes)
    notes = ("Cell: {available colors}, share of the surface.", *surface_notes(surface))
    notes += tuple(f"{number}: {name}" for number, name in enumerate(surface.colors))
    return draw_surface(surface, replace(view, cracks=surface.crack_colors, notes=notes))


def draw_color(surface: LabelledSurface, color: int) -> Picture3D:
    """Where one color is available, and where only others are."""
    name = surface.colors[color]
    labels = [0 if color in own else 1 if own else -1 for own in surface.vertex_colors]
    view = with_shares(
        surface,
        f"{surface.name}: color {color}, {name}",
        np.array(labels, dtype=np.int64),
        [VertexClass(name, fill_of(surface, [color])), VertexClass("other colors only", OTHERS)],
    )
    cracks = [pair for pair, colors in surface.crack_colors.items() if color in colors]
    notes = ("Shares of the surface. Cracks are those of this color.",)
    return draw_surface(surface, replace(view, cracks=cracks, notes=notes))


def draw_segments(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> Picture3D:
    """Every segment of a valid solution in the paint of its color.

    Args:
        solution: a valid one of the graph, with a division.

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
    plain = segment_classes(surface, [color[number] for number in range(segments)])
    classes = [
        replace(one, name=f"{one.name}, {percent(*own)}")
        for one, own in zip(plain, share.segments, strict=True)
    ]
    classes.append(VertexClass("cut between segments", CUT))
    notes = [
        f"Status: {solution.status}. Shares of the surface. Black lines: borders of cells.",
        *surface_notes(surface),
    ]
    if not share.certain:
        notes.append("Ranges: the cut through a divided cell may run anywhere.")
    if divided:
        named = f"{'cell' if len(divided) == 1 else 'cells'} {listed(divided)}"
        drawn = "One possible cut is drawn, also in black."
        notes.append(f"Divided: {named}. {drawn if decomposition.curves else 'Not painted.'}")
    if added := len(fine.vertices) - len(surface.vertices):
        notes.append(f"The mesh is refined for this: {count(added, 'vertex', 'vertices')} more.")
    view = SurfaceView(
        f"{surface.name}: {segments_and_lift_offs(segments)}",
        labels,
        classes + bare_classes(*bare),
        # Borders separate these numbers: one for each pair of cell and segment, so that cuts are
        # drawn as well.
        borders=cells[stands_for] * (int(labels.max(initial=0)) + 1) + labels,
        cracks=fine.crack_colors,
        notes=tuple(notes),
    )
    return draw_surface(fine, view)


def by_segment(painted: Painted) -> SurfaceView:
    """Each segment of a painting in the paint of its color."""
    count = int(painted.segment_of.max(initial=-1)) + 1  # more than are left if some are merged
    return _of_plan(painted.surface, painted.plan, painted.segment_of, count)


def draw_plan(surface: LabelledSurface, plan: Plan, marked: tuple[int, ...] = ()) -> Picture3D:
    """The segments of another planner's plan, or the vertices that make it invalid.

    Args:
        marked: vertices to be pointed at; the borders of their segments are marked as well.

    Raises:
        InputError: the plan has another number of vertices.
    """
    if len(plan.vertex_colors) != len(surface.vertices):
        given, wanted = len(plan.vertex_colors), len(surface.vertices)
        message = f"has {given} entries for {count(wanted, 'vertex', 'vertices')}"
        raise InputError(None, "vertex_colors", message)
    report = check_plan(surface, plan)
    if report.segments is None:
        faults = list(dict.fromkeys(fault.vertex for fault in report.violations))
        labels = np.zeros(len(surface.vertices), dtype=np.int64)
        labels[faults] = 1
        view = SurfaceView(
            f"{surface.name}: no valid plan, {count(len(faults), 'vertex', 'vertices')} wrong",
            labels,
            [VertexClass("nothing wrong", OTHERS), VertexClass("wrong color, or none", WARNING)],
            cracks=surface.crack_colors,
            marked=faults[:_MOST_MARKED],
        )
        return draw_surface(surface, view)
    own = np.array(report.segment_of, dtype=np.int64)
    view = _of_plan(surface, plan, own, report.segments)
    notes = ["A plan: one color per vertex. Shares of the surface.", *surface_notes(surface)]
    view = replace(view, cracks=surface.crack_colors, notes=tuple(notes), marked=marked)
    return draw_surface(surface, view)


def _of_plan(surface: LabelledSurface, plan: Plan, segment_of: Index, segments: int) -> SurfaceView:
    color_of = dict(zip(segment_of.tolist(), plan.vertex_colors, strict=True))
    classes = segment_classes(surface, [color_of.get(number) for number in range(segments)])
    title = f"{surface.name}: plan with {segments_and_lift_offs(segments)}"
    return with_shares(surface, title, segment_of, classes)


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
        VertexClass(f"{names[code]}, {share[code]}, {counts[code]} vertices", fills[code])
        for code in range(given_up + 1)
    ]
    who = "any branch" if branch is None else reasons_of.branches[branch]
    notes = ["Shares of the surface."]
    if branch is None:
        notes.insert(0, "The reason of the branch that passed the most tests.")
    return SurfaceView(f"{surface.name}: reach of {who}", labels, classes, notes=tuple(notes))


def with_shares(
    surface: LabelledSurface, title: str, labels: Index, classes: Sequence[VertexClass]
) -> SurfaceView:
    """A view of classes and of what has no color, each with its share of the surface.

    Args:
        labels: (n,) the class of each vertex, -1 where it has no color.
    """
    labels = np.where(labels < 0, bare_labels(surface, len(classes)), labels)
    share = shares(surface, labels, len(classes) + 2)
    named = [
        replace(one, name=f"{one.name}, {own}") for one, own in zip(classes, share, strict=False)
    ]
    return SurfaceView(title, labels, named + bare_classes(*share[len(classes) :]))


def segment_classes(surface: LabelledSurface, colors: Sequence[int | None]) -> list[VertexClass]:
    """Segments 0, 1, … by their colors, None where one has no vertex."""
    return [
        VertexClass(
            f"segment {number}: {'empty' if color is None else surface.colors[color]}",
            fill_of(surface, () if color is None else [color]),
            str(number),
        )
        for number, color in enumerate(colors)
    ]


def fill_of(surface: LabelledSurface, colors: Collection[int]) -> str:
    """What is painted where each of these colors is available, or the only one chosen."""
    paints = paints_of(surface.colors)
    return mixed(paints[surface.colors[color]] for color in colors)


def surface_notes(surface: LabelledSurface) -> tuple[str, ...]:
    """What has to be said where colors share paints."""
    repeated = len(surface.colors) > len(PAINTS)
    return ("Paints repeat: the numbers and names tell areas apart.",) * repeated


def bare_labels(surface: LabelledSurface, first: int) -> Index:
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
        VertexClass(f"{UNREACHABLE}, {unreachable}", FAINT),
        VertexClass(f"{GIVEN_UP}, {given_up}", GREY),
    ]


def shares(surface: LabelledSurface, labels: Index, count: int) -> list[str]:
    """Each class's share of the surface, as text."""
    owned = surface.vertex_areas
    sums = np.bincount(labels, owned, minlength=count)
    whole = float(owned.sum()) or 1.0
    return [percent(value / whole, value / whole) for value in sums]
