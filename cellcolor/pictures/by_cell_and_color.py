"""A labelled surface by cell and by one color's domain."""

from __future__ import annotations

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.shares import GIVEN_UP, UNREACHABLE, percent
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.decomposition import Decomposition
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, FAINT, GREY, assign
from cellcolor.pictures.picture import Picture3D


class CellPicture:
    """The surface by cell."""

    needs: tuple[Source, ...] = ("surface", "decomposition")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """Every cell in a color of its own."""
        return draw_surface(given.surface, by_cell(given.surface, given.decomposition))


class ColorPicture:
    """The domain of one color."""

    needs: tuple[Source, ...] = ("surface", "color")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """Where the color is available, and where others are."""
        return draw_surface(given.surface, by_color(given.surface, given.color))


def by_cell(surface: LabelledSurface, decomposition: Decomposition) -> SurfaceView:
    """Every cell in a color of its own, or at least in another one than its neighbors.

    Args:
        surface: the surface.
        decomposition: its topological graph, on the mesh.
    """
    instance = decomposition.instance
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    number = len(instance.cells)
    labels = np.where(cells == OUTSIDE, bare_labels(surface, number), cells)
    share = shares(surface, labels, number + 2)
    fills = assign(neighboring(surface, cells, number))
    classes = [
        VertexClass(f"cell {cell.id} {_ids(cell.colors)}  {share[cell.id]}", fill, str(cell.id))
        for cell, fill in zip(instance.cells, fills, strict=True)
    ]
    classes += bare_classes(*share[number:])
    notes = ["Cell: {available colors}, share of the surface."]
    if number > len(AREAS):
        notes.append("Fills repeat: the numbers identify the cells.")
    cracks = surface.crack_colors
    title = f"{surface.name}: {count(number, 'cell')}"
    return SurfaceView(
        title, labels, classes, cracks=cracks, notes=(*notes, *color_key(surface.colors))
    )


def by_color(surface: LabelledSurface, color: int) -> SurfaceView:
    """Where one color is available, and where others are."""
    covered = np.array(
        [0 if color in own else 1 if own else 2 for own in surface.vertex_colors], dtype=np.int64
    )
    labels = np.where(covered == 2, bare_labels(surface, 2), covered)
    share = shares(surface, labels, 4)
    name = surface.colors[color]
    classes = [
        VertexClass(f"{name}  {share[0]}", AREAS[0]),
        VertexClass(f"other colors only  {share[1]}", AREAS[2]),
        *bare_classes(*share[2:]),
    ]
    cracks = [pair for pair, colors in surface.crack_colors.items() if color in colors]
    note = "Shares of the surface. Cracks are those of this color."
    return SurfaceView(
        f"{surface.name}: color {color}, {name}", labels, classes, cracks=cracks, notes=(note,)
    )


def bare_labels(surface: LabelledSurface, first: int) -> Labels:
    """The classes (n,) of vertices without colors, as if all were: see :func:`bare_classes`.

    Args:
        surface: the surface.
        first: the class of what is unreachable; that of what was given up is the one after it.
    """
    labels = np.full(len(surface.vertices), first, dtype=np.int64)
    labels[list(surface.given_up)] = first + 1
    return labels


def bare_classes(unreachable: str, given_up: str) -> list[VertexClass]:
    """What no segment covers, with their shares as text."""
    return [
        VertexClass(f"{UNREACHABLE}  {unreachable}", FAINT),
        VertexClass(f"{GIVEN_UP}  {given_up}", GREY),
    ]


def color_key(colors: tuple[str, ...]) -> list[str]:
    """What the numbers of the colors mean, a line each."""
    return [f"{number}: {name}" for number, name in enumerate(colors)]


def shares(surface: LabelledSurface, labels: Labels, count: int) -> list[str]:
    """Each class's share of the surface, as text."""
    owned = surface.vertex_areas
    sums = np.bincount(labels, owned, minlength=count)
    whole = float(owned.sum()) or 1.0
    return [percent(value / whole, value / whole) for value in sums]


def neighboring(surface: LabelledSurface, labels: Labels, count: int) -> dict[int, set[int]]:
    """The classes next to each class 0 … count - 1 over mesh edges; others are not counted."""
    found: dict[int, set[int]] = {label: set() for label in range(count)}
    ends = labels[surface.mesh.edges]
    for a, b in sorted(set(map(tuple, np.concatenate([ends, ends[:, ::-1]]).tolist()))):
        if a != b and a in found and b in found:
            found[a].add(b)
    return found


def _ids(colors: tuple[int, ...]) -> str:
    return "{" + ", ".join(map(str, colors)) + "}"
