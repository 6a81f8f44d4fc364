"""Fronts of lift-offs and area, with Matplotlib."""

from __future__ import annotations

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from cellcolor.pictures.palette import INK, LINES
from cellcolor.pictures.static import saved
from cellcolor.questions.front import Front

_STYLE = {"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "cellcolor"}


def render_front(front: Front, kind: str) -> bytes:
    """The largest share that each number of lift-offs covers, with what is left out.

    Args:
        kind: ``png`` or ``svg``.
    """
    at = [point.lift_offs for point in front]
    covered = [100 * point.covered_share for point in front]
    most = [100 * point.at_most_share for point in front]
    with mpl.rc_context(_STYLE):
        figure, axes = _figure()
        colors = [LINES[0] if point.proved_for_surface else LINES[1] for point in front]
        axes.bar_label(axes.bar(at, covered, 0.6, color=colors), fmt="%.1f", padding=2)
        for x, bound in zip(at, most, strict=True):
            axes.hlines(bound, x - 0.4, x + 0.4, color=INK, linewidth=1.5)
        axes.set_title(f"{front.instance.name}: what each number of lift-offs covers", loc="left")
        axes.set_xlabel("lift-offs")
        axes.set_ylabel("share of the area that can be covered, %")
        axes.set_ylim(0, 108)
        axes.set_xticks(at)
        note = "Line: no division with that many lift-offs covers more."
        if not front.proved_for_surface:
            note += " Other color: not proved to be the most, for any division of the surface."
        figure.supxlabel(note, fontsize=7, x=0.01, ha="left")
        return saved(figure, kind)


def _figure() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(8, 5), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.add_subplot()
