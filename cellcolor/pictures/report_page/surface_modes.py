"""What the page can show on the part: segments, reach, cells of the proof, points of a front."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.data.bounds import Shown, marks_of
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition
from cellcolor.pictures.mesh_picture import SurfaceView, draw_surface
from cellcolor.pictures.palette import WARNING
from cellcolor.pictures.picture import Picture3D, VertexClass
from cellcolor.pictures.report_page.content import MotionReport
from cellcolor.pictures.surface_pictures import (
    CUT,
    by_reason,
    by_segment,
    segment_classes,
    with_shares,
)
from cellcolor.pictures.why_not_fewer import view_of
from cellcolor.questions.front import Front, FrontPoint


def modes_of(report: MotionReport) -> tuple[list[Picture3D], int]:
    """Pictures of one mesh, and how many of them, the first ones, have a button.

    The others are for rows of tables to show.
    """
    surface, painted = report.built.surface, report.painted
    views = [replace(by_reason(surface, report.built.candidates), title="Out of reach")]
    witness = () if report.solution is None else report.solution.witness
    if len(witness) > 1:
        shown = Shown(marks_of(report.decomposition.instance, witness), (), ())
        proof = view_of(surface, report.decomposition, "Cells of the proof", shown)
        views.append(replace(proof, cracks=()))
    buttons = len(views)
    answered = report.answered
    if answered is not None and len(answered.surface.vertices) == len(surface.vertices):
        views += [
            _front_view(answered.surface, answered.decomposition, point)
            for answer in answered.answers
            if isinstance(answer, Front)
            for point in answer
        ]
    if painted is not None:  # draw on its surface, which may be finer
        surface, original = painted.surface, painted.stands_for
        views = [replace(view, labels=view.labels[original]) for view in views]
        views.insert(0, replace(by_segment(painted), title="Segments"))
        buttons += 1
    return [draw_surface(surface, view) for view in views], buttons


def _front_view(
    surface: LabelledSurface, decomposition: Decomposition, point: FrontPoint
) -> SurfaceView:
    """What a point of a front covers: each cell by its segment.

    Where a cut would run within a cell is not drawn.
    """
    segments = point.segments
    divided, left_out = segments, segments + 1
    left = set(point.left_out)
    kept = [cell.id for cell in decomposition.instance.cells if cell.id not in left]
    of_cell = np.full(len(decomposition.instance.cells) + 1, left_out)
    colors: dict[int, int] = {}
    for division in point.solution.cells or ():
        own = {sub.segment for sub in division.subcells}
        colors |= {sub.segment: sub.color for sub in division.subcells}
        of_cell[kept[division.id]] = own.pop() if len(own) == 1 else divided
    classes = segment_classes(surface, [colors.get(number) for number in range(segments)])
    classes.append(VertexClass("divided between segments", CUT))
    classes.append(VertexClass("left out", WARNING))
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    labels = np.where(cells == OUTSIDE, OUTSIDE, of_cell[cells])
    return with_shares(surface, point.in_short, labels, classes)
