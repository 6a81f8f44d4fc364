"""A labelled surface by cell and by one color's domain."""

from __future__ import annotations

import numpy as np

from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.viz.palette import AREAS, FAINT, assign
from cellcolor.viz.surface import Area, Labels, Painting, vertex_areas

__all__ = ["by_cell", "by_color", "color_key", "neighboring", "shares"]

UNREACHABLE = "unreachable"


def by_cell(surface: LabelledSurface, instance: Instance, cells: Labels) -> Painting:
    """Every cell in a color of its own, or at least in another one than its neighbors.

    Args:
        surface: the surface.
        instance: its topological graph.
        cells: (n,) the cell of each vertex, ``OUTSIDE`` where unreachable.
    """
    count = len(instance.cells)
    labels = np.where(cells == OUTSIDE, count, cells)
    share = shares(surface, labels, count + 1)
    fills = assign(neighboring(surface, cells, count))
    areas = [
        Area(f"cell {cell.id} {_ids(cell.colors)}  {share[cell.id]}", fill, str(cell.id))
        for cell, fill in zip(instance.cells, fills, strict=True)
    ]
    areas.append(Area(f"{UNREACHABLE}  {share[count]}", FAINT))
    notes = ["Cell: {available colors}, share of the area."]
    if count > len(AREAS):
        notes.append("Fills repeat: the numbers tell cells apart.")
    cracks = [(crack.i, crack.j) for crack in surface.cracks]
    title = f"{surface.name}: {count} cells"
    return Painting(title, labels, areas, cracks=cracks, notes=(*notes, *color_key(surface.colors)))


def by_color(surface: LabelledSurface, color: int) -> Painting:
    """Where one color is available, and where others are."""
    labels = np.array(
        [0 if color in own else 1 if own else 2 for own in surface.vertex_colors], dtype=np.int64
    )
    share = shares(surface, labels, 3)
    name = surface.colors[color]
    areas = [
        Area(f"{name}  {share[0]}", AREAS[0]),
        Area(f"other colors only  {share[1]}", AREAS[2]),
        Area(f"{UNREACHABLE}  {share[2]}", FAINT),
    ]
    cracks = [(crack.i, crack.j) for crack in surface.cracks if color in crack.colors]
    note = "Shares of the area. Cracks are those of this color."
    return Painting(
        f"{surface.name}: color {color}, {name}", labels, areas, cracks=cracks, notes=(note,)
    )


def color_key(colors: tuple[str, ...]) -> list[str]:
    """What the numbers of the colors mean, a line each."""
    return [f"{number}: {name}" for number, name in enumerate(colors)]


def shares(surface: LabelledSurface, labels: Labels, count: int) -> list[str]:
    """Each class's share of the area, as text."""
    owned = vertex_areas(surface.vertices, surface.faces)
    sums = np.bincount(labels, owned, minlength=count)
    whole = float(owned.sum()) or 1.0
    return [f"{100 * value / whole:.1f} %" for value in sums]


def neighboring(surface: LabelledSurface, labels: Labels, count: int) -> dict[int, set[int]]:
    """The classes next to each class 0 … count - 1 over mesh edges; others are not counted."""
    found: dict[int, set[int]] = {label: set() for label in range(count)}
    ends = labels[np.array(list(surface.left_of), dtype=np.int64).reshape(-1, 2)]
    for a, b in np.unique(np.concatenate([ends, ends[:, ::-1]]), axis=0).tolist():
        if a != b and a in found and b in found:
            found[a].add(b)
    return found


def _ids(colors: tuple[int, ...]) -> str:
    return "{" + ", ".join(map(str, colors)) + "}"
