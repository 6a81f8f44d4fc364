"""How cells, edges, divisions and texts look in the figures of docs/concepts.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from cellcolor.data.solution import Solution
from cellcolor.pictures.mesh_picture import mesh_picture_parts
from cellcolor.pictures.picture import FAINT, INK
from examples import BLUE, GREEN, RED, YELLOW, Array, Example

FILL = {RED: "#e4707c", BLUE: "#6a9bd1", GREEN: "#83b97c", YELLOW: "#e8cf6b"}
PLAIN = "#f1efea"
HALO = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}


def panels(fig: Figure, *titles: str) -> list[Axes]:
    """One drawing without axes for each title."""
    found = fig.subplots(1, len(titles), squeeze=False)[0]
    for axes, title in zip(found, titles, strict=True):
        axes.set_title(title, fontsize=10)
        axes.set_aspect("equal")
        axes.set_axis_off()
    return list(found)


def fill(axes: Axes, example: Example, labels: Array, fills: Mapping[int, Sequence[str]]) -> None:
    """Areas of equal labels; several fills are stripes."""
    flat = np.column_stack([example.points, np.zeros(len(example.points))])
    points, triangles, owner = mesh_picture_parts(flat, example.faces, labels)
    for label, colors in fills.items():
        corners = points[triangles[owner == label]][:, :, :2]
        if len(corners):
            axes.add_collection(
                PolyCollection(corners, facecolor=colors[0], edgecolor=colors[0], lw=0.4)
            )
            for color, hatch in zip(colors[1:], ("//", "\\\\"), strict=False):
                stripes = PolyCollection(
                    corners, facecolor="none", edgecolor=color, lw=0, hatch=hatch
                )
                axes.add_collection(stripes)
    axes.autoscale_view()


def cells(axes: Axes, example: Example, faint: bool = False) -> None:
    """All cells in the stripes of their colors, or all in one light grey, and their borders."""
    own = {c.id: [PLAIN] if faint else [FILL[k] for k in c.colors] for c in example.graph.cells}
    fill(axes, example, example.cells, own | {-1: [FAINT]})
    for line in example.edges.values():
        axes.plot(*line.T, color=INK, lw=1.0)


def borders(axes: Axes, example: Example) -> None:
    """Topological edges as thin lines."""
    for line in example.edges.values():
        axes.plot(*line.T, color=INK, lw=1.0)


def painting(axes: Axes, example: Example, division: Solution) -> None:
    """A division in its colors: each point in that of its segment."""
    shade = {s.segment: s.color for c in division.cells or () for s in c.subcells}
    fills = {own: [FILL[k]] for own, k in shade.items()}
    fill(axes, example, example.segments(division), fills | {len(shade) + 1: [FAINT]})
    borders(axes, example)
    for cell in division.cells or ():
        if len(cell.subcells) > 1:
            cut(axes, example, cell.id, example.segments(division))


def cut(axes: Axes, example: Example, cell_id: int, segments: Array) -> None:
    """The cutting paths of a divided cell, where ``cellcolor show`` suggests them."""
    inside = (example.cells == cell_id)[example.faces].all(axis=1)
    for corners in example.faces[inside]:
        center = example.points[corners].mean(axis=0)
        for a, b in ((0, 1), (1, 2), (2, 0)):
            if segments[corners[a]] != segments[corners[b]]:
                line = np.array([example.points[corners[[a, b]]].mean(axis=0), center])
                axes.plot(*line.T, color=INK, lw=3.5, solid_capstyle="round")


def say(axes: Axes, at: Sequence[float], text: str, size: float = 9, **style: object) -> None:
    """A text on a white ground."""
    axes.text(*at, text, ha="center", va="center", fontsize=size, bbox=HALO, zorder=9, **style)


def arrow(axes: Axes, line: Array, color: str, width: float = 1.6) -> None:
    """A line with a head at its end."""
    axes.plot(*line.T, color=color, lw=width, zorder=5)
    head = {"arrowstyle": "-|>", "color": color, "lw": width, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=line[-1], xytext=line[-4], arrowprops=head, zorder=5)
