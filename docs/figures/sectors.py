"""Draw the figure of docs/formulation.md: ``python docs/figures/sectors.py [FOLDER]``.

A cell with ten darts in five sub-cells, each of which separates its neighbors: the longest chain
has five chords, so two rings and a center are enough.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from drawing import FILL, panels
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle, Wedge

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.pictures.picture import INK
from cellcolor.solvers.cpsat.complete_model import CompleteModel
from cellcolor.solvers.cpsat.painting import Block
from cellcolor.solvers.cpsat.sectors import sector_colors
from examples import BLUE, GREEN, RED, YELLOW, Array

COLORS = RED, BLUE, GREEN, YELLOW, RED
DARTS = (2, 3), (1, 4), (0, 5), (9, 6), (8, 7)
"""Of each sub-cell from top to bottom its two darts, numbered counterclockwise from the right."""


def main(folder: Path) -> None:
    """The sub-cells, and the same drawn on sectors."""
    color_of = {dart: color for own, color in zip(DARTS, COLORS, strict=True) for dart in own}
    leaves = [Cell(n + 1, (color_of[n],), ((-n - 1,),)) for n in range(10)]
    cell = Cell(0, (RED, BLUE, GREEN, YELLOW), (tuple(range(1, 11)),))
    edges = tuple(Edge(n, 0, n) for n in range(1, 11))
    model = CompleteModel(Instance("ten darts", ("r", "b", "g", "y"), (cell, *leaves), edges))
    number_of = model.sectors.graph.number_of
    blocks = [
        Block(color, {number_of[dart + 1, 1] for dart in own})
        for own, color in zip(DARTS, COLORS, strict=True)
    ]
    whole = [[Block(color_of[n], {number_of[-n - 1, 1]})] for n in range(10)]
    colors = sector_colors(model.sectors, [blocks, *whole])
    figure = Figure(figsize=(7.2, 3.8), layout="constrained")
    areas, drawn = panels(figure, "five sub-cells of a cell", "two rings of sectors and a center")
    _areas(areas)
    _sectors(drawn, [colors[node] for node in model.sectors.nodes[0]], model.sectors.rings[0])
    for axes in (areas, drawn):
        axes.set_xlim(-1.25, 1.25)
        axes.set_ylim(-1.25, 1.25)
        for dart in range(10):
            axes.text(*(1.14 * _at(dart)), str(dart + 1), ha="center", va="center", fontsize=9)
    figure.savefig(folder / "sectors.png", dpi=110)


def _at(dart: float) -> Array:
    angle = np.deg2rad(36 * dart)
    return np.array([np.cos(angle), np.sin(angle)])


def _areas(axes: Axes) -> None:
    """Bands, each between two darts of one color."""
    rim = Circle((0, 0), 1, facecolor="none", edgecolor=INK, lw=1.2)
    axes.add_patch(rim)
    heights = [np.sin(np.deg2rad(36 * turn)) for turn in (1.5, 0.5, -0.5, -1.5)]
    for color, top, bottom in zip(COLORS, [1.0, *heights], [*heights, -1.0], strict=True):
        band = Rectangle((-1, bottom), 2, top - bottom, facecolor=FILL[color], edgecolor=INK, lw=1)
        axes.add_patch(band)
        band.set_clip_path(rim)


def _sectors(axes: Axes, colors: list[int], rings: int) -> None:
    """Wedges in their colors, with the graph on them."""
    radii = np.linspace(1.0, 0.32, rings + 1)
    for ring in range(rings):
        outer, inner = radii[ring], radii[ring + 1]
        middle = (outer + inner) / 2
        for dart in range(10):
            color = FILL[colors[10 * ring + dart]]
            turn = 36 * dart
            wedge = Wedge((0, 0), outer, turn - 18, turn + 18, width=outer - inner)
            wedge.set(facecolor=color, edgecolor="white", lw=1)
            axes.add_patch(wedge)
            deeper = (radii[ring + 1] + radii[ring + 2]) / 2 if ring + 1 < rings else 0
            for end in (middle * _at(dart + 1), deeper * _at(dart)):
                line = np.array([middle * _at(dart), end])
                axes.plot(*line.T, color=INK, lw=0.8)
            axes.plot(*(middle * _at(dart)), "o", color=INK, ms=3)
    axes.add_patch(Circle((0, 0), radii[-1], facecolor=FILL[colors[-1]], edgecolor="white", lw=1))
    for dart in range(10):
        line = np.array([(radii[-1] + radii[-2]) / 2 * _at(dart), [0, 0]])
        axes.plot(*line.T, color=INK, lw=0.8)
    axes.plot(0, 0, "o", color=INK, ms=3)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
