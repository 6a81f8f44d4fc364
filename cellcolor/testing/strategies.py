"""Hypothesis strategies: labelled surfaces, instances, and plans that are valid or broken.

For property tests of planners and solvers; needs the package ``hypothesis``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from hypothesis import note
from hypothesis import strategies as st

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.lab.families import planar_graph
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

_Value = TypeVar("_Value")
_SEEDS = st.integers(0, 2**31 - 1)


Rectangle = tuple[int, int, int, int]
"""Column and row of a corner and of the opposite one; what lies beyond the sheet is cut off."""


def sheet(
    columns: int,
    rows: int,
    reach: Sequence[Sequence[Rectangle]],
    cracks: Sequence[tuple[int, int, int]] = (),
) -> LabelledSurface:
    """A sheet of points 1 m apart, on which each color reaches a few rectangles.

    Points in no rectangle are unreachable.

    Args:
        columns: of points, along x, 2 or more.
        rows: of points, along y, 2 or more.
        reach: the rectangles of each color.
        cracks: a column, and two rows: no color is continuous from this column to the next one
            between these rows.
    """
    reached = np.zeros((rows, columns, len(reach)), dtype=bool)
    for color, rectangles in enumerate(reach):
        for x, y, other_x, other_y in rectangles:
            across = slice(min(x, other_x), max(x, other_x) + 1)
            reached[min(y, other_y) : max(y, other_y) + 1, across, color] = True
    colors = [tuple(np.flatnonzero(own).tolist()) for own in reached.reshape(rows * columns, -1)]
    faces = grid_faces(rows, columns)
    y, x = np.mgrid[0:rows, 0:columns]
    points = np.stack([x.ravel(), y.ravel(), np.zeros(rows * columns)], axis=1).astype(np.float64)
    return LabelledSurface(
        "sheet",
        tuple(f"c{color}" for color in range(len(reach))),
        points,
        faces,
        tuple(colors),
        tuple(
            Crack(i, j, shared)
            for i, j in TriangleMesh(points, faces).edges.tolist()
            if (shared := tuple(sorted({*colors[i]} & {*colors[j]})))
            and any(_crosses(i, j, columns, crack) for crack in cracks)
        ),
    )


def _crosses(i: int, j: int, columns: int, crack: tuple[int, int, int]) -> bool:
    """Whether a mesh edge goes from the crack's column to the next one, between its rows."""
    column, row, other_row = crack
    between = range(min(row, other_row), max(row, other_row) + 1)
    return {i % columns, j % columns} == {column, column + 1} and all(
        vertex // columns in between for vertex in (i, j)
    )


def labelled_surfaces(
    largest: int = 12, most_colors: int = 5
) -> st.SearchStrategy[LabelledSurface]:
    """Flat sheets with overlapping colors, unreachable points, cracks and several parts.

    What fails is made smaller, and printed as the call of :func:`sheet`
    that makes it.

    Args:
        largest: vertices along a side, 2 or more.
        most_colors: colors, 1 or more.
    """
    sides, places = st.integers(2, largest), st.integers(0, largest - 1)
    rectangles = st.lists(st.tuples(places, places, places, places), min_size=1, max_size=3)
    found = st.builds(
        sheet,
        sides,
        sides,
        st.lists(rectangles, min_size=1, max_size=most_colors),
        st.lists(st.tuples(places, places, places), max_size=2),
    )
    return _with_import(found, f"from {__name__} import sheet")


@st.composite
def _with_import(draw: st.DrawFn, values: st.SearchStrategy[_Value], line: str) -> _Value:
    """The same values; of one that fails, the line that its call needs is printed as well."""
    value = draw(values)
    note(line)
    return value


def instances(most_cells: int = 10, most_colors: int = 5) -> st.SearchStrategy[Instance]:
    """Planar topological graphs.

    Args:
        most_cells: cells, 1 or more.
        most_colors: colors, 1 or more.
    """
    found = st.integers(1, most_cells).flatmap(
        lambda cells: st.builds(
            planar_graph,
            seed=_SEEDS,
            cells=st.just(cells),
            edges=st.integers(cells, cells + 5),
            colors=st.integers(1, most_colors),
        )
    )
    return _with_import(found, f"from {planar_graph.__module__} import planar_graph")


def valid_plans(surface: LabelledSurface) -> st.SearchStrategy[Plan]:
    """Plans in which every vertex has one of its colors; most are far from optimal."""
    choices = [st.sampled_from(own) if own else st.none() for own in surface.vertex_colors]
    return st.tuples(*choices).map(Plan)


def broken_plans(surface: LabelledSurface) -> st.SearchStrategy[Plan]:
    """Plans that are wrong at one vertex, or have one entry too many or too few.

    A wrong vertex has no color though some reach it, a color that does not reach it, or a number
    that is no color's; each sort of fault that the surface has a place for is as likely as the
    others.
    """
    every = range(len(surface.colors))
    wrong: list[dict[int, list[int | None]]] = [{}, {}, {}]
    for vertex, own in enumerate(surface.vertex_colors):
        if own:
            wrong[0][vertex] = [None]
        if others := [color for color in every if color not in own]:
            wrong[1][vertex] = [*others]
        wrong[2][vertex] = [-1, len(surface.colors)]
    return valid_plans(surface).flatmap(
        lambda plan: st.one_of(
            *(_wrong_at(plan, faults) for faults in wrong if faults),
            st.just(Plan((*plan.vertex_colors, None))),
            *([st.just(Plan(plan.vertex_colors[:-1]))] if plan.vertex_colors else []),
        )
    )


def _wrong_at(plan: Plan, faults: dict[int, list[int | None]]) -> st.SearchStrategy[Plan]:
    """One of the vertices has one of its wrong colors."""
    colors = plan.vertex_colors
    return st.sampled_from(sorted(faults)).flatmap(
        lambda vertex: st.sampled_from(faults[vertex]).map(
            lambda color: Plan((*colors[:vertex], color, *colors[vertex + 1 :]))
        )
    )
