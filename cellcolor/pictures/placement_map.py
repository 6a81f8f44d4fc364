"""A map of placements, with Matplotlib: where a part was tried, and with how many lift-offs."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.pictures.palette import GREY, INK, LINES
from cellcolor.pictures.static import STYLE, saved
from cellcolor.questions.placements import VARIABLES, PlacedMinimum, Placements

_TOO_LITTLE = "covers too little"
_MARKS: dict[str, dict[str, Any]] = {
    "where it stands": {"marker": "+", "color": INK, "s": 120},
    "among the best": {"facecolors": "none", "edgecolors": INK, "s": 110},
    "the part cannot stand there": {"marker": "x", "color": GREY, "s": 16},
    _TOO_LITTLE: {"marker": ".", "color": GREY, "s": 24},
    "no answer in time": {"marker": "1", "color": GREY, "s": 24},
}


def render_placements(found: Placements, kind: str) -> bytes:
    """All placements that were tried, over one or two of the variables that were moved.

    Each that covers enough is a dot in the color of its lift-offs, hollow where that is a lower
    bound. Of more than two variables, the map shows the first two.

    Args:
        kind: ``png`` or ``svg``.

    Raises:
        InputError: no placement but that of the scene was tried.
    """
    rows = [*found]
    poses = np.array([row.pose for row in rows])
    moved = [axis for axis, spread in enumerate(np.ptp(poses, axis=0)) if spread > 0][:2]
    if not moved:
        raise InputError(None, "map", "there is nothing to draw: one placement was tried")
    labels = [
        f"{VARIABLES[axis]}, {'m' if axis < len(VARIABLES) // 2 else 'rad'}" for axis in moved
    ]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 6), dpi=150, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        drawn = set()
        for row, pose in zip(rows, poses, strict=True):
            at = [*pose[moved], row.least_lift_offs or 0][:2]
            for label, style in _styles(row, found):
                axes.scatter(*at, label="" if label in drawn else label, **style)
                drawn.add(label)
        axes.set_xlabel(labels[0])
        axes.set_ylabel([*labels, "lift-offs"][1])
        axes.set_title(f"{found.name}: placements that were tried", loc="left")
        figure.legend(loc="outside right upper", frameon=False, fontsize=8)
        return saved(figure, kind)


def _styles(row: PlacedMinimum, found: Placements) -> list[tuple[str, dict[str, Any]]]:
    """What is drawn for a placement, each with its label in the legend."""
    rings = [
        (label, _MARKS[label])
        for label, rings in (
            ("where it stands", row is found.here),
            ("among the best", row in found.best),
        )
        if rings
    ]
    lift_offs = row.least_lift_offs
    if lift_offs is None:
        label = "the part cannot stand there" if row.refused else "no answer in time"
        return [*rings, (label, _MARKS[label])]
    if row.rank(found.cover)[0]:
        return [*rings, (_TOO_LITTLE, _MARKS[_TOO_LITTLE])]
    color = LINES[lift_offs % len(LINES)]
    dot = {"facecolors": "none" if row.at_least else color, "edgecolors": color, "s": 40}
    return [*rings, (f"{'at least ' if row.at_least else ''}{count(lift_offs, 'lift-off')}", dot)]
