"""What version 1 of the formats did otherwise, as far as files of it are still read."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from typing import Any

from cellcolor.files.documents import dump_lines


def fingerprint_of_version_1(body: dict[str, Any]) -> str:
    """SHA-256 of the text that was written for an instance when there was only version 1."""

    def part(element: dict[str, Any], names: Sequence[str], measure: str = "") -> dict[str, Any]:
        taken = {name: element[name] for name in names if element.get(name) is not None}
        size = element.get(measure)
        return taken | ({} if size is None else {measure: float(size)})

    document: dict[str, Any] = {"format": "cellcolor/instance", "version": 1}
    document |= {"name": body["name"], "colors": body["colors"]}
    document["cells"] = [part(c, ("id", "colors", "loops"), "area") for c in body["cells"]]
    document["edges"] = [
        part(e, ("id", "left", "right", "colors"), "length") for e in body["edges"]
    ]
    if body.get("meta") is not None:
        document["meta"] = body["meta"]
    if body.get("surface") is not None:
        document["surface"] = part(body["surface"], ("path", "vertex_cell"))
    if body.get("known") is not None:
        document["known"] = {
            space: part(body["known"][space], ("segments", "schemes"))
            for space in ("paper", "surface")
            if body["known"].get(space) is not None
        }
    text = dump_lines(document, frozenset({"cells", "edges"}))
    return hashlib.sha256(text.encode()).hexdigest()
