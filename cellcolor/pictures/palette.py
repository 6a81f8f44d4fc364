"""Colors that people with color-vision deficiencies can tell apart.

If there are more things to draw than colors in a palette, colors are used again. So every picture
also has numbers or names.
"""

from __future__ import annotations

from collections.abc import Mapping, Set

AREAS = (
    "#77AADD",
    "#EE8866",
    "#EEDD88",
    "#44BB99",
    "#FFAABB",
    "#99DDFF",
    "#AAAA00",
    "#BBCC33",
)
"""For areas: light enough for black text. These are the colors of "light" in Paul Tol, Colour
Schemes, 2021, without its grey."""

LINES = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#000000")
"""For lines and small pieces (Okabe and Ito, Color Universal Design, 2008)."""

REASONS = (
    "#CC6677",
    "#332288",
    "#DDCC77",
    "#117733",
    "#88CCEE",
    "#882255",
    "#44AA99",
    "#999933",
    "#AA4499",
    "#661100",
    "#777777",
)
"""For the reasons why points are out of reach. These are the colors of Paul Tol's "muted", one of
his browns, and a grey."""

FAINT = "#DDDDDD"
"""The lighter grey, for unreachable points and for what is in the background."""
GREY = "#AAAAAA"
"""The darker grey, for points that were given up."""
INK = "#222222"
"""Nearly black, for borders and text."""
WARNING = "#CC3311"
"""Red, for cracks and for a vertex that is picked out."""


def assign(neighbors: Mapping[int, Set[int]]) -> list[str]:
    """A fill for each area 0, 1, …; neighbors differ as long as there are enough fills.

    No fill is used twice unless there are more areas than fills.

    Args:
        neighbors: the areas next to each area; every area is a key.
    """
    uses = [0] * len(AREAS)
    chosen: dict[int, int] = {}
    for area in sorted(neighbors):
        near = {chosen[other] for other in neighbors[area] if other in chosen}
        best = min(range(len(AREAS)), key=lambda c: (c in near, uses[c], c))
        uses[best] += 1
        chosen[area] = best
    return [AREAS[chosen[area]] for area in sorted(chosen)]
