"""Colors that people with color-vision deficiencies can tell apart.

Where there are more things than colors these repeat, so every picture also has numbers or names.
"""

from __future__ import annotations

from collections.abc import Mapping, Set

__all__ = ["AREAS", "FAINT", "GREY", "INK", "LINES", "REASONS", "WARNING", "assign"]

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
"""Light enough for black text (Paul Tol, Colour Schemes, 2021: "light", without its grey)."""

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
"""For classes with a fixed meaning (Paul Tol: "muted", with a brown of his and a grey)."""

FAINT = "#DDDDDD"
GREY = "#AAAAAA"
INK = "#222222"
WARNING = "#CC3311"


def assign(neighbors: Mapping[int, Set[int]], palette: tuple[str, ...] = AREAS) -> list[str]:
    """A fill for each of the classes 0, 1, …; neighbors differ as long as the palette allows.

    Args:
        neighbors: the classes next to each class; all of them are keys.
        palette: the fills; while there are no more classes than fills none is used twice.

    Returns:
        one fill for each class, in their order.
    """
    uses = [0] * len(palette)
    chosen: dict[int, int] = {}
    for area in sorted(neighbors):
        near = {chosen[other] for other in neighbors[area] if other in chosen}
        best = min(range(len(palette)), key=lambda c: (c in near, uses[c], c))
        uses[best] += 1
        chosen[area] = best
    return [palette[chosen[area]] for area in sorted(chosen)]
