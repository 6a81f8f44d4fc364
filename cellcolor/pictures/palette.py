"""What things are painted with, told apart also by readers with color-vision deficiencies.

A posture (a color of the surface) has one paint in every picture of a scene: its place in the
scene's list of colors decides which. If there are more postures than paints, paints repeat, so
every picture also has numbers or names.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

PAINTS = (
    "#77AADD",
    "#EE8866",
    "#EEDD88",
    "#44BB99",
    "#FFAABB",
    "#99DDFF",
    "#AAAA00",
    "#BBCC33",
    "#B59BD6",
    "#C9A27A",
    "#7FB7BE",
    "#E3A6DE",
    "#F2B872",
    "#93A8C6",
    "#D9909E",
    "#A8D5A2",
)
"""For postures: light enough for black text. The first eight are the colors of "light" in Paul Tol,
Colour Schemes, 2021, without its grey; the others are as light."""

LINES = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#000000")
"""For curves of plots and small pieces (Okabe and Ito, Color Universal Design, 2008)."""

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
"""Red, for cracks, faults and what is picked out."""


def paints_of(colors: Sequence[str]) -> dict[str, str]:
    """The paint of each color of a surface or instance, by its name, like ``#77AADD``."""
    return {name: PAINTS[number % len(PAINTS)] for number, name in enumerate(colors)}


def mixed(paints: Iterable[str]) -> str:
    """The mean of paints, for what can be in any of them, paler the more they are."""
    parts = [[int(paint[at : at + 2], 16) for at in (1, 3, 5)] for paint in paints] or [[255] * 3]
    mean = np.mean(parts, axis=0)
    pale = mean + (255 - mean) * 0.5 * (1 - 1 / len(parts))
    return "#" + "".join(f"{round(part):02X}" for part in pale)
