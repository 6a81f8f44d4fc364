"""Hubs with petals: a cell of all colors, and cells of one color or more all round it."""

from __future__ import annotations

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance


def hub(*petals: int | tuple[int, ...]) -> Instance:
    """A cell of all colors, two at least, with petals in these colors, each in one or more."""
    own = [(its,) if isinstance(its, int) else its for its in petals]
    colors = tuple(range(max(1, *map(max, own)) + 1))
    return Instance(
        "hub",
        tuple(f"color {c}" for c in colors),
        (
            Cell(0, colors, (tuple(range(1, len(petals) + 1)),)),
            *(Cell(i, petal, ((-i,),)) for i, petal in enumerate(own, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, len(petals) + 1)),
    )


def four_colors_in_turn(petals: int) -> Instance:
    """A hub however large, made at once, since no minimum is worked out with it."""
    return hub(*(number % 4 for number in range(petals)))
