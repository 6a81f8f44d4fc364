"""Surfaces by cell, color, segment and reason, read back and held against the inputs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from library import PAPER
from meshes import finer, octahedron
from meshes import surface as labelled
from pages import (
    DRAWN,
    area_of,
    meshes,
    points,
    saved,
    show,
    side_file,
    small_wok,
    traces,
    vertices_in,
)

from cellcolor.cli import main
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.pictures.palette import AREAS, assign


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


class TestReasons:
    def test_of_a_side_file(self, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        valid = {v for v, row in enumerate(arrays["node_color"]) if (row >= 0).any()}
        assert found == {
            "reachable": valid,
            "ground": set(range(30)) - valid - {29},
            "given up": {29},
        }

    @pytest.mark.parametrize("branch", ["right arm", "1"])
    def test_of_one_branch(self, branch: str, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "--branch", branch, "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        codes = arrays["reasons"][:, 1]
        names = {"valid": 0, "torque": 2, "ground": 3}
        assert found == {n: set(np.flatnonzero(codes == c).tolist()) for n, c in names.items()}

    def test_of_a_scene(self, tmp_path: Path) -> None:
        from reasons import Reason

        from cellcolor.frontend import build_surface

        scene = small_wok(tmp_path)
        show(scene, "--reason", "--branch", "0", "-o", tmp_path / "x.html")
        result = build_surface(scene)
        found = meshes(tmp_path / "x.html")
        taken = result.node_color[:, 0] < 0
        for reason in Reason:
            if reason != Reason.VALID:
                own = set(np.flatnonzero(result.reasons[:, 0] == reason).tolist())
                trace = found.get(reason.text)
                assert own == (vertices_in(trace, result.surface) if trace else set())
        valid = np.flatnonzero((result.reasons[:, 0] == Reason.VALID) & ~taken)
        assert vertices_in(found["valid"], result.surface) == set(valid.tolist())
