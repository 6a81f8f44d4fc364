"""The page, put together: texts, styles, scripts and data in one file that loads nothing."""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Iterable, Sequence
from importlib.resources import files
from string import Template
from typing import Any

import numpy as np

from cellcolor.files.writing import MARKER
from cellcolor.pictures.picture import ClassedMesh, Layer, Picture2D, Picture3D, SpaceLines, Text
from cellcolor.version import __version__


def packed(values: Any, kind: str) -> dict[str, str]:
    """An array as little-endian bytes; the kind is ``f4``, ``u4``, ``i2`` or ``u1``."""
    content = np.ascontiguousarray(values, dtype=f"<{kind}")
    return {"kind": kind, "base64": base64.b64encode(content.tobytes()).decode()}


def picture_data(modes: Sequence[Picture3D], buttons: int = 0) -> dict[str, Any]:
    """The data of a picture, or of several of one mesh, of which one at a time is shown.

    Args:
        modes: their mesh, solids, lines and direction are those of the first one.
        buttons: how many of the modes, the first ones, have a button.
    """
    first = modes[0]
    return {
        "mesh": None if first.mesh is None else _triangles(first.mesh.points, first.mesh.faces),
        "modes": [_mode(mode, mode.mesh) for mode in modes if mode.mesh is not None],
        "buttons": buttons,
        "layers": [layer_data(layer) for layer in first.layers],
        "lines": [lines_data(lines) for lines in first.lines],
        "marks": [] if first.mesh is not None else [text_data(text) for text in first.texts],
        "towards": first.towards.tolist(),
        "motion": None,
    }


def layer_data(layer: Layer, joint: int | None = None) -> dict[str, Any]:
    """A solid, in the frame of a joint or in the world."""
    own = {"name": layer.name, "rgb": layer.rgb, "joint": joint}
    return own | _triangles(layer.points, layer.triangles)


def lines_data(lines: SpaceLines) -> dict[str, Any]:
    """Straight pieces."""
    return {"name": lines.name, "rgb": lines.rgb, "ends": packed(lines.ends, "f4")}


def _triangles(points: Any, triangles: Any) -> dict[str, Any]:
    return {"points": packed(points, "f4"), "triangles": packed(triangles, "u4")}


def _mode(picture: Picture3D, mesh: ClassedMesh) -> dict[str, Any]:
    return {
        "name": picture.title,
        "classes": [{"name": own.name, "rgb": own.rgb} for own in mesh.classes],
        "legend": [{"name": name, "rgb": rgb, "line": line} for name, rgb, line in mesh.legend],
        "labels": packed(mesh.labels, "i2"),
        "sides": packed(mesh.lines, "u1"),
        "texts": [text_data(text) for text in picture.texts],
    }


def text_data(text: Text) -> dict[str, Any]:
    """A number of a class, or a mark."""
    return {
        "text": text.text,
        "at": text.at.tolist(),
        "outward": text.outward.tolist(),
        "label": text.label,
        "kind": "mark" if text.label is None else "number",
    }


_SCRIPTS = ("three.min.js", "view.js", "charts.js", "player.js")


def render(picture: Picture2D | Picture3D) -> bytes:
    """The page of a picture; the same picture gives the same bytes."""
    if isinstance(picture, Picture3D):
        return render_page(picture.title, picture_data([picture]), notes=picture.notes)
    from cellcolor.pictures.static import render_drawing

    drawn = render_drawing(picture).decode()
    entries = "".join(
        f'<span><i class="line" style="background:{rgb}"></i>{html.escape(name)}</span>'
        for name, rgb in picture.legend
    )
    return render_page(
        picture.title, None, notes=picture.notes, drawing=drawn[drawn.index("<svg") :], key=entries
    )


def render_page(
    title: str,
    data: dict[str, Any] | None,
    *,
    notes: Iterable[str] = (),
    header: str = "",
    cards: str = "",
    drawing: str = "",
    key: str = "",
) -> bytes:
    """A page about what ``data`` draws, or about a drawing.

    Args:
        title: one line.
        data: what :func:`picture_data` makes, perhaps with a motion; None for a drawing.
        notes: lines under the legend.
        header: HTML under the title.
        cards: HTML under the picture.
        drawing: SVG that takes the place of the view.
        key: HTML of its legend.
    """
    moving = data is not None and data["motion"] is not None
    kind = "moving" if moving else "still" if data is not None else "still drawn"
    scripts = [f"<script>\n{_own_text(name)}</script>" for name in _SCRIPTS]
    parts = {
        "MARKER": MARKER,
        "TITLE": html.escape(title),
        "HEADER": header,
        "KIND": kind,
        "DRAWING": drawing,
        "KEY": key,
        "NOTES": "".join(f"<p>{html.escape(note)}</p>" for note in notes),
        "CARDS": cards,
        "FOOTER": html.escape(f"Made by cellcolor {__version__}; this file loads nothing."),
        "STYLE": _own_text("page.css"),
        "DATA": _json(data),
        "SCRIPTS": "" if data is None else "\n".join(scripts),
    }
    return Template(_own_text("page.html")).substitute(parts).encode()


def _json(data: dict[str, Any] | None) -> str:
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")  # nothing in it ends the script


def _own_text(name: str) -> str:
    return (files(__package__) / name).read_text(encoding="utf-8")
