"""Surfaces by cell and by color, read back from what was written and held against the inputs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from meshes import finer, octahedron
from meshes import surface as labelled
from pages import (
    DRAWN,
    area_of,
    meshes,
    points,
    saved,
    show,
    traces,
    vertices_in,
)

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.pictures.palette import AREAS, assign

pytest.importorskip("matplotlib")
pytest.importorskip("plotly")


def holding(instance: Instance) -> dict[str, set[int]]:
    """The vertices of each cell, under the names of the legend."""
    assert instance.surface is not None
    found: dict[str, set[int]] = {}
    for vertex, cell in enumerate(instance.surface.vertex_cell):
        name = "unreachable" if cell == OUTSIDE else f"cell {cell}"
        found.setdefault(name, set()).add(vertex)
    return found


class TestCells:
    def test_every_vertex_lies_in_the_area_of_its_cell(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        instance = decompose(DRAWN, "drawn.surface.json")
        found = meshes(tmp_path / "x.html")
        assert {name: vertices_in(t, DRAWN) for name, t in found.items()} == holding(instance)

    def test_areas_are_those_of_the_cells(self, tmp_path: Path) -> None:
        """The decomposition sums the dual areas on its own."""
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        found = meshes(tmp_path / "x.html")
        for cell in decompose(DRAWN).cells:
            trace = found[f"cell {cell.id}"]
            assert area_of(trace) == pytest.approx(cell.area)
            colors = "{" + ", ".join(map(str, cell.colors)) + "}"
            assert trace["name"] == f"cell {cell.id} {colors}  {100 * area_of(trace) / 20:.1f} %"
        assert sum(map(area_of, found.values())) == pytest.approx(20.0)

    def test_triangles_face_outward(self, tmp_path: Path) -> None:
        sphere = finer(*finer(*octahedron()))
        colors = [[int(z > 0.1)] for _, _, z in sphere[0].tolist()]
        surface = labelled(*sphere, colors)
        show(saved(surface, tmp_path), "-o", tmp_path / "x.html")
        for trace in meshes(tmp_path / "x.html").values():
            corners = points(trace)[np.stack([trace[corner] for corner in "ijk"], axis=1)]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0).all()

    def test_borders_and_cracks(self, tmp_path: Path) -> None:
        """Each mesh edge that is crossed has half of a piece of line in each of its triangles."""
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        lines = {t["name"]: t for t in traces(tmp_path / "x.html") if t.get("mode") == "lines"}
        instance = decompose(DRAWN, "x")
        assert instance.surface is not None
        cell = instance.surface.vertex_cell
        cracked = {(crack.i, crack.j) for crack in DRAWN.cracks}
        crossed = [(a, b) for a, b in DRAWN.left_of if cell[a] != cell[b]]
        sides = [(a, b) for a, b in DRAWN.left_of if (min(a, b), max(a, b)) in cracked]
        border = [side for side in crossed if side not in sides]
        # Every piece is two points and a gap.
        assert len(lines["crack"]["x"]) == 3 * len(sides)
        assert len(lines["border"]["x"]) == 3 * len(border)

    def test_numbers_stand_on_their_cells(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        (texts,) = [t for t in traces(tmp_path / "x.html") if t.get("mode") == "text"]
        # Numbers hover over their vertex; this surface is flat.
        offsets = points(texts)[:, None, :2] - DRAWN.vertices[None, :, :2]
        distances = np.linalg.norm(offsets, axis=2)
        assert distances.min(axis=1).max() < 1e-9
        nearest = distances.argmin(axis=1).tolist()
        numbered = {f"cell {text}": v for text, v in zip(texts["text"], nearest, strict=True)}
        cells = holding(decompose(DRAWN, "x"))
        assert numbered.keys() == cells.keys() - {"unreachable"}
        assert all(vertex in cells[name] for name, vertex in numbered.items())

    def test_an_instance_finds_its_surface(self, tmp_path: Path) -> None:
        folder = tmp_path / "sub"
        folder.mkdir()
        path = saved(DRAWN, tmp_path)
        instance = decompose(DRAWN, "../drawn.surface.json")
        (folder / "i.json").write_text(instance.to_json(), encoding="utf-8")
        show(folder / "i.json", "-o", tmp_path / "i.svg")
        show(path, "-o", tmp_path / "s.svg")
        assert (tmp_path / "i.svg").read_bytes() == (tmp_path / "s.svg").read_bytes()


def test_colors_of_neighbors_differ() -> None:
    few = {0: {1, 2}, 1: {0}, 2: {0}}
    assert len(set(assign(few))) == 3
    ring = {k: {(k - 1) % 30, (k + 1) % 30} for k in range(30)}
    colors = assign(ring)
    assert all(colors[a] != colors[b] for a, near in ring.items() for b in near)
    assert set(colors) == set(AREAS)


@pytest.mark.parametrize("name", ["blue", "1"])
def test_domain_of_a_color(name: str, tmp_path: Path) -> None:
    show(saved(DRAWN, tmp_path), "--color", name, "-o", tmp_path / "x.html")
    found = meshes(tmp_path / "x.html")
    own = {v for v, colors in enumerate(DRAWN.vertex_colors) if 1 in colors}
    none = {v for v, colors in enumerate(DRAWN.vertex_colors) if not colors}
    assert vertices_in(found["blue"], DRAWN) == own
    assert vertices_in(found["unreachable"], DRAWN) == none
    assert vertices_in(found["other colors only"], DRAWN) == set(range(30)) - own - none
    lines = {t["name"]: t for t in traces(tmp_path / "x.html") if t.get("mode") == "lines"}
    # Only 4-5 is a crack of blue; it is on the mesh's border and has one triangle.
    assert len(lines["crack"]["x"]) == 3
