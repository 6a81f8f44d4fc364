"""``show``: the files that it writes."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import pytest
from pages import (
    DRAWN,
    area_of,
    meshes,
    saved,
    show,
    traces,
)


def is_text(element: ET.Element) -> bool:
    return element.tag.endswith("}text")


class TestFiles:
    def test_svg(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.svg")
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        root = ET.parse(tmp_path / "x.svg").getroot()
        texts = ["".join(element.itertext()).strip() for element in root.iter() if is_text(element)]
        found = traces(tmp_path / "x.html")
        for trace in found:
            if trace["type"] == "mesh3d" or trace.get("mode") == "lines":
                assert re.sub(" +", " ", trace["name"]) in [re.sub(" +", " ", t) for t in texts]
        assert {"x [m]", "y [m]", "z [m]", "drawn: 4 cells"} <= set(texts)
        (faces,) = [element for element in root.iter() if element.get("id") == "faces"]
        pieces = sum(len(t["i"]) for t in found if t["type"] == "mesh3d")
        pieces += sum(len(t["x"]) // 3 for t in found if t.get("mode") == "lines")
        drawn_paths = [e for e in faces.iter() if e.tag.endswith(("}path", "}use"))]
        assert len(drawn_paths) == pieces

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
        assert any(text.startswith("_red ") for text in texts)
        assert {"a $part$: 4 cells", "1: $x_1^2$", "2: <b>"} <= set(texts)
        show(saved(surface, tmp_path), "--color", "<b>", "-o", tmp_path / "x.html")
        assert "&lt;b&gt;" in meshes(tmp_path / "x.html")

    def test_nothing_reachable(self, tmp_path: Path) -> None:
        surface = replace(DRAWN, vertex_colors=((),) * 30, cracks=())
        for kind in ("html", "svg", "png"):
            show(saved(surface, tmp_path), "-o", tmp_path / f"x.{kind}")
        assert set(meshes(tmp_path / "x.html")) == {"unreachable"}

    def test_png_has_the_colors_of_its_legend(self, tmp_path: Path) -> None:
        from matplotlib.image import imread

        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.png")
        pixels = (imread(tmp_path / "x.png")[:, :, :3] * 255).round().astype(int)
        drawing = pixels[:, : int(0.63 * pixels.shape[1])].reshape(-1, 3)
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        for trace in meshes(tmp_path / "x.html").values():
            wanted = [int(trace["color"][k : k + 2], 16) for k in (1, 3, 5)]
            # About the same size on paper as on the surface: seen from 15 degrees off its normal.
            assert (drawing == wanted).all(axis=1).sum() > 3000 * area_of(trace)

    @pytest.mark.parametrize("kind", ["html", "png", "svg"])
    @pytest.mark.parametrize("options", [[], ["--graph"]], ids=str)
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

    def test_an_existing_file_is_replaced_whole(self, tmp_path: Path) -> None:
        path = saved(DRAWN, tmp_path)
        (tmp_path / "x.png").touch()
        show(path, "-o", tmp_path / "x.png")
        assert (tmp_path / "x.png").read_bytes()[:4] == b"\x89PNG"
        assert sorted(tmp_path.iterdir()) == [path, tmp_path / "x.png"]
