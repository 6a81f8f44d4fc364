"""Surfaces by cell, color, segment and reason, read back and held against the inputs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from library import PAPER
from meshes import drawn
from pages import DRAWN, areas, page_data, saved, show, side_file, unpacked

import cellcolor
from cellcolor.cli import main
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose, decomposition_of
from cellcolor.errors import InputError
from cellcolor.pictures.picture import Line, paints_of
from cellcolor.pictures.surface_pictures import draw_cells, draw_color, draw_plan, draw_segments
from cellcolor.pictures.topological_graph import draw_graph


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
        assert areas(tmp_path / "x.html") == holding(decompose(DRAWN, "drawn.surface.json"))

    def test_borders_and_cracks(self, tmp_path: Path) -> None:
        """Each mesh edge that is crossed is marked on each of its triangles."""
        show(saved(DRAWN, tmp_path), "-o", tmp_path / "x.html")
        (mode,) = page_data((tmp_path / "x.html").read_text())["modes"]
        lines = unpacked(mode["sides"]).reshape(-1, 3)
        cell = decomposition_of(DRAWN).vertex_cell
        cracked = {(crack.i, crack.j) for crack in DRAWN.cracks}
        for face, own in zip(DRAWN.faces.tolist(), lines.tolist(), strict=True):
            for a, b, line in zip(face, [*face[1:], face[0]], own, strict=True):
                crossed = Line.BORDER if cell[a] != cell[b] else Line.NONE
                assert line == (Line.CRACK if (min(a, b), max(a, b)) in cracked else crossed)

    def test_an_instance_finds_its_surface(self, tmp_path: Path) -> None:
        folder = tmp_path / "sub"
        folder.mkdir()
        path = saved(DRAWN, tmp_path)
        instance = decompose(DRAWN, "../drawn.surface.json")
        (folder / "i.json").write_text(instance.to_json(), encoding="utf-8")
        show(folder / "i.json", "-o", tmp_path / "i.svg")
        show(path, "-o", tmp_path / "s.svg")
        assert (tmp_path / "i.svg").read_bytes() == (tmp_path / "s.svg").read_bytes()


def test_a_color_has_one_paint_in_every_picture() -> None:
    """Cells of one color, its domain, its segments in a division and in a plan, and the graph."""
    surface = drawn("AABB AABB", {"A": [2], "B": [1]})
    paints = paints_of(surface.colors)
    graph = decomposition_of(surface)
    solution = cellcolor.solve(surface).solution
    plan = cellcolor.Plan(tuple(own[0] for own in surface.vertex_colors))
    seen = {
        (view.classes[number].rgb, color)
        for view, colors in (
            (draw_cells(surface, graph).mesh, [2, 1]),
            (draw_color(surface, 1).mesh, [1]),
            (draw_segments(surface, graph, solution).mesh, [2, 1]),
            (draw_plan(surface, plan).mesh, [2, 1]),
        )
        for number, color in enumerate(colors)
    }
    names = surface.colors
    assert seen == {(paints[names[1]], 1), (paints[names[2]], 2)}
    rims = {outline.rgb for outline in draw_graph(graph.instance).outlines}
    assert {paints[names[1]], paints[names[2]]} < rims
    assert len(set(paints_of(list(map(str, range(16)))).values())) == 16


def test_marked_segments_of_a_plan() -> None:
    """Their borders are drawn, and nobody else's; the vertices have a text each."""
    surface = drawn("AABBCC AABBCC", {"A": [0], "B": [1], "C": [2]})
    plan = cellcolor.Plan(tuple(own[0] for own in surface.vertex_colors))
    picture = draw_plan(surface, plan, marked=(0,))
    assert picture.mesh is not None
    first, second = np.sort(picture.mesh.labels[surface.faces], axis=1).T[[0, -1]]
    assert set(zip(first.tolist(), second.tolist(), strict=True)) > {(0, 1), (1, 2)}
    for face, lines in zip(surface.faces.tolist(), picture.mesh.lines.tolist(), strict=True):
        for a, b, line in zip(face, [*face[1:], face[0]], lines, strict=True):
            ends = {int(picture.mesh.labels[a]), int(picture.mesh.labels[b])}
            wanted = Line.MARKED if 0 in ends else Line.BORDER
            assert line == (wanted if len(ends) == 2 else Line.NONE)
    assert [text.text for text in picture.texts if text.label is None] == ["vertex 0"]
    with pytest.raises(InputError, match="marked: 12 is not among 0 to 11"):
        cellcolor.show(surface, plan=plan, marked=(12,))
    with pytest.raises(InputError, match="marked: the picture cells does not take it"):
        cellcolor.show(surface, marked=(0,))


@pytest.mark.parametrize("name", ["blue", "1"])
def test_domain_of_a_color(name: str, tmp_path: Path) -> None:
    show(saved(DRAWN, tmp_path), "--color", name, "-o", tmp_path / "x.html")
    found = areas(tmp_path / "x.html")
    own = {v for v, colors in enumerate(DRAWN.vertex_colors) if 1 in colors}
    none = {v for v, colors in enumerate(DRAWN.vertex_colors) if not colors}
    rest = set(range(30)) - own - none
    assert found == {"blue": own, "unreachable": none, "other colors only": rest}
    (mode,) = page_data((tmp_path / "x.html").read_text())["modes"]
    # Only 4-5 is a crack of blue; it is on the mesh's border and has one triangle.
    assert (unpacked(mode["sides"]) == Line.CRACK).sum() == 1


class TestSolution:
    def solved(self, surface: Path, folder: Path, *options: str) -> tuple[Path, Solution]:
        path = folder / "solution.json"
        assert main(["solve", str(surface), "-o", str(path), *options]) == 0
        return path, Solution.read(path)

    def segments(self, page: Path, surface: LabelledSurface) -> dict[int, int]:
        """The segment of each vertex that is painted."""
        return {
            vertex: int(name.removeprefix("segment "))
            for name, own in areas(page).items()
            if name.startswith("segment ")
            for vertex in own
            if vertex < len(surface.vertices)  # the first ones where the mesh is refined
        }

    @pytest.mark.parametrize(
        ("name", "options"),
        [
            ("split-cell", []),
            ("annulus", []),
            ("figsimpleexample", []),
            ("parallel-corridors", ["--search-space", "surface"]),
        ],
    )
    def test_vertices_have_colors_that_they_can_have(
        self, name: str, options: list[str], tmp_path: Path
    ) -> None:
        path = PAPER / f"{name}.surface.json"
        surface = LabelledSurface.read(path)
        file, solution = self.solved(path, tmp_path, *options)
        show(path, file, "-o", tmp_path / "x.html")
        painted = self.segments(tmp_path / "x.html", surface)
        assert solution.cells is not None
        color = {sub.segment: sub.color for cell in solution.cells for sub in cell.subcells}
        assert set(painted) == {v for v, colors in enumerate(surface.vertex_colors) if colors}
        assert set(painted.values()) == set(range(solution.segments or 0))
        assert all(color[s] in surface.vertex_colors[v] for v, s in painted.items())
        instance = decompose(surface, path.name)
        assert instance.surface is not None
        cells = instance.surface.vertex_cell
        for vertex, segment in painted.items():
            subs = solution.cells[cells[vertex]].subcells
            assert segment in {sub.segment for sub in subs}


class TestReasons:
    def test_of_a_side_file(self, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--view", "reasons", "-o", tmp_path / "x.html")
        found = areas(tmp_path / "x.html")
        valid = {v for v, row in enumerate(arrays["node_color"]) if (row >= 0).any()}
        assert found == {
            "reachable": valid,
            "ground": set(range(30)) - valid - {29},
            "given up": {29},
        }

    @pytest.mark.parametrize("branch", ["right arm", "1"])
    def test_of_one_branch(self, branch: str, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--view", "reasons", "--branch", branch, "-o", tmp_path / "x.html")
        found = areas(tmp_path / "x.html")
        codes = arrays["reasons"][:, 1]
        names = {"valid": 0, "torque": 2, "ground": 3}
        assert found == {n: set(np.flatnonzero(codes == c).tolist()) for n, c in names.items()}
