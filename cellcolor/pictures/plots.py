"""Curves and bars with Matplotlib: measurements, fronts."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from cellcolor.data.plot import Plot
from cellcolor.pictures.palette import GREY, INK, LINES
from cellcolor.pictures.static import saved
from cellcolor.questions.front import Front

_STYLE = {"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "cellcolor"}
_DASHES = ("-", "--", ":", "-.")
_MARKS = "os^vD<>P"


def render_plot(plot: Plot, kind: str) -> bytes:
    """The plot's file; the same plot gives the same bytes.

    Args:
        kind: ``png`` or ``svg``.
    """
    with mpl.rc_context(_STYLE):
        figure, (axes,) = _figure(1)
        _draw(axes, plot)
        axes.set_title(plot.title, loc="left")
        axes.set_xlabel(plot.x)
        axes.set_ylabel(plot.y)
        axes.grid(True, color="#DDDDDD", linewidth=0.5)
        figure.legend(loc="outside right upper", frameon=False, fontsize=8)
        if plot.note:
            figure.supxlabel(plot.note, fontsize=7, x=0.01, ha="left")
        return saved(figure, kind)


def _draw(axes: Axes, plot: Plot) -> None:
    """Curves, each told from the others by color and by dashes or marks."""
    axes.set_xscale("log" if plot.log_x else "linear")
    axes.set_yscale("log" if plot.log_y else "linear")
    if plot.diagonal:
        ends = [value for curve in plot.curves for point in curve.points for value in point]
        if ends:
            axes.plot([min(ends), max(ends)], [min(ends), max(ends)], color=GREY, linewidth=0.8)
    for number, curve in enumerate(plot.curves):
        mark = _MARKS[(number + number // len(LINES)) % len(_MARKS)]
        xs, ys = ([point[axis] for point in curve.points] for axis in (0, 1))
        color = LINES[number % len(LINES)]
        if plot.joined == "points":
            axes.scatter(
                xs, ys, s=14, marker=mark, color=color, edgecolor=INK, linewidth=0.3,
                label=curve.label,
            )  # fmt: skip
            continue
        style = _DASHES[number // len(LINES) % len(_DASHES)]
        if plot.joined == "steps":
            axes.step(xs, ys, where="post", color=color, linestyle=style, label=curve.label)
        else:
            axes.plot(
                xs, ys, color=color, linestyle=style, marker=mark, markersize=3, label=curve.label
            )
    for axis, logarithmic in ((axes.xaxis, plot.log_x), (axes.yaxis, plot.log_y)):
        if logarithmic:
            low, high = axis.get_view_interval()
            # On a long axis labels of more would run into each other.
            subs = (1,) if high > 1000 * low else (1, 2, 5)
            axis.set_major_locator(LogLocator(subs=subs, numticks=12))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())


def render_front(front: Front, kind: str) -> bytes:
    """The largest share that each number of lift-offs covers, with what is left out.

    Args:
        kind: ``png`` or ``svg``.
    """
    at = [point.lift_offs for point in front]
    covered = [100 * point.covered_share for point in front]
    most = [100 * point.at_most_share for point in front]
    with mpl.rc_context(_STYLE):
        figure, (axes,) = _figure(1)
        for point, x, y in zip(front, at, covered, strict=True):
            color = LINES[0] if point.proved_for_surface else LINES[1]
            axes.bar(x, y, 0.6, color=color)
            axes.annotate(
                f"{y:.1f}", (x, y), xytext=(0, 2), textcoords="offset points", ha="center"
            )
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


def _figure(count: int) -> tuple[Figure, Sequence[Axes]]:
    figure = Figure(figsize=(8, 5) if count == 1 else (11, 5), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, [figure.add_subplot(1, count, number + 1) for number in range(count)]
