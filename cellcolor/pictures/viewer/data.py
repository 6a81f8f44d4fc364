"""A picture as the JSON that ``view.js`` draws; arrays are base64."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from cellcolor.pictures.picture import ClassedMesh, Layer, Picture3D, SpaceLines, Text


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
