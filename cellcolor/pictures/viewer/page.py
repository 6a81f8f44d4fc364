"""The page, put together: texts, styles, scripts and data in one file that loads nothing."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from importlib.resources import files
from typing import Any

from cellcolor.files.writing import MARKER
from cellcolor.pictures.picture import Picture2D, Picture3D
from cellcolor.pictures.viewer.data import picture_data
from cellcolor.version import __version__

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
        data: see :mod:`cellcolor.pictures.viewer.data`; None for a drawing.
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
    # What is filled in is not looked at again.
    first, *pieces = _own_text("page.html").split("{{")
    text = [first]
    for piece in pieces:
        name, _, rest = piece.partition("}}")
        text += [parts[name], rest]
    return "".join(text).encode()


def _json(data: dict[str, Any] | None) -> str:
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")  # nothing in it ends the script


def _own_text(name: str) -> str:
    return (files(__package__) / name).read_text(encoding="utf-8")
