"""``show``: the files that it writes."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pages import DRAWN, areas, page_data, saved, show

from cellcolor.decomposition import decomposition_of
from cellcolor.pictures.mesh_picture import mesh_picture_parts
from cellcolor.pictures.surface_pictures import draw_cells


def is_text(element: ET.Element) -> bool:
    return element.tag.endswith("}text")


class TestFiles:
    def test_svg(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.svg")
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        root = ET.parse(tmp_path / "x.svg").getroot()
        texts = ["".join(element.itertext()).strip() for element in root.iter() if is_text(element)]
        (mode,) = page_data((tmp_path / "x.html").read_text())["modes"]
        names = {own["name"] for own in mode["legend"]}
        # The three axes, and a bar of a tenth to a third of the surface's five meters.
        assert names | {"x", "y", "z", "1 m", "drawn: 4 cells"} <= set(texts)
        (faces,) = [element for element in root.iter() if element.get("id") == "faces"]
        mesh = draw_cells(DRAWN, decomposition_of(DRAWN)).mesh
        assert mesh is not None
        _, pieces, _ = mesh_picture_parts(mesh.points, mesh.faces, mesh.labels)
        drawn_paths = [e for e in faces.iter() if e.tag.endswith(("}path", "}use"))]
        assert len(drawn_paths) == len(pieces) + (mesh.lines > 0).sum()

    def test_names_are_written_as_they_are(self, tmp_path: Path) -> None:
        surface = replace(DRAWN, name="a $part$", colors=("_red", "$x_1^2$", "<b>"))
        show(saved(surface, tmp_path), "--color", "_red", "-o", tmp_path / "x.svg")
        show(saved(surface, tmp_path), "-o", tmp_path / "y.svg")
        texts = [
            "".join(element.itertext()).strip()
            for name in ("x.svg", "y.svg")
            for element in ET.parse(tmp_path / name).getroot().iter()
            if is_text(element)
        ]
        assert any(text.startswith("_red, ") for text in texts)
        assert {"a $part$: 4 cells", "1: $x_1^2$", "2: <b>"} <= set(texts)
        show(saved(surface, tmp_path), "--color", "<b>", "-o", tmp_path / "x.html")
        assert "<b>" in areas(tmp_path / "x.html")
        assert "<b>" not in (tmp_path / "x.html").read_text()

    def test_nothing_reachable(self, tmp_path: Path) -> None:
        surface = replace(DRAWN, vertex_colors=((),) * 30, cracks=())
        for kind in ("html", "svg", "png"):
            show(saved(surface, tmp_path), "-o", tmp_path / f"x.{kind}")
        assert set(areas(tmp_path / "x.html")) == {"unreachable"}

    def test_png_has_the_colors_of_its_legend_and_is_filled(self, tmp_path: Path) -> None:
        from matplotlib.image import imread

        mesh = draw_cells(DRAWN, decomposition_of(DRAWN)).mesh
        assert mesh is not None
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.png")
        pixels = (imread(tmp_path / "x.png")[:, :, :3] * 255).round().astype(int)
        drawing = pixels[: int(0.9 * len(pixels)), : int(0.63 * pixels.shape[1])]
        # The surface faces up, and light falls on it from above, almost along its normal.
        light = 0.86 + 0.14 * 0.81
        for _, rgb, line in mesh.legend:
            wanted = np.array([int(rgb[k : k + 2], 16) for k in (1, 3, 5)]) * (1 if line else light)
            near = (abs(drawing - wanted) <= 1).all(axis=2)
            assert near.sum() > (150 if line else 3000), rgb
        inked = np.flatnonzero((drawing.min(axis=2) < 200).any(axis=0))
        assert np.ptp(inked) > 0.85 * drawing.shape[1]

    @pytest.mark.parametrize("kind", ["html", "png", "svg"])
    @pytest.mark.parametrize("options", [[], ["--view", "graph"]], ids=str)
    def test_same_input_same_bytes(self, kind: str, options: list[str], tmp_path: Path) -> None:
        path = saved(DRAWN, tmp_path)
        for name in ("a", "b"):
            show(path, *options, "-o", tmp_path / f"{name}.{kind}")
        assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()

    def test_html_loads_nothing(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        page = (tmp_path / "x.html").read_text(encoding="utf-8")
        assert not re.search(r"<script[^>]*\ssrc=", page)
        assert not re.search(r"<(link|img|iframe)\s[^>]*(src|href)=", page.partition("<script")[0])
        assert not re.search(r"""\ssrc=["']?(https?:)?//""", page)
        assert "default-src 'none'" in page and len(page) < 1_000_000
