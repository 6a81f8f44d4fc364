"""Pages in a real browser: something is drawn, nothing is cut off, and the controls are reached."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from meshes import drawn
from pages import DESKTOP, PHONE, opened
from PIL import Image

import cellcolor
from cellcolor.pictures.picture import paints_of

pytestmark = pytest.mark.second

NAMES = {"A": [0], "B": [0, 1], "C": [1], "-": []}
SURFACE = drawn("AABBCC AABBCC AA--CC", NAMES)


def pixels(page: Any) -> np.ndarray:
    """What is on the canvas and over it, (height, width, 3)."""
    page.wait_for_timeout(300)
    image = Image.open(io.BytesIO(page.locator("#view").screenshot()))
    return np.asarray(image.convert("RGB")).astype(int)


def near(shown: np.ndarray, rgb: str) -> int:
    """How many pixels have a fill, a little lighter or darker as light falls on it."""
    wanted = np.array([int(rgb[k : k + 2], 16) for k in (1, 3, 5)])
    shade = np.clip(shown.sum(axis=2) / wanted.sum(), 0.6, 1.15)[:, :, None]
    return int((abs(shown - shade * wanted) < 12).all(axis=2).sum())


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A division, the verdict on a plan that can be beaten, and a graph."""
    folder = tmp_path_factory.mktemp("pages")
    worse = [own[(vertex + 1) % len(own)] if own else None
             for vertex, own in enumerate(SURFACE.vertex_colors)]  # fmt: skip
    cellcolor.solve(SURFACE).plot(folder / "segments.html")
    cellcolor.judge(SURFACE, cellcolor.Plan(tuple(worse))).plot(folder / "verdict.html")
    cellcolor.show(SURFACE, folder / "graph.html", view="graph")
    return {file.stem: file for file in folder.iterdir()}


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
@pytest.mark.parametrize("name", ["segments", "verdict", "graph"])
def test_everything_is_seen_and_nothing_cut_off(
    name: str, size: tuple[int, int], pages: dict[str, Path]
) -> None:
    with opened(pages[name], size) as (page, faults):
        assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
        entries = page.locator("#legend > *")
        assert entries.count() >= 2
        for entry in entries.all():
            box = entry.bounding_box()
            assert box["x"] >= 0 and box["x"] + box["width"] <= size[0]
            assert box["height"] >= 15 and entry.inner_text()
        shown = pixels(page)
        if name != "graph":
            for paint in paints_of(SURFACE.colors).values():
                assert (near(shown, paint) > 1500) == (paint in list(used(page)))
        assert len(np.unique(shown.reshape(-1, 3), axis=0)) > 20
        assert faults == []


def used(page: Any) -> set[str]:
    """The fills of the legend's entries, like ``#77AADD``."""
    fills = [mark.evaluate("mark => mark.style.background")
             for mark in page.locator("#legend i").all()]  # fmt: skip
    numbers = [fill[4:-1].split(",") for fill in fills]
    return {"#" + "".join(f"{int(part):02X}" for part in own) for own in numbers}


def test_an_entry_of_the_legend_is_a_switch(pages: dict[str, Path]) -> None:
    """Of an area: neither it nor its number is seen. All by keyboard."""
    fill = paints_of(SURFACE.colors)["red"]
    with opened(pages["segments"], DESKTOP) as (page, faults):
        assert near(pixels(page), fill) > 1500
        entry = page.locator("#legend button", has_text="segment 0: red")
        numbers = page.locator("#overlay .number:visible").count()
        entry.focus()
        page.keyboard.press("Enter")
        assert entry.get_attribute("aria-pressed") == "false"
        assert near(pixels(page), fill) < 100
        assert page.locator("#overlay .number:visible").count() == numbers - 1
        page.keyboard.press("Enter")
        assert near(pixels(page), fill) > 1500
        assert faults == []


def test_it_is_turned_by_mouse_and_keyboard_and_set_back(pages: dict[str, Path]) -> None:
    with opened(pages["segments"], DESKTOP) as (page, faults):
        canvas = page.get_by_role("img", name="3D view")
        first, seen = pixels(page), []
        canvas.focus()
        for key in ("ArrowLeft", "ArrowUp", "+"):
            page.keyboard.press(key)
            seen.append(pixels(page))
        box = canvas.bounding_box()
        page.mouse.move(box["x"] + 300, box["y"] + 300)
        page.mouse.down()
        page.mouse.move(box["x"] + 400, box["y"] + 320)
        page.mouse.up()
        seen.append(pixels(page))
        for before, after in zip([first, *seen], seen, strict=False):
            assert (abs(before - after).max(axis=2) > 20).sum() > 500
        page.get_by_role("button", name="Reset view").click()
        page.locator("#legend").click(position={"x": 2, "y": 2})  # nothing has the focus
        assert (abs(pixels(page) - first).max(axis=2) > 60).sum() < 500
        assert faults == []


def test_marks_of_a_verdict_are_drawn(pages: dict[str, Path]) -> None:
    with opened(pages["verdict"], DESKTOP) as (page, faults):
        assert page.locator("#overlay .mark:visible").count() == 2
        assert near(pixels(page), "#AA0077") > 500
        assert faults == []
