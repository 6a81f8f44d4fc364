"""PNG and SVG with Matplotlib, without a display: pictures, and maps of placements."""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from cellcolor.arrays import Array
from cellcolor.data.wording import count
from cellcolor.errors import InputError
from cellcolor.files.writing import MARKER
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.pictures.mesh_picture import mesh_picture_parts
from cellcolor.pictures.picture import (
    GREY,
    INK,
    LINES,
    WARNING,
    ClassedMesh,
    Line,
    Picture2D,
    Picture3D,
    Text,
)
from cellcolor.questions.placements import VARIABLES, PlacedMinimum, Placements

_LIGHT = np.array([0.3, -0.5, 0.81])
_SMALLEST = 3.5
"""Points; what is written in smaller letters is not read."""
STYLE = {
    "font.size": 9,
    "svg.fonttype": "none",
    "svg.hashsalt": "cellcolor",
    "text.parse_math": False,  # a dollar in somebody's name is a dollar
}


def render(picture: Picture2D | Picture3D, kind: str) -> bytes:
    """The picture's file; the same picture gives the same bytes.

    Args:
        kind: ``png`` or ``svg``.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(11, 7), dpi=150)
        axes = figure.add_axes((0.01, 0.02, 0.62, 0.91))
        _draw(axes, picture)
        figure.suptitle(picture.title, x=0.02, ha="left", fontsize=12)
        _side(figure, picture)
        return saved(figure, kind)


def render_drawing(picture: Picture2D) -> bytes:
    """An SVG of the drawing alone, for a page that has title, legend and notes itself."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7, 7))
        _draw(figure.add_axes((0.0, 0.0, 1.0, 1.0)), picture)
        return saved(figure, "svg")


def saved(figure: Figure, kind: str) -> bytes:
    """A figure's file, which says by what it was made and not when."""
    stream = io.BytesIO()
    metadata = {"Creator": MARKER} | ({"Date": None} if kind == "svg" else {})
    figure.savefig(stream, format=kind, metadata=metadata)
    return stream.getvalue()


def _draw(axes: Axes, picture: Picture2D | Picture3D) -> None:
    axes.set_axis_off()
    axes.set_aspect("equal", adjustable="datalim")
    if isinstance(picture, Picture2D):
        _plane(axes, picture)
    else:
        _space(axes, picture)
    axes.autoscale_view()


def _side(figure: Figure, picture: Picture2D | Picture3D) -> None:
    """Legend and notes to the right of the drawing."""
    thin = {line.name for line in picture.lines} | {kind.text for kind in Line}
    dashed = {line.name for line in picture.lines if getattr(line, "dashed", False)}
    handles: list[Patch | Line2D] = []
    for name, rgb in picture.legend:
        # Matplotlib leaves labels with an underscore in front out of its legends.
        label = f" {name}" if name.startswith("_") else name
        look = "--" if name in dashed else "-"
        line = Line2D([], [], color=rgb, linestyle=look, label=label)
        handles.append(line if name in thin else Patch(color=rgb, label=label))
    left, columns = 0.64, 1 + (len(handles) > 32)
    size = 8 if len(handles) <= 24 else 6

    def legend(size: float) -> Legend:
        place = {"loc": "upper left", "bbox_to_anchor": (left, 0.93)}
        return figure.legend(handles=handles, fontsize=size, ncols=columns, frameon=False, **place)

    drawn = legend(size)
    room = (0.99 - left) * figure.bbox.width
    width = drawn.get_window_extent().width
    if width > room:  # long names would be cut off at the edge
        drawn.remove()
        legend(max(_SMALLEST, size * room / width))
    figure.text(0.65, 0.03, "\n".join(picture.notes), fontsize=7, va="bottom")


def _space(axes: Axes, picture: Picture3D) -> None:
    """Everything seen in parallel from the picture's direction, what is nearer drawn later."""
    z = picture.towards
    x = np.cross([0.0, 0.0, 1.0] if abs(z[2]) < 0.999 else [0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    flat, corners, fills, widths = np.array([x, np.cross(z, x)]), [], [], []
    everything = [(layer.points[layer.triangles], layer.rgb) for layer in picture.layers]
    lines = [(line.ends, line.rgb, 0.8) for line in picture.lines]
    if picture.mesh is not None:
        everything += _areas(picture.mesh)
        lines += _on_mesh(picture.mesh)
    for triangles, rgb in everything:
        corners.append(triangles)
        fills.append(_shaded(triangles, rgb))
        # A line in the fill's own color closes the gaps that anti-aliasing leaves.
        widths.append(np.full(len(triangles), 0.4))
    span = float(max(np.ptp(part.reshape(-1, 3), axis=0).max() for part in corners))
    for ends, rgb, width in lines:  # moved towards the eye, before the surface that they are on
        corners.append(ends[:, [0, 1, 1]] + 0.03 * span * z)
        fills.append(np.tile(to_rgb(rgb), (len(ends), 1)))
        widths.append(np.full(len(ends), width))
    pieces = np.concatenate(corners)
    order = np.argsort((pieces @ z).mean(axis=1), kind="stable")
    colors = np.concatenate(fills)[order]
    faces = PolyCollection(
        pieces[order] @ flat.T,
        facecolors=colors,
        edgecolors=colors,
        linewidths=np.concatenate(widths)[order],
    )
    faces.set_gid("faces")
    axes.add_collection(faces)
    for text in picture.texts:
        if float(text.outward @ z) > 0:  # what lies on the far side would be on top as well
            _written(axes, text, flat @ text.at)
    _scale(axes, flat, span)


def _written(axes: Axes, text: Text, at: Array) -> None:
    """A number on its area, or a mark beside its place."""
    look: dict[str, Any] = {"ha": "center", "va": "center", "textcoords": "offset points"}
    if text.label is None:
        look["bbox"] = {"boxstyle": "round,pad=0.2", "fc": "white", "ec": WARNING}
        look["arrowprops"] = {"arrowstyle": "-", "color": WARNING, "shrinkB": 0}
    axes.annotate(text.text, tuple(at), xytext=(0, 16 if text.label is None else 0), **look)


def _areas(mesh: ClassedMesh) -> list[tuple[Array, str]]:
    """The triangles (t, 3, 3) of each class, with its fill."""
    points, triangles, owner = mesh_picture_parts(mesh.points, mesh.faces, mesh.labels)
    parts = [points[triangles[owner == number]] for number in range(len(mesh.classes))]
    return [(own, one.rgb) for own, one in zip(parts, mesh.classes, strict=True) if len(own)]


def _on_mesh(mesh: ClassedMesh) -> list[tuple[Array, str, float]]:
    """The pieces (k, 2, 3) of each kind of line, from the middle of a side to the face's center."""
    corners = mesh.points[mesh.faces]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    centers = np.broadcast_to(corners.mean(axis=1, keepdims=True), middles.shape)
    pieces = np.stack([middles, centers], axis=2)
    return [
        (pieces[mesh.lines == kind], kind.rgb, 2.4 if kind is Line.MARKED else 1.0)
        for kind in Line
        if kind
    ]


def _shaded(triangles: Array, rgb: str) -> Array:
    """A color (m, 3) for each triangle."""
    corners = np.arange(3 * len(triangles)).reshape(-1, 3)
    normals = TriangleMesh(triangles.reshape(-1, 3), corners).triangle_normals
    light = 0.86 + 0.14 * (np.nan_to_num(normals) @ _LIGHT)
    return np.asarray(np.array(to_rgb(rgb)) * light[:, None])


def _scale(axes: Axes, flat: Array, span: float) -> None:
    """The directions of x, y and z, and a bar of a round length, below on the left."""
    length = 10 ** np.floor(np.log10(span / 3))
    for (across, up), name in zip(0.05 * flat.T, "xyz", strict=True):
        axes.annotate(
            "", (0.08 + across, 0.07 + up), (0.08, 0.07), "axes fraction",
            arrowprops={"arrowstyle": "-|>", "color": INK},
        )  # fmt: skip
        axes.text(
            0.08 + 1.4 * across, 0.07 + 1.4 * up, name, ha="center", va="center",
            transform=axes.transAxes,
        )  # fmt: skip
    low = axes.get_xaxis_transform()  # x in meters, y as a share of the axes
    axes.autoscale_view()
    axes.apply_aspect()
    left, right = axes.get_xlim()
    start = left + 0.18 * (right - left)
    axes.plot([start, start + length], [0.04, 0.04], color=INK, linewidth=2, transform=low)
    axes.text(start, 0.05, f"{length:g} m", transform=low)


def _plane(axes: Axes, picture: Picture2D) -> None:
    lines = LineCollection(
        [curve.points for curve in picture.lines],
        colors=[curve.rgb for curve in picture.lines],
        linewidths=[curve.width for curve in picture.lines],
        linestyles=[(0, (3, 2)) if curve.dashed else "solid" for curve in picture.lines],
        path_effects=[withStroke(linewidth=3.0, foreground="#777777")],  # light on white
    )
    lines.set_gid("edges")
    axes.add_collection(lines)
    shapes = PolyCollection(
        [shape.points for shape in picture.outlines],
        facecolors=[shape.rgb for shape in picture.outlines],
        edgecolors=INK,
        linewidths=0.5,
        zorder=2,
    )
    shapes.set_gid("nodes")
    axes.add_collection(shapes)
    for text, at, size in picture.texts:
        x, y = at.tolist()
        axes.text(x, y, text, fontsize=size, ha="center", va="center", zorder=3)


_MARKS: dict[str, dict[str, Any]] = {
    "where it stands": {"marker": "+", "color": INK, "s": 120},
    "among the best": {"facecolors": "none", "edgecolors": INK, "s": 110},
    "the part cannot stand there": {"marker": "x", "color": GREY, "s": 16},
    "covers too little": {"marker": ".", "color": GREY, "s": 24},
    "no answer in time": {"marker": "1", "color": GREY, "s": 24},
}


def render_placements(found: Placements, kind: str) -> bytes:
    """All placements that were tried, over one or two of the variables that were moved.

    Each that covers enough is a dot in the color of its lift-offs, hollow where that is a lower
    bound. Of more than two variables, the map shows the first two.

    Args:
        kind: ``png`` or ``svg``.

    Raises:
        InputError: no placement but that of the scene was tried.
    """
    rows = [*found]
    poses = np.array([row.pose for row in rows])
    moved = [axis for axis, spread in enumerate(np.ptp(poses, axis=0)) if spread > 0][:2]
    if not moved:
        raise InputError(None, "map", "there is nothing to draw: one placement was tried")
    labels = [
        f"{VARIABLES[axis]}, {'m' if axis < len(VARIABLES) // 2 else 'rad'}" for axis in moved
    ]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9, 6), dpi=150, layout="constrained")
        axes = figure.subplots()
        drawn = set()
        for row, pose in zip(rows, poses, strict=True):
            at = [*pose[moved], row.least_lift_offs or 0][:2]
            for label, style in _styles(row, found):
                axes.scatter(*at, label="" if label in drawn else label, **style)
                drawn.add(label)
        axes.set_xlabel(labels[0])
        axes.set_ylabel([*labels, "lift-offs"][1])
        axes.set_title(f"{found.name}: placements that were tried", loc="left")
        figure.legend(loc="outside right upper", frameon=False, fontsize=8)
        return saved(figure, kind)


def _styles(row: PlacedMinimum, found: Placements) -> list[tuple[str, dict[str, Any]]]:
    """What is drawn for a placement, each with its label in the legend."""
    lift_offs, marks = row.least_lift_offs, []
    if row is found.here:
        marks.append("where it stands")
    if row in found.best:
        marks.append("among the best")
    if lift_offs is None:
        marks.append("the part cannot stand there" if row.refused else "no answer in time")
    elif row.rank(found.cover)[0]:
        marks.append("covers too little")
    else:
        color = LINES[lift_offs % len(LINES)]
        dot = {"facecolors": "none" if row.at_least else color, "edgecolors": color, "s": 40}
        name = f"{'at least ' if row.at_least else ''}{count(lift_offs, 'lift-off')}"
        return [*((label, _MARKS[label]) for label in marks), (name, dot)]
    return [(label, _MARKS[label]) for label in marks]
