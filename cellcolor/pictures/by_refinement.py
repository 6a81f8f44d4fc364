"""The meshes of a refinement side by side: the cells of each, and those that are new."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.wording import count
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, FAINT, WARNING
from cellcolor.pictures.picture import Layer, Picture3D, SpaceLines, Text
from cellcolor.questions.refinement import RefinedStep, Refinement

_GAP = 0.15  # between two meshes, of the width of one
_NEW = "cell without a counterpart in the step before"


def draw_refinement(refinement: Refinement) -> Picture3D:
    """Every step beside the one before, cells in colors of their branches, new cells red."""
    steps = refinement.steps
    branches = sorted({own for step in steps for own in _branches(step)})
    known = sorted({name for own in branches for name in own})
    classes = [
        VertexClass(
            "branches {" + ", ".join(str(known.index(name)) for name in own) + "}",
            AREAS[number % len(AREAS)],
        )
        for number, own in enumerate(branches)
    ]
    classes += [VertexClass(_NEW, WARNING), VertexClass("no color", FAINT)]
    pictures = [
        _drawn(step, None if number == 0 else steps[number - 1], branches, classes)
        for number, step in enumerate(steps)
    ]
    lines = [f"step {number}: {step}" for number, step in enumerate(steps)]
    notes = ["Axes are those of step 0; the others stand beside it."]
    if len(branches) > len(AREAS):
        notes.append("Fills repeat: black lines are borders of cells.")
    notes += [f"{number}: {name}" for number, name in enumerate(known)]
    title = f"{steps[0].surface.name}: {count(len(steps), 'mesh', 'meshes')}, "
    title += "stable" if refinement.stable else "not stable"
    return _side_by_side(pictures, title, (*map(_short, lines), *notes))


def _drawn(
    step: RefinedStep,
    before: RefinedStep | None,
    branches: Sequence[tuple[str, ...]],
    classes: Sequence[VertexClass],
) -> Picture3D:
    cells = np.array(step.vertex_cell, dtype=np.int64)
    number = {own: label for label, own in enumerate(branches)}
    of_cell = np.array([*[number[own] for own in _branches(step)], len(classes) - 1])
    if before is not None:
        of_cell[:-1][_without_counterpart(before.vertex_cell, cells)] = len(branches)
    labels = of_cell[np.where(cells == OUTSIDE, len(of_cell) - 1, cells)]
    view = SurfaceView("", labels, classes, borders=cells, cracks=step.surface.crack_colors)
    return draw_surface(step.surface, view)


def _branches(step: RefinedStep) -> list[tuple[str, ...]]:
    """The branches of each cell's colors. Numbers in the names of colors change with the mesh."""
    names = [name.rstrip("0123456789").rstrip() for name in step.instance.colors]
    return [tuple(sorted(names[c] for c in cell.colors)) for cell in step.instance.cells]


def _without_counterpart(before: Sequence[int], cells: Labels) -> Mask:
    """Which cells (k,) do not have exactly the older vertices of one cell of the step before."""
    owners: dict[int, set[int]] = defaultdict(set)
    owned: dict[int, set[int]] = defaultdict(set)
    for old, new in zip(before, cells[: len(before)].tolist(), strict=True):
        owners[new].add(old)
        owned[old].add(new)
    found = []
    for cell in range(int(cells.max(initial=OUTSIDE)) + 1):
        own = owners[cell] - {OUTSIDE}
        found.append(owners[cell] != own or len(own) != 1 or owned[min(own)] != {cell})
    return np.array(found, dtype=bool)


def _side_by_side(pictures: Sequence[Picture3D], title: str, notes: tuple[str, ...]) -> Picture3D:
    """Pictures of the same thing as one, each to the right of the one before."""
    towards = pictures[0].towards
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    points = np.concatenate([layer.points for layer in pictures[0].layers])
    width = (1 + _GAP) * float(np.ptp(points @ right))
    above = points.mean(axis=0)
    above[2] = points[:, 2].max() + 0.08 * float(np.ptp(points, axis=0).max())
    layers: dict[str, list[Layer]] = defaultdict(list)
    lines: dict[str, list[SpaceLines]] = defaultdict(list)
    texts: list[Text] = []
    for number, picture in enumerate(pictures):
        shift = number * width * right
        for layer in picture.layers:
            layers[layer.name].append(replace(layer, points=layer.points + shift))
        for line in picture.lines:
            lines[line.name].append(replace(line, ends=line.ends + shift))
        texts.append(Text(f"step {number}", above + shift, towards))
    return Picture3D(
        title=title,
        layers=tuple(map(_together, layers.values())),
        lines=tuple(
            replace(own[0], ends=np.concatenate([line.ends for line in own]))
            for own in lines.values()
        ),
        texts=tuple(texts),
        notes=notes,
        towards=towards,
    )


def _together(layers: Sequence[Layer]) -> Layer:
    """Layers of one name as one."""
    starts = np.cumsum([0, *[len(layer.points) for layer in layers]])
    triangles = [layer.triangles + start for layer, start in zip(layers, starts, strict=False)]
    points = np.concatenate([layer.points for layer in layers])
    return replace(layers[0], points=points, triangles=np.concatenate(triangles))


def _short(line: str) -> str:
    """A line that fits under the legend."""
    return line.replace(": ", ":\n   ", 1).replace(" mm: ", " mm:\n   ", 1)
