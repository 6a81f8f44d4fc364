"""Draw the figures of docs/concepts.md: ``python docs/figures/draw.py [FOLDER [TERM…]]``.

Everything in them is made by the package: cells and edges by the decomposition, divisions by a
solver, areas cut like those of ``cellcolor show``. The same versions give the same bytes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from drawing import FILL, PLAIN, arrow, borders, cells, cut, fill, painting, panels, say
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from cellcolor.data.cells_and_edges import Cell
from cellcolor.pictures.picture import INK, WARNING
from examples import (
    BLUE,
    RED,
    YELLOW,
    Array,
    Example,
    corridors,
    everywhere,
    flower,
    overlap,
    overlap_of_two,
    ring,
    split,
)

FIGURES: dict[str, Callable[[Figure], None]] = {}
SIZES = {
    "cell": (6, 3.9),
    "edge": (7.6, 3.9),
    "dart": (6, 3.9),
    "sub-cell": (6, 3.9),
    "segment": (6, 3.9),
    "strand": (10.5, 2.9),
    "petal": (4, 3.8),
    "hub": (8.4, 3.9),
    "scheme": (8.4, 3.9),
    "seam": (8.4, 4.2),
}
"""Width and height in inches of figures that are not 8.4 by 3.1."""


def figure(draw: Callable[[Figure], None]) -> Callable[[Figure], None]:
    """A function that draws the figure of the term that it is named after."""
    FIGURES[draw.__name__.replace("_", "-")] = draw
    return draw


@figure
def point(fig: Figure) -> None:
    left, right = panels(fig, "a point: a vertex of the mesh", "two configurations at one point")
    example = Example(everywhere, size=(2.0, 1.4), step=0.2)
    chosen = int(np.hypot(*(example.points - [0.95, 0.7]).T).argmin())
    near = np.zeros(len(example.points), dtype=np.int64)
    near[chosen] = 1
    fill(left, example, near, {0: [PLAIN], 1: [FILL[YELLOW]]})
    left.triplot(*example.points.T, example.faces, color="#999999", lw=0.7)
    left.plot(*example.points.T, "o", color=INK, ms=3)
    left.plot(*example.points[chosen], "o", color=WARNING, ms=7)
    say(left, example.points[chosen] + [0.52, 0.33], "point and the\narea that it owns")
    base, target, lengths = np.array([0.0, 0.0]), np.array([1.35, 0.55]), (0.95, 0.8)
    right.plot(
        [0.7, 2.0], [0.55 + 0.65 * 0.35, 0.55 - 0.65 * 0.35], color="#999999", lw=4, zorder=1
    )
    reach = np.hypot(*target)
    bend = np.arccos((lengths[0] ** 2 + reach**2 - lengths[1] ** 2) / (2 * lengths[0] * reach))
    for sign, color, name in ((1, RED, "elbow up"), (-1, BLUE, "elbow down")):
        angle = np.arctan2(target[1], target[0]) + sign * bend
        elbow = base + lengths[0] * np.array([np.cos(angle), np.sin(angle)])
        right.plot(*np.array([base, elbow, target]).T, "-o", color=FILL[color], lw=6, ms=9)
        say(right, (elbow[0], elbow[1] + 0.2 * sign), name)
    right.plot(*target, "o", color=WARNING, ms=7, zorder=6)
    right.plot(*base, "s", color=INK, ms=11)
    say(right, (1.62, 0.62), "point")
    right.set(xlim=(-0.4, 2.1), ylim=(-0.8, 1.25))


@figure
def color(fig: Figure) -> None:
    left, right = panels(
        fig, "points along a line, their configurations above", "two colors on a surface"
    )
    left.set_aspect("auto")
    x = np.arange(13.0)
    for own, heights in ((RED, 2.2 + 0.3 * np.sin(x / 2)), (BLUE, 1.0 + 0.2 * np.cos(x / 3))):
        reached = x < 9 if own == RED else x > 3
        left.plot(x[reached], heights[reached], "-o", color=FILL[own], lw=2.5, ms=7)
    left.plot(x, 0 * x, "-o", color=INK, lw=1, ms=4)
    left.plot([6, 6], [0, 2.6], ":", color="#888888", zorder=0)
    say(left, (2.4, 2.85), "red: a connected set of configurations")
    say(left, (9.7, 1.45), "blue")
    say(left, (6, -0.42), "this point has both colors")
    left.set(ylim=(-0.7, 3.1))
    example = overlap_of_two()
    cells(right, example)
    for at, text in (((0.6, 1.3), "red"), ((1.9, 1.3), "red and blue"), ((3.3, 1.3), "blue")):
        say(right, at, text)


@figure
def crack(fig: Figure) -> None:
    left, right = panels(
        fig, "mesh edges that red does not follow", "the crack, and the way round its end"
    )

    def crossed(a: Array, b: Array) -> Array:
        split_ends = (a[:, 1] < 1.3) != (b[:, 1] < 1.3)
        return split_ends & ((a[:, 0] + b[:, 0]) / 2 < 2.4)

    for axes, step in ((left, 0.2), (right, 0.1)):
        example = Example(everywhere, step=step, cracked=crossed)
        fill(axes, example, example.cells, {0: [FILL[RED]]})
        if axes is left:
            axes.triplot(*example.points.T, example.faces, color="white", lw=0.7)
            for gap in example.surface.cracks:
                axes.plot(*example.points[[gap.i, gap.j]].T, color=INK, lw=2.2)
        for gap in example.edges if axes is right else ():
            if example.graph.edge(gap).left == example.graph.edge(gap).right:
                axes.plot(*example.edges[gap].T, color=WARNING, lw=3)
    angle = np.linspace(-2.2, 2.2, 60)
    arrow(right, np.column_stack([2.1 + 1.0 * np.cos(angle), 1.3 + 0.75 * np.sin(angle)]), INK)
    say(right, (1.0, 1.52), "crack of red")
    say(right, (3.4, 2.2), "still one color")


@figure
def cell(fig: Figure) -> None:
    (axes,) = panels(fig, "cells: connected points with equal sets of colors")
    example = overlap()
    cells(axes, example)
    for own in example.graph.cells:
        names = ", ".join(example.surface.colors[k] for k in own.colors)
        say(axes, example.inside(own.id), f"cell {own.id}\n{{{names}}}", 8)
    say(axes, (3.75, 2.35), "unreachable", 7)


@figure
def edge(fig: Figure) -> None:
    (axes,) = panels(fig, "topological edges, from corner to corner")
    example = overlap()
    cells(axes, example, faint=True)
    for number, line in example.edges.items():
        joinable = example.graph.joinable(number)
        style = (
            {"lw": 3.2, "color": FILL[joinable[0]]}
            if joinable
            else {"lw": 2, "ls": "--", "color": "#777777"}
        )
        if len(joinable) > 1:
            axes.plot(*line.T, lw=6.4, color=FILL[joinable[1]])
        axes.plot(*line.T, **style)
        if not np.allclose(line[0], line[-1]):
            axes.plot(*line[[0, -1]].T, "o", color=INK, ms=5, zorder=6)
        say(axes, line[len(line) // 2], str(number), 8)
    axes.plot([], [], lw=2, ls="--", color="#777777", label="dead: no joinable color")
    for own in (RED, BLUE):
        axes.plot([], [], lw=3, color=FILL[own], label=f"joinable in {example.surface.colors[own]}")
    axes.plot([], [], "o", color=INK, label="corner")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)


@figure
def dart(fig: Figure) -> None:
    (axes,) = panels(fig, "the darts of one cell: its edges, walked with the cell on the left")
    example = overlap()
    middle = next(c for c in example.graph.cells if c.colors == (RED, BLUE))
    cells(axes, example, faint=True)
    fill(axes, example, np.where(example.cells == middle.id, 1, 0), {1: [FILL[YELLOW]]})
    for name in middle.loops[0]:
        line = example.dart(name, 0.11)
        arrow(axes, line, WARNING)
        say(axes, line[len(line) // 2], f"{name:+d}", 8)
    order = ", ".join(f"{name:+d}" for name in middle.loops[0])
    say(axes, example.inside(middle.id), f"cell {middle.id}\n({order})")


def divided(example: Example) -> Cell:
    """The cell in the middle, which has two colors."""
    return next(c for c in example.graph.cells if len(c.colors) == 2)


@figure
def cutting_path(fig: Figure) -> None:
    left, right = panels(
        fig, "five cells; the middle one has both colors", "cut from corner to corner"
    )
    example = split()
    cells(left, example)
    painting(right, example, example.best())
    say(right, (2.0, 1.65), "cutting path")


@figure
def sub_cell(fig: Figure) -> None:
    (axes,) = panels(fig, "the two sub-cells of the middle cell")
    example = split()
    own, division = example.cells == divided(example).id, example.best()
    segments = example.segments(division)
    (middle,) = (c for c in division.cells or () if c.id == divided(example).id)
    fills = {s.segment: [FILL[s.color]] for s in middle.subcells}
    fill(axes, example, np.where(own, segments, -1), fills | {-1: [PLAIN]})
    borders(axes, example)
    cut(axes, example, middle.id, segments)
    for sub in middle.subcells:
        darts = ", ".join(f"{name:+d}" for name in sub.darts if isinstance(name, int))
        place = example.points[own & (segments == sub.segment)].mean(axis=0)
        say(axes, place, f"{example.surface.colors[sub.color]}, darts {darts}")


@figure
def segment(fig: Figure) -> None:
    (axes,) = panels(fig, "two segments, one lift-off")
    example = overlap()
    division = example.best()
    painting(axes, example, division)
    segments = example.segments(division)
    for own in range(division.segments or 0):
        say(axes, example.points[segments == own].mean(axis=0), f"segment {own}", 10)
    arc = np.linspace(np.pi, 0, 40)
    arrow(axes, np.column_stack([1.9 + 0.9 * np.cos(arc), 1.75 + 0.6 * np.sin(arc)]), INK)
    say(axes, (1.9, 2.35), "lift-off")


@figure
def scheme(fig: Figure) -> None:
    left, right = panels(
        fig, "one of the best divisions", "its scheme: states, and blocks of the middle cell"
    )
    example = flower()
    division = example.cut_beside(RED)
    hub_cell = max(division.cells or (), key=lambda c: len(example.graph.cells[c.id].colors))
    painting(left, example, division)
    joined = {abs(d): s for s in hub_cell.subcells for d in s.darts if isinstance(d, int)}
    live = [d for d in example.graph.cells[hub_cell.id].loops[0] if example.graph.joinable(d)]
    circle = np.linspace(0, 2 * np.pi, 200)
    right.plot(np.cos(circle), np.sin(circle), color=INK, lw=1)
    places = {}
    for name in live:
        at = example.dart(name, 0.0).mean(axis=0) - 1.5
        places[name] = at / np.linalg.norm(at)
        state = "1" if abs(name) in joined else "0"
        say(left, 1.5 + 0.9 * at, state, 9, weight="bold")
        say(right, 1.13 * places[name], f"{name:+d}", 8)
        say(right, 0.9 * places[name], state, 9, weight="bold")
    for sub in hub_cell.subcells:
        corners = np.array([0.8 * places[d] for d in live if joined.get(abs(d)) is sub])
        right.fill(
            *corners.T,
            facecolor=FILL[sub.color],
            edgecolor=FILL[sub.color],
            lw=9,
            joinstyle="round",
        )
    right.set(xlim=(-1.3, 1.3), ylim=(-1.25, 1.25))


@figure
def strand(fig: Figure) -> None:
    left, middle, right = panels(
        fig, "the cells", "one corridor an edge", "two strands of the edge in the middle"
    )
    example = corridors()
    cells(left, example)
    painting(middle, example, example.best())
    painting(right, example, example.best("surface"))
    wide = {c.id for c in example.graph.cells if len(c.colors) > 1}
    (shared,) = (e for e in example.graph.edges if {e.left, e.right} == wide)
    line = example.dart(shared.id, 0.0)
    for half, name in ((line[:18], "1"), (line[22:], "2")):
        right.plot(*half.T, color=WARNING, lw=5, solid_capstyle="butt")
        say(right, half[len(half) // 2] + [0.25, 0.0], name)
    for axes, division in ((middle, example.best()), (right, example.best("surface"))):
        axes.text(2.0, -0.25, f"{division.segments} segments", ha="center", va="top")


@figure
def seam(fig: Figure) -> None:
    left, right = panels(fig, "a cell with two loops", "a seam makes them one cyclic list of darts")
    example = ring()
    cells(left, example)
    cells(right, example, faint=True)
    own = divided(example)
    fill(right, example, np.where(example.cells == own.id, 1, 0), {1: [FILL[YELLOW]]})
    loops = [[d for d in loop if example.graph.joinable(d)] for loop in own.loops]
    outer, inner = sorted(loops, key=lambda loop: -np.ptp(example.dart(loop[0], 0.05)))
    for name in (*outer, *inner):
        line = example.dart(name, 0.08)
        arrow(right, line, WARNING)
        say(right, line[len(line) // 2], f"{name:+d}", 8)
    ends = {d: example.edges[abs(d)][-1 if d > 0 else 0] for d in (*outer, *inner)}
    start, end = min(
        ((a, b) for a in outer for b in inner),
        key=lambda pair: np.hypot(*(ends[pair[0]] - ends[pair[1]])),
    )
    right.plot(*np.array([ends[start], ends[end]]).T, color=INK, lw=3, zorder=8)
    say(right, (ends[start] + ends[end]) / 2 + [0.0, -0.12], "seam")
    first, second = (
        loop[loop.index(d) + 1 :] + loop[: loop.index(d) + 1]
        for loop, d in ((outer, start), (inner, end))
    )
    order = [f"{d:+d}" for d in first] + ["seam"] + [f"{d:+d}" for d in second] + ["seam back"]
    right.text(1.5, -0.1, ", ".join(order), ha="center", va="top", fontsize=8)


def hub_and_petals(axes: Axes, *, petals: bool) -> None:
    """The flower, with the hub or the petals named, and the petals in their colors."""
    example = flower()
    middle = max(example.graph.cells, key=lambda cell: len(cell.colors)).id
    fills = {c.id: [FILL[c.colors[0]]] for c in example.graph.cells}
    fill(axes, example, example.cells, fills | {middle: [PLAIN]})
    borders(axes, example)
    for own in example.graph.cells:
        if (own.id != middle) == petals:
            name = "petal" if petals else "hub: red, blue,\ngreen, yellow"
            say(axes, example.points[example.cells == own.id].mean(axis=0), name)


@figure
def hub(fig: Figure) -> None:
    left, right = panels(
        fig,
        "a hub: one cell with many live darts",
        "joining both red petals cuts off one of the blue ones",
    )
    hub_and_petals(left, petals=False)
    example = flower()
    painting(right, example, example.cut_beside(RED))


@figure
def petal(fig: Figure) -> None:
    (axes,) = panels(fig, "petals: cells with a single live dart")
    hub_and_petals(axes, petals=True)


def main(folder: Path, terms: Iterable[str]) -> None:
    """Draw the figures of some terms into a folder."""
    style = {"svg.hashsalt": "cellcolor", "font.size": 9, "hatch.linewidth": 5.0}
    with mpl.rc_context(style):
        for name in terms:
            fig = Figure(figsize=SIZES.get(name, (8.4, 3.1)), dpi=100)
            canvas = FigureCanvasAgg(fig)
            FIGURES[name](fig)
            fig.tight_layout()
            canvas.draw()
            picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
            picture.quantize(64, dither=Image.Dither.NONE).save(
                folder / f"{name}.png", optimize=True
            )


if __name__ == "__main__":
    own = Path(__file__).resolve().parent
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else own, sys.argv[2:] or FIGURES)
