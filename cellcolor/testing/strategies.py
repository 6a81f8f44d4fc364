"""Hypothesis strategies: labelled surfaces, instances, and plans that are valid or broken.

For property tests of planners and solvers; needs the package ``hypothesis``.
"""

from __future__ import annotations

from hypothesis import strategies as st

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import blobs, planar_graph

__all__ = ["broken_plans", "instances", "labelled_surfaces", "valid_plans"]

_SEEDS = st.integers(0, 2**31 - 1)


def labelled_surfaces(
    largest: int = 12, most_colors: int = 5
) -> st.SearchStrategy[LabelledSurface]:
    """Square sheets with random overlapping colors, some with cracks and with holes.

    Args:
        largest: vertices along a side, 4 or more.
        most_colors: colors, 1 or more.
    """
    return st.builds(
        blobs,
        seed=_SEEDS,
        size=st.integers(4, largest),
        colors=st.integers(1, most_colors),
        cracks=st.integers(0, 3),
        holes=st.integers(0, 2),
    )


def instances(most_cells: int = 10, most_colors: int = 5) -> st.SearchStrategy[Instance]:
    """Planar topological graphs.

    Args:
        most_cells: cells, 1 or more.
        most_colors: colors, 1 or more.
    """
    return st.builds(
        lambda seed, cells, more, colors: planar_graph(seed, cells, cells + more, colors),
        _SEEDS,
        st.integers(1, most_cells),
        st.integers(0, 5),
        st.integers(1, most_colors),
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

    Args:
        surface: the labelled surface.
    """
    return valid_plans(surface).flatmap(lambda plan: _broken(surface, plan))


def _broken(surface: LabelledSurface, plan: Plan) -> st.SearchStrategy[Plan]:
    colors = plan.vertex_colors

    def wrong_at(vertex: int) -> st.SearchStrategy[Plan]:
        own = surface.vertex_colors[vertex]
        others: list[int | None] = [c for c in range(-1, len(surface.colors) + 1) if c not in own]
        wrong = st.sampled_from(others + ([None] if own else []))
        return wrong.map(lambda color: Plan((*colors[:vertex], color, *colors[vertex + 1 :])))

    return st.one_of(
        st.sampled_from(range(len(colors))).flatmap(wrong_at),
        st.just(Plan(colors[:-1])),
        st.just(Plan((*colors, colors[-1]))),
    )
