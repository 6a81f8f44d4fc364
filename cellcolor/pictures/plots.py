"""Curves, bars and maps with Matplotlib: searches, fronts, placements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cellcolor.arrays import Array
from cellcolor.pictures.palette import FAINT, GREY, INK, LINES
from cellcolor.pictures.static import saved
from cellcolor.questions.front import Front
from cellcolor.questions.placements import PlacedMinimum, PlacementMap

_STYLE = {"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "cellcolor"}
_UNITS = {"x": "m", "y": "m", "z": "m", "roll": "rad", "pitch": "rad", "yaw": "rad"}
_LIFT_OFFS, _SHARE = "lift-offs", "share of the whole surface, %"


def render_search(
    title: str, curves: Mapping[str, Sequence[tuple[float, int]]], kind: str
) -> bytes:
    """Segments over the seconds of a search, as steps; the same curves give the same bytes.

    Args:
        curves: seconds and segments of each, by its name.
        kind: ``png`` or ``svg``.
    """
    with mpl.rc_context(_STYLE):
        figure, (axes,) = _figure(1)
        for number, (name, points) in enumerate(curves.items()):
            style = "--" if number >= len(LINES) else "-"
            seconds, segments = zip(*points, strict=True) if points else ((), ())
            color = LINES[number % len(LINES)]
            axes.step(seconds, segments, where="post", color=color, linestyle=style, label=name)
        axes.set_title(title, loc="left")
        axes.set_xlabel("seconds of the search")
        axes.set_ylabel("segments")
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.grid(True, color=FAINT, linewidth=0.5)
        figure.legend(loc="outside right upper", frameon=False, fontsize=8)
        return saved(figure, kind)


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
        axes.set_xlabel(_LIFT_OFFS)
        axes.set_ylabel("share of the area that can be covered, %")
        axes.set_ylim(0, 108)
        axes.set_xticks(at)
        note = "Line: no division with that many lift-offs covers more."
        if not front.proved_for_surface:
            note += " Other color: not proved to be the most, for any division of the surface."
        figure.supxlabel(note, fontsize=7, x=0.01, ha="left")
        return saved(figure, kind)


def render_map(
    name: str, tiled: PlacementMap, here: PlacedMinimum, best: Sequence[PlacedMinimum], kind: str
) -> bytes:
    """The fewest lift-offs in each tile, and beside them the area; of one variable two curves.

    Args:
        name: of the scene.
        here: where the scene has the part; a cross.
        best: the best placements; numbers.
        kind: ``png`` or ``svg``.
    """
    lift_offs, shares = np.array([*tiled.lift_offs()]), np.array([*tiled.percents()])
    marks = [("+", here), *((str(number), row) for number, row in enumerate(best, 1))]
    with mpl.rc_context(_STYLE):
        figure, axes = _figure(2)
        for own, values, title in zip(axes, (lift_offs, shares), (_LIFT_OFFS, _SHARE), strict=True):
            own.set_title(f"{name}: {title}" if own is axes[0] else title, loc="left")
            if len(tiled.ranges) == 1:
                _curve(own, tiled, values, title)
            else:
                _tiles(figure, own, tiled, values, title)
                for text, row in marks:
                    _mark(own, tiled, row, text)
        vertices = max((row.vertices for row in tiled.rows if row is not None), default=0)
        note = f"Mesh of {vertices} vertices, the part in the middle of each tile."
        if any(
            row is None or not (row.proved_for_surface or row.refused or row.at_least)
            for row in tiled.rows
        ):
            note += " The time limit came before all was proved."
        note += " Grey: the part cannot stand there."
        if any(row is not None and row.at_least for row in tiled.rows):
            note += " Lift-offs: at least, where enough can be covered. Area: at most."
        if len(tiled.ranges) == 2:
            note += " +: where it stands. Numbers: the best placements."
        figure.supxlabel(note, fontsize=7, x=0.01, ha="left")
        return saved(figure, kind)


def _curve(axes: Axes, tiled: PlacementMap, values: Array, title: str) -> None:
    ((name, (low, high)),) = tiled.ranges.items()
    edges = np.linspace(low, high, tiled.tiles + 1)
    axes.stairs(values, edges, color=LINES[0], baseline=None, linewidth=1.5)
    for left, right in zip(edges[:-1][np.isnan(values)], edges[1:][np.isnan(values)], strict=True):
        axes.axvspan(left, right, color=FAINT)
    axes.set_xlabel(f"{name}, {_UNITS[name]}")
    axes.set_xlim(low, high)
    if title == _LIFT_OFFS:
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))


def _tiles(figure: Figure, axes: Axes, tiled: PlacementMap, values: Array, title: str) -> None:
    (first, along), (second, across) = tiled.ranges.items()
    whole = title == _LIFT_OFFS
    most = int(np.nanmax(values)) if whole and np.isfinite(values).any() else 0
    colors = mpl.colormaps["cividis"]
    if whole:
        colors = ListedColormap(mpl.colormaps["viridis_r"](np.linspace(0, 1, most + 1)))
    image = axes.imshow(
        values.reshape(tiled.tiles, tiled.tiles),
        origin="lower",
        extent=(*along, *across),
        aspect="equal" if _UNITS[first] == _UNITS[second] else "auto",
        interpolation="nearest",
        cmap=colors.with_extremes(bad=GREY),
        norm=BoundaryNorm(np.arange(most + 2) - 0.5, most + 1) if whole else None,
    )
    bar = figure.colorbar(image, ax=axes, shrink=0.8)
    if whole:
        bar.set_ticks(range(most + 1))
        bar.ax.minorticks_off()
    axes.set_xlabel(f"{first}, {_UNITS[first]}")
    axes.set_ylabel(f"{second}, {_UNITS[second]}")


def _mark(axes: Axes, tiled: PlacementMap, row: PlacedMinimum, text: str) -> None:
    """A placement on the map, as far as it is on it."""
    place = [row.value(name) for name in tiled.ranges]
    if all(low <= at <= high for at, (low, high) in zip(place, tiled.ranges.values(), strict=True)):
        box = {"boxstyle": "circle,pad=0.15", "fc": "white", "ec": INK, "lw": 0.5}
        axes.annotate(
            text, (place[0], place[1]), fontsize=7, ha="center", va="center", color=INK, bbox=box
        )


def _figure(count: int) -> tuple[Figure, Sequence[Axes]]:
    figure = Figure(figsize=(8, 5) if count == 1 else (11, 5), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, [figure.add_subplot(1, count, number + 1) for number in range(count)]
