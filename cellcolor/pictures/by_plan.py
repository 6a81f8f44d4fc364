"""A labelled surface by the segments of another planner's plan, with what is wrong with it."""

from __future__ import annotations

import numpy as np

from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.pictures.by_cell_and_color import bare_classes, bare_labels, neighboring, shares
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, WARNING, assign
from cellcolor.pictures.picture import Picture3D


class PlanPicture:
    """The surface by the segments of a plan."""

    needs: tuple[Source, ...] = ("surface", "plan")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """Every segment in a fill of its own; the vertices that make a plan invalid marked."""
        return draw_surface(given.surface, by_plan(given.surface, given.plan))


def by_plan(surface: LabelledSurface, plan: Plan) -> SurfaceView:
    """A plan's segments, or where it is not valid.

    Args:
        surface: the labelled surface.
        plan: one color per vertex, valid or not.

    Raises:
        InputError: the plan has another number of vertices.
    """
    if len(plan.vertex_colors) != len(surface.vertices):
        given, wanted = len(plan.vertex_colors), len(surface.vertices)
        message = f"has {given} entries for {count(wanted, 'vertex', 'vertices')}"
        raise InputError(None, "vertex_colors", message)
    report = check_plan(surface, plan)
    if report.segments is None:
        return _invalid(surface, [fault.vertex for fault in report.violations])
    segments, own = report.segments, np.array(report.segment_of, dtype=np.int64)
    labels = np.where(own >= 0, own, bare_labels(surface, segments))
    share = shares(surface, labels, segments + 2)
    fills = assign(neighboring(surface, labels, segments))
    color_of = dict(zip(report.segment_of, plan.vertex_colors, strict=True))
    classes = [
        VertexClass(
            f"segment {number}: {surface.colors[color_of[number] or 0]}  {share[number]}",
            fills[number],
            str(number),
        )
        for number in range(segments)
    ]
    notes = ["A plan: one color per vertex. Shares of the surface."]
    if segments > len(AREAS):
        notes.append("Fills repeat: the numbers identify the segments.")
    lift_offs = count(max(0, segments - 1), "lift-off")
    return SurfaceView(
        f"{surface.name}: plan with {count(segments, 'segment')}, {lift_offs}",
        labels,
        [*classes, *bare_classes(*share[segments:])],
        cracks=surface.crack_colors,
        notes=tuple(notes),
    )


def _invalid(surface: LabelledSurface, wrong: list[int]) -> SurfaceView:
    labels = np.zeros(len(surface.vertices), dtype=np.int64)
    labels[wrong] = 1
    vertices = count(len(wrong), "vertex", "vertices")
    return SurfaceView(
        f"{surface.name}: no valid plan, {vertices} wrong",
        labels,
        [VertexClass("nothing wrong", AREAS[0]), VertexClass("wrong color, or none", WARNING)],
        cracks=surface.crack_colors,
    )
