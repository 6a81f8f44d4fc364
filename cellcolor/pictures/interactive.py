"""One self-contained HTML file to turn with the mouse, with plotly; it loads nothing."""

from __future__ import annotations

import html
from typing import Any

import numpy as np
import plotly.graph_objects as go

from cellcolor.arrays import Array
from cellcolor.files.writing import MARKER
from cellcolor.pictures.palette import INK
from cellcolor.pictures.picture import Layer, Picture2D, Picture3D, SpaceLines


def render(picture: Picture2D | Picture3D) -> bytes:
    """The page; the same picture gives the same bytes."""
    figure = go.Figure(_plane(picture) if isinstance(picture, Picture2D) else _space(picture))
    figure.update_layout(
        title={"text": _plain(picture.title)},
        template="plotly_white",
        margin={"l": 10, "r": 10, "t": 50, "b": 10},
        legend={"itemsizing": "constant"},
        annotations=[
            {
                "text": "<br>".join(map(_plain, picture.notes)),
                "xref": "paper",
                "yref": "paper",
                "x": 0,
                "y": 0,
                "xanchor": "left",
                "yanchor": "bottom",
                "align": "left",
                "bgcolor": "rgba(255, 255, 255, 0.7)",
                "showarrow": False,
            }
        ],
    )
    if isinstance(picture, Picture2D):
        hidden = {"visible": False}
        figure.update_layout(xaxis=hidden, yaxis=hidden | {"scaleanchor": "x"})
    else:
        eye = dict(zip("xyz", (1.8 * picture.towards).tolist(), strict=True))
        axes = {f"{axis}axis": {"title": {"text": f"{axis} [m]"}} for axis in "xyz"}
        figure.update_layout(scene={"aspectmode": "data", "camera": {"eye": eye}} | axes)
    page: str = figure.to_html(
        include_plotlyjs=True,
        div_id="picture",
        default_height="92vh",
        config={"displaylogo": False, "responsive": True},
    )
    return page.replace("<head>", f'<head><meta name="generator" content="{MARKER}" />', 1).encode()


def _plain(text: str) -> str:
    """Text that plotly writes as it is; it takes a few HTML tags in texts for markup."""
    return html.escape(text, quote=False)


def _space(picture: Picture3D) -> list[Any]:
    traces = [_mesh(layer) for layer in picture.layers]
    traces += [_pieces(line) for line in picture.lines]
    if picture.texts:
        # A little before the surface, which would cut through the letters otherwise.
        size = max(float(np.ptp(layer.points, axis=0).max()) for layer in picture.layers)
        x, y, z = np.array([text.at + 0.02 * size * text.outward for text in picture.texts]).T
        traces.append(
            go.Scatter3d(
                x=x,
                y=y,
                z=z,
                text=[text.text for text in picture.texts],
                mode="text",
                textposition="middle center",
                textfont={"color": INK, "size": 14},
                name="numbers",
                hoverinfo="skip",
            )
        )
    return traces


def _mesh(layer: Layer) -> Any:
    x, y, z = layer.points.T
    i, j, k = layer.triangles.T
    flat = {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0, "fresnel": 0.0}
    solid = {"ambient": 0.8, "diffuse": 0.4, "specular": 0.05}
    return go.Mesh3d(
        x=x,
        y=y,
        z=z,
        i=i,
        j=j,
        k=k,
        color=layer.rgb,
        flatshading=True,
        lighting=solid if layer.solid else flat,
        name=_plain(layer.name),
        showlegend=True,
        hoverinfo="name",
        hoverlabel={"namelength": -1},
    )


def _pieces(line: SpaceLines) -> Any:
    gap = np.full((len(line.ends), 1, 3), np.nan)
    x, y, z = np.concatenate([line.ends, gap], axis=1).reshape(-1, 3).T
    look = {"color": line.rgb, "width": 2}
    return go.Scatter3d(
        x=x, y=y, z=z, mode="lines", line=look, name=_plain(line.name), hoverinfo="skip"
    )


def _plane(picture: Picture2D) -> list[Any]:
    traces: list[Any] = []
    named: set[str] = set()
    for curve in picture.lines:
        look = {"color": curve.rgb, "width": curve.width, "dash": "4px" if curve.dashed else None}
        shown = curve.name not in named
        named.add(curve.name)
        traces.append(_outline(curve.points, curve.name, shown, line=look, legendgroup=curve.name))
    ink = {"color": INK, "width": 0.7}
    for shape in picture.outlines:
        closed = np.concatenate([shape.points, shape.points[:1]])
        traces.append(_outline(closed, "", False, line=ink, fill="toself", fillcolor=shape.rgb))
    for size in sorted({size for _, _, size in picture.texts}):
        own = [(text, at) for text, at, own_size in picture.texts if own_size == size]
        x, y = np.array([at for _, at in own]).T
        font = {"size": 1.4 * size, "color": INK}
        traces.append(
            go.Scatter(
                x=x,
                y=y,
                text=[text for text, _ in own],
                mode="text",
                textfont=font,
                showlegend=False,
                hoverinfo="skip",
            )
        )
    return traces


def _outline(points: Array, name: str, shown: bool, **look: Any) -> Any:
    x, y = points.T
    return go.Scatter(
        x=x, y=y, mode="lines", name=_plain(name), showlegend=shown, hoverinfo="skip", **look
    )
