"""Surfaces by the segments of a solution, read back and held against it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from library import PAPER
from pages import (
    meshes,
    show,
    vertices_in,
)

from cellcolor.cli import main
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose

pytest.importorskip("matplotlib")
pytest.importorskip("plotly")


class TestSolution:
    def solved(self, surface: Path, folder: Path, *options: str) -> tuple[Path, Solution]:
        path = folder / "solution.json"
        assert main(["solve", str(surface), "-o", str(path), *options]) == 0
        return path, Solution.read(path)

    def segments(self, page: Path, surface: LabelledSurface) -> dict[int, int]:
        """The segment of each vertex that is painted."""
        return {
            vertex: int(name.removeprefix("segment "))
            for name, trace in meshes(page).items()
            if name.startswith("segment ")
            for vertex in vertices_in(trace, surface)
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

    @pytest.mark.parametrize("name", ["split-cell", "figsimpleexample"])
    def test_segments_with_a_part_of_a_divided_cell_are_whole(
        self, name: str, tmp_path: Path
    ) -> None:
        """No segment is torn: flooded over mesh edges from one of its vertices."""
        path = PAPER / f"{name}.surface.json"
        surface = LabelledSurface.read(path)
        file, solution = self.solved(path, tmp_path)
        show(path, file, "-o", tmp_path / "x.html")
        painted = self.segments(tmp_path / "x.html", surface)
        for segment in range(solution.segments or 0):
            own = {vertex for vertex, number in painted.items() if number == segment}
            reached = {min(own)}
            pairs = {(a, b) for a, b in surface.left_of if {a, b} <= own}
            pairs |= {(b, a) for a, b in pairs}
            while more := {b for a, b in pairs if a in reached} - reached:
                reached |= more
            assert reached == own
        assert "One possible cut is drawn" in (tmp_path / "x.html").read_text()

    def test_strands_share_their_edge(self, tmp_path: Path) -> None:
        """Two corridors side by side cross the border between the two large cells."""
        path = PAPER / "parallel-corridors.surface.json"
        surface = LabelledSurface.read(path)
        file, solution = self.solved(path, tmp_path, "--search-space", "surface")
        show(path, file, "-o", tmp_path / "x.html")
        painted = self.segments(tmp_path / "x.html", surface)
        assert solution.cells is not None
        assert solution.segments == 2
        reference = decompose(surface, path.name).surface
        assert reference is not None
        cells = reference.vertex_cell
        first, second = (cell.id for cell in solution.cells if len(cell.subcells) == 2)
        crossing = [(a, b) for a, b in surface.left_of if (cells[a], cells[b]) == (first, second)]
        assert {painted[a] for a, _ in crossing} == {0, 1} == {painted[b] for _, b in crossing}
        # Where one corridor ends and the other begins a vertex may have a neighbor in each.
        assert sum(painted[a] != painted[b] for a, b in crossing) <= 2

    def test_a_graph_made_elsewhere_leaves_divided_cells_unpainted(self, tmp_path: Path) -> None:
        """Where its edges lie on the mesh is not known."""
        text = (PAPER / "split-cell.surface.json").read_text()
        (tmp_path / "s.json").write_text(text)
        surface = LabelledSurface.read(tmp_path / "s.json")
        made = decompose(surface, "s.json")
        shifted = replace(
            made,
            edges=tuple(replace(edge, id=edge.id + 100) for edge in made.edges),
            cells=tuple(
                replace(
                    cell,
                    loops=tuple(
                        tuple(dart + (100 if dart > 0 else -100) for dart in loop)
                        for loop in cell.loops
                    ),
                )
                for cell in made.cells
            ),
        )
        (tmp_path / "i.json").write_text(shifted.to_json())
        file, _ = self.solved(tmp_path / "i.json", tmp_path)
        show(tmp_path / "i.json", file, "-o", tmp_path / "x.html")
        cut = vertices_in(meshes(tmp_path / "x.html")["cut between segments"], surface)
        assert cut == {v for v, colors in enumerate(surface.vertex_colors) if len(colors) == 2}
