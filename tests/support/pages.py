"""Pages in a real browser, headless; tests that need one are skipped where there is none.

Drawing with the command line, and reading pages back.
"""

from __future__ import annotations

import base64
import json
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documents import Document
from library import INSTANCES
from meshes import drawn
from numpy.typing import NDArray

from cellcolor.cli import main
from cellcolor.data.surface import LabelledSurface

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
DESKTOP, PHONE = (1400, 900), (390, 844)


@contextmanager
def opened(file: Path, size: tuple[int, int]) -> Iterator[tuple[Any, list[str]]]:
    """A page in a window of a size, and what it complained of or asked the network for."""
    api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("there is no chromium to open pages with")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        faults: list[str] = []
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("console", lambda said: faults.append(said.text) if said.type == "error" else None)
        page.on(
            "request",
            lambda asked: None if asked.url == file.as_uri() else faults.append(asked.url),
        )
        page.goto(file.as_uri())
        yield page, faults
        browser.close()


WOK = INSTANCES / "scenes" / "wok.toml"

DRAWN = drawn(
    "aaaabb aacabb aaaab. ddd... ddd...",
    {"a": [0], "b": [0, 1], "c": [1, 2], "d": [2], ".": []},
    cracks=[(0, 1, 0), (7, 13, 0), (4, 5, 1)],
)


def show(*arguments: object) -> None:
    assert main(["show", *map(str, arguments)]) == 0


def saved(surface: LabelledSurface, folder: Path) -> Path:
    path = folder / "drawn.surface.json"
    path.write_text(surface.to_json(), encoding="utf-8")
    return path


def page_data(page: str) -> Document:
    """What a page's scripts draw."""
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page)
    return json.loads(text)


def unpacked(packed: Document) -> NDArray[Any]:
    return np.frombuffer(base64.b64decode(packed["base64"]), "<" + packed["kind"])


def areas(path: Path) -> dict[str, set[int]]:
    """The vertices of each area of a page, by the first words of its name."""
    (mode,) = page_data(path.read_text(encoding="utf-8"))["modes"]
    labels = unpacked(mode["labels"])
    return {
        re.split(r", | \{|: ", own["name"])[0]: set(np.flatnonzero(labels == number).tolist())
        for number, own in enumerate(mode["classes"])
        if (labels == number).any()
    }


def solids(path: Path) -> dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]]:
    """Points and triangles of each solid of a page."""
    return {
        layer["name"]: (
            unpacked(layer["points"]).reshape(-1, 3).astype(float),
            unpacked(layer["triangles"]).reshape(-1, 3).astype(int),
        )
        for layer in page_data(path.read_text(encoding="utf-8"))["layers"]
    }


def side_file(folder: Path, change: dict[str, Any] | None = None) -> tuple[Path, Document]:
    """A surface with hand-made reasons beside it: two branches, one color a branch."""
    count = len(DRAWN.vertices)
    colors = [set(own) for own in DRAWN.vertex_colors]
    node_color = np.array([[0 if 0 in own else -1, 1 if 1 in own else -1] for own in colors])
    reasons = np.where(node_color >= 0, 0, np.array([[1, 3]] * count)).astype(np.uint8)
    reasons[29] = [0, 2]  # valid, but no color: a sliver policy took it
    arrays: Document = {
        "branches": np.array(["left arm", "right arm"]),
        "reason_names": np.array(["valid", "no solution", "torque", "ground"]),
        "reasons": reasons,
        "configurations": np.zeros((count, 2, 6)),
        "node_color": node_color.astype(np.int16),
    } | (change or {})
    np.savez(folder / "side.npz", **arrays)
    surface = replace(DRAWN, meta={"side_file": "side.npz"})
    return saved(surface, folder), arrays


OBSTACLES = """
[[obstacle]]
kind = "box"
size_m = [0.1, 0.2, 0.3]
position_m = [-0.5, 0.0, 0.2]

[[obstacle]]
kind = "mesh"
file = "corner.ply"
meters_per_unit = 0.001
position_m = [-0.6, 0.5, 0.1]
"""
CORNER = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
100 0 0
0 100 0
0 0 100
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""


def small_wok(folder: Path, more: str = "") -> Path:
    """A coarse wok with a box and a mesh far from the arm, in a folder of its own."""
    text = WOK.read_text(encoding="utf-8")
    text = text.replace("../../models", (INSTANCES.parent / "models").as_posix())
    text = re.sub(r"target_vertices = \d+", "target_vertices = 91", text)
    path = folder / "scene" / "wok.toml"
    path.parent.mkdir()
    path.write_text(text + OBSTACLES + more, encoding="utf-8")
    (path.parent / "corner.ply").write_text(CORNER, encoding="utf-8")
    return path
