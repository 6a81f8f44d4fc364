"""Hypothesis strategies: labelled surfaces, instances, and plans that are valid or broken.

For property tests of planners and solvers; needs the package ``hypothesis``.
"""

from __future__ import annotations

from hypothesis import strategies as st

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import planar_graph
from cellcolor.testing.sheets import sheet

_SEEDS = st.integers(0, 2**31 - 1)


def labelled_surfaces(
    largest: int = 12, most_colors: int = 5
) -> st.SearchStrategy[LabelledSurface]:
    """Flat sheets with overlapping colors, unreachable points, cracks and several parts.

    What fails is made smaller, and printed as the call of :func:`~cellcolor.testing.sheets.sheet`
    that makes it.

    Args:
        largest: vertices along a side, 2 or more.
        most_colors: colors, 1 or more.
    """
    sides, places = st.integers(2, largest), st.integers(0, largest - 1)
    rectangles = st.lists(st.tuples(places, places, places, places), min_size=1, max_size=3)
    return st.builds(
        sheet,
        sides,
        sides,
        st.lists(rectangles, min_size=1, max_size=most_colors),
        st.lists(st.tuples(places, places, places), max_size=2),
    )


def instances(most_cells: int = 10, most_colors: int = 5) -> st.SearchStrategy[Instance]:
    """Planar topological graphs.

    Args:
        most_cells: cells, 1 or more.
        most_colors: colors, 1 or more.
    """
    return st.integers(1, most_cells).flatmap(
        lambda cells: st.builds(
            planar_graph,
            seed=_SEEDS,
            cells=st.just(cells),
            edges=st.integers(cells, cells + 5),
            colors=st.integers(1, most_colors),
        )
    )


def valid_plans(surface: LabelledSurface) -> st.SearchStrategy[Plan]:
    """Plans in which every vertex has one of its colors; most are far from optimal.

    Args:
        surface: the labelled surface.
    """
    choices = [st.sampled_from(own) if own else st.none() for own in surface.vertex_colors]
    return st.tuples(*choices).map(Plan)


def broken_plans(surface: LabelledSurface) -> st.SearchStrategy[Plan]:
    """Plans that are wrong at one vertex, or have one entry too many or too few.

    A wrong vertex has no color though some reach it, a color that does not reach it, or a number
    that is no color's; each sort of fault that the surface has a place for is as likely as the
    others.

    Args:
        surface: the labelled surface.
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
            *(st.just(Plan(colors)) for colors in _of_wrong_length(plan)),
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


def _of_wrong_length(plan: Plan) -> list[tuple[int | None, ...]]:
    colors = plan.vertex_colors
    return [(*colors, None)] + ([colors[:-1]] if colors else [])
