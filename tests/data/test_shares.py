"""Every share is one of the whole surface, and says the same wherever it stands."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import json_lines, run
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from meshes import drawn, surfaces
from pages import DRAWN, page_data, show, unpacked

from cellcolor.data.instance import Instance
from cellcolor.data.shares import percent, shares_of
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

Capture = pytest.CaptureFixture[str]

SPLIT = LabelledSurface.read(PAPER / "split-cell.surface.json")
BARE = [v for v, colors in enumerate(SPLIT.vertex_colors) if not colors]
SURFACES = {
    "nothing divided": DRAWN,
    "some given up": replace(DRAWN, given_up=(21, 22, 29)),
    "a divided cell": replace(SPLIT, given_up=tuple(BARE[::3])),
}
UNCOVERED = {"unreachable": "unreachable", "given up": "given_up"}


def dual_area(surface: LabelledSurface, vertices: set[int]) -> float:
    """A third of each triangle for each of its corners that is among the vertices."""
    total = 0.0
    for face in surface.faces.tolist():
        a, b, c = surface.vertices[face]
        own = len(vertices.intersection(face))
        total += own * float(np.linalg.norm(np.cross(b - a, c - a))) / 6
    return total


@given(surfaces(), st.randoms(use_true_random=False))
@examples(25)
def test_cells_and_what_is_uncovered_are_the_whole(mesh: LabelledSurface, random: Any) -> None:
    bare = [v for v, colors in enumerate(mesh.vertex_colors) if not colors]
    given_up = set(bare[:: random.randint(1, 3)]) if bare else set()
    mesh = replace(mesh, given_up=tuple(given_up))
    whole = dual_area(mesh, set(range(len(mesh.vertices))))
    instance = decompose(mesh)
    coverage = instance.coverage
    assert coverage is not None
    assert coverage.area_m2 == pytest.approx(whole)
    assert coverage.given_up == pytest.approx(dual_area(mesh, given_up) / whole)
    assert coverage.unreachable == pytest.approx(dual_area(mesh, set(bare) - given_up) / whole)
    cells = sum(cell.area or 0.0 for cell in instance.cells) / whole
    assert cells + coverage.unreachable + coverage.given_up == pytest.approx(1)
    if instance.cells:
        solution = solve(instance, Options(), "dfs")
        shares = shares_of(instance, solution)
        assert shares.of == "surface"
        uncovered = shares.unreachable + shares.given_up
        divided = sum(
            (instance.cells[cell.id].area or 0.0) / whole
            for cell in solution.cells or ()
            if len({sub.segment for sub in cell.subcells}) > 1
        )
        assert sum(least for least, _ in shares.segments) + divided + uncovered == pytest.approx(1)
        assert shares.certain == (divided == 0)


@pytest.mark.parametrize("name", SURFACES)
def test_table_json_and_picture_agree(name: str, tmp_path: Path, capsys: Capture) -> None:
    surface = SURFACES[name]
    path, solved, page = (tmp_path / file for file in ("s.surface.json", "x.json", "x.html"))
    path.write_text(surface.to_json(), encoding="utf-8")
    assert run("solve", path, "-o", solved) == 0
    table = capsys.readouterr().out
    rows = dict(re.findall(r"^ +(\d+) .*? ([\d.–]+) %\s*$", table, re.MULTILINE))
    uncovered = dict(re.findall(r"^ +(unreach\w+|given up) +([\d.]+) %", table, re.M))
    show(path, solved, "-o", page)
    data = page_data(page.read_text(encoding="utf-8"))
    corners = unpacked(data["mesh"]["points"]).reshape(-1, 3)[unpacked(data["mesh"]["triangles"])]
    a, b, c = corners.reshape(-1, 3, 3).transpose(1, 0, 2)
    sizes = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    labels = unpacked(data["modes"][0]["labels"])[unpacked(data["mesh"]["triangles"])]
    seen = {}
    for number, own in enumerate(data["modes"][0]["classes"]):
        # A third of each triangle for each of its corners.
        area = (sizes * (labels.reshape(-1, 3) == number).mean(axis=1)).sum()
        if not area:
            continue
        words, _, share = own["name"].rpartition(", ")
        seen[words.partition(":")[0].removeprefix("segment ")] = share.removesuffix(" %")
        low, *high = map(float, share.removesuffix(" %").split("–"))
        painted = 100 * area / sizes.sum()
        assert low - 0.051 <= painted <= (high[0] if high else low) + 0.051
    assert seen == rows | uncovered
    assert list(uncovered) == list(UNCOVERED)[: 2 if surface.given_up else 1]
    ranges = [[float(part) for part in row.split("–")] for row in rows.values()]
    nobody = sum(map(float, uncovered.values()))
    rounding = 0.05 * (len(rows) + len(uncovered)) + 1e-9
    assert sum(low for low, *_ in ranges) + nobody <= 100 + rounding
    assert sum(high for *_, high in ranges) + nobody >= 100 - rounding
    assert ("ranges: " in table) == ("–" in table) == (name == "a divided cell")
    run("solve", path, "--json")
    (line,) = json_lines(capsys.readouterr().out.splitlines()[-1])
    for words, member in UNCOVERED.items():
        share = line["coverage"][member]
        assert percent(share, share) == f"{uncovered.get(words, '0.0')} %"


def test_an_instance_that_knows_no_surface(capsys: Capture, tmp_path: Path) -> None:
    """Without coverage nothing can be said about the surface, and nothing is."""
    instance = replace(decompose(SPLIT), coverage=None)
    path = tmp_path / "i.json"
    path.write_text(instance.to_json(), encoding="utf-8")
    assert run("solve", path) == 0
    out = capsys.readouterr().out
    assert "share of area" in out and "unreachable" not in out
    least = [low for low, _ in shares_of(instance, solve(instance, Options())).segments]
    middle = instance.cells[2].area
    assert middle is not None
    assert sum(least) == pytest.approx(1 - middle / sum(cell.area or 0 for cell in instance.cells))


class TestNothingToCover:
    @pytest.fixture
    def surface(self, tmp_path: Path) -> Path:
        path = tmp_path / "far.surface.json"
        mesh = replace(drawn("... ... ...", {".": []}), given_up=(4,))
        path.write_text(mesh.to_json(), encoding="utf-8")
        return path

    LOUD = "NOTHING CAN BE COVERED: 75.0 % of the surface unreachable, 25.0 % given up"

    def test_build(self, surface: Path, tmp_path: Path, capsys: Capture) -> None:
        assert run("build", surface, "-o", tmp_path / "far.json") == 3
        assert self.LOUD in capsys.readouterr().err
        assert Instance.read(tmp_path / "far.json").nothing_to_cover

    @pytest.mark.parametrize("options", [[], ["--solver", "dfs"], ["--all"]])
    @pytest.mark.parametrize("built", [False, True])
    def test_solve(
        self, built: bool, options: list[str], surface: Path, tmp_path: Path, capsys: Capture
    ) -> None:
        """Of a surface, and of the instance that was made of one."""
        path, out = surface, tmp_path / "out.json"
        if built:
            path = tmp_path / "far.json"
            run("build", surface, "-o", path)
        capsys.readouterr()
        assert run("solve", path, "--json", "-o", out, *options) == 3
        printed, loud = capsys.readouterr()
        assert f"{path}: {self.LOUD}" in loud
        (line,) = json_lines(printed)
        assert (line["status"], line["segments"], line["lift_offs"]) == ("unknown", None, None)
        assert line["coverage"]["unreachable"] == pytest.approx(0.75)
        assert Solution.read(out).to_document() == {k: line[k] for k in line if k != "file"}
        assert run("solve", path) == 3
        assert "optimal" not in capsys.readouterr().out
