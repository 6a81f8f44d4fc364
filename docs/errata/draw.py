"""Draw the figures of docs/paper.md from the instance library: ``python docs/errata/draw.py``.

Each point of a mesh is a square. The numbers in the titles are counted by the checker on what is
drawn, and compared with what the instances say is known.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose

HERE = Path(__file__).resolve().parent
PAPER = HERE.parents[1] / "instances" / "paper"
RED, BLUE, GREEN = range(3)
FILL = ("#e4707c", "#6a9bd1", "#83b97c")
DARK = ("#a3131f", "#17457e", "#2c6b25")
mpl.rcParams.update({"svg.hashsalt": "cellcolor", "font.size": 9})


class Figures:
    """One instance: its known results, its mesh, and the cell of each point."""

    def __init__(self, name: str) -> None:
        self.known = Instance.read(PAPER / f"{name}.json").known
        self.surface = LabelledSurface.read(PAPER / f"{name}.surface.json")
        graph = decompose(self.surface, name)
        assert graph.surface is not None
        self.cell_of = graph.surface.vertex_cell
        self.points = [(round(x), round(y)) for x, y, _ in self.surface.vertices.tolist()]
        self.at = {point: vertex for vertex, point in enumerate(self.points)}

    def cells(self, axes: Axes) -> None:
        """The cells with the colors that reach them."""
        self._frame(axes, "cells and their colors")
        for x, y in self.points:
            axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, color="#f1efea", lw=0))
        for cell in range(max(self.cell_of) + 1):
            own = [v for v, c in enumerate(self.cell_of) if c == cell]
            x = sum(self.points[v][0] for v in own) / len(own)
            y = sum(self.points[v][1] for v in own) / len(own)
            colors = self.surface.vertex_colors[own[0]]
            for row, color in enumerate(colors):
                name = self.surface.colors[color]
                down = 0.62 * (row - (len(colors) - 1) / 2)
                style = {"color": DARK[color], "ha": "center", "va": "center", "weight": "bold"}
                axes.text(x, y - down, name, **style)
        self._borders(axes, [0] * len(self.points))

    def painted(self, axes: Axes, colors: list[int], title: str, expected: int) -> None:
        """A painting, its cutting paths thick, and the number of its segments."""
        report = check_plan(self.surface, Plan(tuple(colors)))
        assert report.segments == expected, (report, expected)
        self._frame(axes, f"{title}: {expected} segment{'s' if expected > 1 else ''}")
        for (x, y), color in zip(self.points, colors, strict=True):
            corner = (x - 0.5, y - 0.5)
            axes.add_patch(Rectangle(corner, 1, 1, facecolor=FILL[color], edgecolor=FILL[color]))
        self._borders(axes, colors)

    def _frame(self, axes: Axes, title: str) -> None:
        axes.set_title(title, fontsize=10)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_xlim(-0.6, max(x for x, _ in self.points) + 0.6)
        axes.set_ylim(-0.6, max(y for _, y in self.points) + 0.6)

    def _borders(self, axes: Axes, colors: list[int]) -> None:
        """Topological edges thin, cutting paths thick."""
        for (x, y), vertex in self.at.items():
            for dx, dy in ((1, 0), (0, 1)):
                other = self.at.get((x + dx, y + dy))
                if other is None:
                    continue
                ends = ([x + dx / 2 - dy / 2, x + dx / 2 + dy / 2], [y + 0.5 - dx, y + 0.5])
                if self.cell_of[vertex] != self.cell_of[other]:
                    axes.plot(*ends, color="black", lw=0.8)
                elif colors[vertex] != colors[other]:
                    axes.plot(*ends, color="black", lw=3.2, solid_capstyle="butt")


def corridors(name: str) -> None:
    """The strip: what one corridor an edge allows, and two."""
    drawing = Figures(name)
    assert drawing.known and drawing.known.paper and drawing.known.surface
    own = drawing.surface.vertex_colors
    # Cells in the middle of the strip have red and blue; the others are of a single color.
    whole = [RED if len(colors) > 1 else colors[0] for colors in own]
    middle = max(y for (_, y), colors in zip(drawing.points, own, strict=True) if colors == (BLUE,))
    halves = [
        (RED if y > middle else BLUE) if len(colors) > 1 else colors[0]
        for (_, y), colors in zip(drawing.points, own, strict=True)
    ]
    figure = Figure(figsize=(11, 3.4))
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, 3)
    drawing.cells(panels[0])
    title = "one corridor an edge"
    drawing.painted(panels[1], whole, title, drawing.known.paper.segments)
    drawing.painted(panels[2], halves, "paths across edges", drawing.known.surface.segments)
    save(figure, name)


def triple() -> None:
    """Three cells round a corner, and what the cost rule adds up to cell by cell."""
    drawing = Figures("triple-junction")
    assert drawing.known and drawing.known.paper
    figure = Figure(figsize=(11, 3.4))
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, 3)
    drawing.cells(panels[0])
    red = [RED] * len(drawing.points)
    drawing.painted(panels[1], red, "all red", drawing.known.paper.segments)
    panels[2].set_axis_off()
    panels[2].set_title("cost, cell by cell: $\\Delta = 1 - j$", fontsize=10)
    rows = [
        ("", "j counts cells", "j counts segments"),
        ("first cell", "1 - 0 = +1", "1 - 0 = +1"),
        ("second cell", "1 - 1 =  0", "1 - 1 =  0"),
        ("third cell", "1 - 2 = -1", "1 - 1 =  0"),
        ("sum", "0", "1"),
    ]
    for number, row in enumerate(rows):
        weight = "bold" if number in (0, len(rows) - 1) else "normal"
        for x, text, side in zip((0.0, 0.58, 1.0), row, ("left", "right", "right"), strict=True):
            panels[2].text(x, 0.85 - 0.18 * number, text, ha=side, weight=weight)
    save(figure, "triple-junction")


def save(figure: Figure, name: str) -> None:
    """One SVG file, the same bytes each time."""
    figure.tight_layout()
    figure.savefig(HERE / f"{name}.svg", metadata={"Date": None})


if __name__ == "__main__":
    corridors("parallel-corridors")
    corridors("parallel-corridors-private")
    triple()
