"""Pictures, read back from what was written and held against the inputs."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from library import INSTANCES, PAPER
from meshes import finer, octahedron
from meshes import surface as labelled
from numpy.typing import NDArray
from pages import (
    DRAWN,
    area_of,
    meshes,
    needs_frontend,
    points,
    saved,
    show,
    side_file,
    small_wok,
    traces,
    vertices_in,
)

from cellcolor.cli import main
from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
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


def is_text(element: ET.Element) -> bool:
    return element.tag.endswith("}text")


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

    def test_divided_cell_by_its_nearest_joined_border(self, tmp_path: Path) -> None:
        """Cell 2 lies between two red cells above it and two blue ones below."""
        path = PAPER / "split-cell.surface.json"
        surface = LabelledSurface.read(path)
        file, _ = self.solved(path, tmp_path)
        show(path, file, "-o", tmp_path / "x.html")
        painted = self.segments(tmp_path / "x.html", surface)
        whole = {
            v: painted[v] for v, colors in enumerate(surface.vertex_colors) if len(colors) == 1
        }
        divided = painted.keys() - whole.keys()
        touching = [(a, b) for a, b in surface.left_of if a in whole and b in divided]
        assert len({whole[a] for a, _ in touching}) == 2
        assert all(painted[b] == whole[a] for a, b in touching)
        assert "Divided: cell 2. Each vertex there" in (tmp_path / "x.html").read_text()

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


class TestGraph:
    @pytest.mark.parametrize(
        "name", ["ring", "three-loops", "crossing-zeros", "crack-partial", "annulus"]
    )
    def test_darts_stand_around_their_cell_in_cyclic_order(self, name: str, tmp_path: Path) -> None:
        path = PAPER / f"{name}.json"
        show(path, "--graph", "-o", tmp_path / "x.html")
        places: dict[str, NDArray[np.float64]] = {}
        for trace in traces(tmp_path / "x.html"):
            if trace.get("mode") == "text":
                at = np.stack([np.asarray(trace["x"]), np.asarray(trace["y"])], axis=1)
                places |= dict(zip(trace["text"], at, strict=True))
        instance = Instance.read(path)
        darts = [f"{dart:+d}" for cell in instance.cells for loop in cell.loops for dart in loop]
        assert places.keys() == {str(cell.id) for cell in instance.cells} | set(darts)
        for cell in instance.cells:
            around = {}
            for dart in (dart for loop in cell.loops for dart in loop):
                x, y = places[f"{dart:+d}"] - places[str(cell.id)]
                around[dart] = np.arctan2(y, x)
            order = sorted(around, key=lambda dart: float(around[dart]))
            for loop in cell.loops:
                own = [dart for dart in order if dart in loop]
                start = own.index(loop[0])
                assert tuple(own[start:] + own[:start]) == loop

    def test_one_line_for_each_joinable_color(self, tmp_path: Path) -> None:
        path = PAPER / "crack-partial.json"
        show(path, "--graph", "-o", tmp_path / "x.html")
        instance = Instance.read(path)
        lines = [
            (trace["name"], trace["line"].get("dash"))
            for trace in traces(tmp_path / "x.html")
            if trace.get("mode") == "lines" and trace["name"]
        ]
        wanted = []
        for edge in instance.edges:
            colors = instance.joinable(edge.id)
            wanted += [(f"{c}: {instance.colors[c]}", None) for c in colors]
            wanted += [] if colors else [("dead edge", "4px")]
        assert sorted(lines, key=str) == sorted(wanted, key=str)
        assert {dash for _, dash in lines} == {None, "4px"}
        assert list(dict.fromkeys(lines)) == sorted(set(lines), key=str)  # the legend's order

    def test_a_surface_and_a_graph_without_cells(self, tmp_path: Path) -> None:
        show(saved(DRAWN, tmp_path), "--graph", "-o", tmp_path / "x.svg")
        assert "drawn: 4 cells" in (tmp_path / "x.svg").read_text()
        empty = tmp_path / "empty.json"
        empty.write_text(Instance("empty", (), (), ()).to_json())
        show(empty, "--graph", "-o", tmp_path / "empty.png")
        assert (tmp_path / "empty.png").stat().st_size > 0


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


class TestReasons:
    def test_of_a_side_file(self, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        valid = {v for v, row in enumerate(arrays["node_color"]) if (row >= 0).any()}
        assert found == {
            "reachable": valid,
            "ground": set(range(30)) - valid - {29},
            "given up by the sliver policy": {29},
        }

    @pytest.mark.parametrize("branch", ["right arm", "1"])
    def test_of_one_branch(self, branch: str, tmp_path: Path) -> None:
        path, arrays = side_file(tmp_path)
        show(path, "--reason", "--branch", branch, "-o", tmp_path / "x.html")
        found = {n: vertices_in(t, DRAWN) for n, t in meshes(tmp_path / "x.html").items()}
        codes = arrays["reasons"][:, 1]
        names = {"valid": 0, "torque": 2, "ground": 3}
        assert found == {n: set(np.flatnonzero(codes == c).tolist()) for n, c in names.items()}


@needs_frontend
class TestScene:
    def test_reasons(self, tmp_path: Path) -> None:
        from cellcolor.frontend import Reason, build_surface

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

    def test_collision_object(self, tmp_path: Path) -> None:
        """A smaller cap in the same frame is what must not be hit."""
        cap = {"kind": '"spherical-cap"', "radius_m": 0.15, "half_angle_rad": 1.0}
        keys = [f"{key} = {value}" for key, value in (cap | {"target_vertices": 61}).items()]
        scene = small_wok(tmp_path, "\n".join(["[collision_object]", *keys]))
        show(
            scene,
            "--vertex",
            0,
            "--branch",
            self.valid_at_the_top(scene),
            "-o",
            tmp_path / "x.html",
        )
        found = {t["name"]: points(t) for t in traces(tmp_path / "x.html") if t["type"] == "mesh3d"}
        center = np.array([0.465, -0.15, -0.04])
        distances = np.linalg.norm(found["collision object"] - center, axis=1)
        np.testing.assert_allclose(distances, 0.15, atol=1e-9)
        assert len(found["collision object"]) == 61

    def valid_at_the_top(self, scene: Path) -> str:
        from cellcolor.frontend import build_surface

        result = build_surface(scene)
        return result.branches[int(np.flatnonzero(result.reasons[0] == 0)[0])]

    def test_arm(self, tmp_path: Path) -> None:
        """Every link where Pinocchio has it, on the surface of its shapes."""
        import pinocchio as pin

        from cellcolor.frontend import build_surface
        from cellcolor.frontend.arm.robot import load_robot

        scene = small_wok(tmp_path)
        result = build_surface(scene)
        vertex, branch = (int(k) for k in np.argwhere(result.node_color >= 0)[40])
        name = result.branches[branch]
        show(scene, "--vertex", vertex, "--branch", name, "-o", tmp_path / "x.html")
        found = {t["name"]: points(t) for t in traces(tmp_path / "x.html") if t["type"] == "mesh3d"}

        robots = INSTANCES.parent / "models" / "robots"
        robot = load_robot(
            robots / "ur5.urdf", "wrist_3_link", robots / "polishing_tool.urdf", "tool_tip"
        )
        data, shapes = robot.model.createData(), robot.geometry.createData()
        q = result.configurations[vertex, branch]
        pin.updateGeometryPlacements(robot.model, data, robot.geometry, shapes, q)
        depth: dict[str, list[NDArray[np.float64]]] = {}
        for number, shape in enumerate(robot.geometry.geometryObjects):
            link = robot.model.frames[shape.parentFrame].name
            pose = shapes.oMg[number]
            local = (found[link] - pose.translation) @ pose.rotation
            if hasattr(shape.geometry, "halfLength"):
                half, radius = shape.geometry.halfLength, shape.geometry.radius
                side = np.hypot(local[:, 0], local[:, 1]) - radius
                depth.setdefault(link, []).append(np.maximum(side, np.abs(local[:, 2]) - half))
            else:
                off = np.linalg.norm(local, axis=1) - shape.geometry.radius
                depth.setdefault(link, []).append(off)
        for link, distances in depth.items():
            # On the surface of at least one shape, or inside another of the same link.
            assert np.max(np.min(distances, axis=0)) < 1e-9, link
            assert np.min(np.abs(distances)) < 1e-9, link
            assert np.percentile(np.min(np.abs(distances), axis=0), 95) < 1e-9, link
        for trace in traces(tmp_path / "x.html"):
            if trace["name"] in depth:  # wound outward, or light would fall on the inside
                a, b, c = (points(trace)[trace[corner]] for corner in "ijk")
                assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
        assert set(found) == {*depth, "object", "obstacles", f"vertex {vertex}"}
        np.testing.assert_allclose(
            (found[f"vertex {vertex}"].min(axis=0) + found[f"vertex {vertex}"].max(axis=0)) / 2,
            result.surface.vertices[vertex],
            atol=1e-3,
        )
        box, corner = found["obstacles"][:8], found["obstacles"][8:]
        np.testing.assert_allclose(np.ptp(box, axis=0), [0.1, 0.2, 0.3])
        np.testing.assert_allclose(box.mean(axis=0), [-0.5, 0.0, 0.2], atol=1e-12)
        expected = np.array([-0.6, 0.5, 0.1]) + np.vstack([np.zeros(3), 0.1 * np.eye(3)])
        assert sorted(corner.round(9).tolist()) == sorted(expected.round(9).tolist())
        assert found["object"].shape == result.surface.vertices.shape
