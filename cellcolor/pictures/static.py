"""PNG and SVG with Matplotlib, without a display."""

from __future__ import annotations

import io
from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from cellcolor.arrays import Array
from cellcolor.files.writing import MARKER
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.pictures.palette import INK
from cellcolor.pictures.picture import Layer, Picture2D, Picture3D

_LIGHT = np.array([0.3, -0.5, 0.81])
_SMALLEST = 3.5
"""Points; what is written in smaller letters is not read."""
_STYLE = {
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
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(11, 7), dpi=150)
        FigureCanvasAgg(figure)
        legend = (
            _plane(figure, picture) if isinstance(picture, Picture2D) else _space(figure, picture)
        )
        figure.suptitle(picture.title, x=0.02, ha="left", fontsize=12)
        _side(figure, legend, picture.notes)
        stream = io.BytesIO()
        metadata = {"Creator": MARKER} | ({"Date": None} if kind == "svg" else {})
        figure.savefig(stream, format=kind, metadata=metadata)
    return stream.getvalue()


def _side(figure: Figure, handles: Sequence[Patch | Line2D], notes: Sequence[str]) -> None:
    """Legend and notes to the right of the drawing."""
    columns = 1 + (len(handles) > 32)
    size = 8 if len(handles) <= 24 else 6
    # Matplotlib leaves labels with an underscore in front out of its legends.
    for handle in handles:
        if str(handle.get_label()).startswith("_"):
            handle.set_label(f" {handle.get_label()}")
    left = 0.64

    def legend(size: float) -> Legend:
        place = {"loc": "upper left", "bbox_to_anchor": (left, 0.93)}
        return figure.legend(handles=handles, fontsize=size, ncols=columns, frameon=False, **place)

    drawn = legend(size)
    room = (0.99 - left) * figure.bbox.width
    width = drawn.get_window_extent().width
    if width > room:  # long names would be cut off at the edge
        drawn.remove()
        legend(max(_SMALLEST, size * room / width))
    figure.text(0.65, 0.03, "\n".join(notes), fontsize=7, va="bottom")


def _space(figure: Figure, picture: Picture3D) -> list[Patch | Line2D]:
    axes = figure.add_axes((0.0, 0.02, 0.64, 0.92), projection="3d")
    assert isinstance(axes, Axes3D)
    points = np.concatenate([layer.points for layer in picture.layers])
    # One collection for all: Matplotlib sorts by depth only within a collection, and sorts
    # colors along, but no widths.
    corners: list[Array] = []
    fills: list[Array] = []
    inks: list[Array] = []
    for layer in picture.layers:
        shades = _shades(layer)
        corners.append(layer.points[layer.triangles])
        fills.append(shades)
        # A line in the fill's own color closes the gaps that anti-aliasing leaves.
        inks.append(shades)
    # Seen in parallel, a shift towards the eye moves lines before their surface and nothing else.
    nearer = 0.03 * float(np.ptp(points, axis=0).max()) * picture.towards
    for line in picture.lines:
        corners.append(line.ends[:, [0, 1, 1]] + nearer)
        color = np.tile([*to_rgb(line.rgb), 1.0], (len(line.ends), 1))
        fills.append(color)
        inks.append(color)
    faces = Poly3DCollection(
        list(np.concatenate(corners)),
        facecolors=np.concatenate(fills),
        edgecolors=np.concatenate(inks),
        linewidths=0.8,
    )
    faces.set_gid("faces")
    axes.add_collection3d(faces)
    _frame(axes, points, picture.towards)
    for text in picture.texts:
        # Text is always drawn on top: leave out what lies on the far side.
        if float(text.outward @ picture.towards) > 0:
            axes.text(*text.at.tolist(), text.text, fontsize=8, ha="center", va="center")
    handles: list[Patch | Line2D] = [
        Patch(color=layer.rgb, label=layer.name) for layer in picture.layers
    ]
    handles += [
        Line2D([], [], color=line.rgb, linewidth=0.8, label=line.name) for line in picture.lines
    ]
    return handles


def _frame(axes: Axes3D, points: Array, towards: Array) -> None:
    """Axes in meters, the same scale on each, seen from ``towards``."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.02 * float((high - low).max())
    low, high = low - margin, high + margin
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.set_box_aspect(tuple((high - low).tolist()), zoom=0.9)
    axes.set_proj_type("ortho")
    shares = (high - low) / (high - low).max()
    for axis, share, middle in zip("xyz", shares.tolist(), (low + high) / 2, strict=True):
        if share < 0.1:  # two labels would lie on each other
            axes.set(**{f"{axis}ticks": [round(float(middle), 3)]})
        else:
            axes.locator_params(axis=axis, nbins=max(2, round(6 * share)))
    elevation = np.degrees(np.arcsin(towards[2]))
    axes.view_init(
        elev=float(elevation), azim=float(np.degrees(np.arctan2(towards[1], towards[0])))
    )


def _shades(layer: Layer) -> Array:
    """A color (m, 4) for each triangle."""
    color = np.tile(np.array([*to_rgb(layer.rgb), 1.0]), (len(layer.triangles), 1))
    if layer.solid:
        normals = np.nan_to_num(TriangleMesh(layer.points, layer.triangles).triangle_normals)
        color[:, :3] *= 0.775 + 0.225 * (normals @ _LIGHT)[:, None]
    return color


def _plane(figure: Figure, picture: Picture2D) -> list[Patch | Line2D]:
    axes = figure.add_axes((0.01, 0.02, 0.63, 0.92))
    axes.set_axis_off()
    axes.set_aspect("equal")
    lines = LineCollection(
        [curve.points for curve in picture.lines],
        colors=[curve.rgb for curve in picture.lines],
        linewidths=[curve.width for curve in picture.lines],
        linestyles=[(0, (3, 2)) if curve.dashed else "solid" for curve in picture.lines],
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
    axes.autoscale_view()
    kinds = {curve.name: curve for curve in picture.lines}
    return [
        Line2D([], [], color=c.rgb, linestyle="--" if c.dashed else "-", label=name)
        for name, c in kinds.items()
    ]
