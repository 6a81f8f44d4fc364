"""What is left out on purpose: ``cover`` and ``left_alone`` of solve and check."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import json_lines, run
from exhaustive_minima import front_by_subsets
from hypothesis import assume, given
from hypothesis import strategies as st
from meshes import drawn

import cellcolor
from cellcolor.lab.families import blobs, planar_graph
from examples import examples

STRIP = drawn("AAAABBBBBBCC AAAABBBBBBCC", {"A": [0], "B": [1], "C": [2]})
"""Three colors side by side, of 8, 12 and 4 vertices."""
C_ONLY = cellcolor.WorldBox((9.5, -9.0, -9.0), (99.0, 99.0, 9.0))


@examples(15)
@given(
    seed=st.integers(0, 10**6),
    cells=st.integers(1, 6),
    more=st.integers(0, 4),
    share=st.floats(0, 1),
)
def test_so_few_segments_cover_the_share_and_no_fewer(
    seed: int, cells: int, more: int, share: float
) -> None:
    instance = planar_graph(seed, cells, cells + more, 3)
    areas = [cell.area or 0.0 for cell in instance.cells]
    weights = areas if all(areas) else [1.0] * len(areas)
    exhaustive = front_by_subsets(instance, weights)
    result = cellcolor.solve(instance, cover=share)
    enough = [k for k, w in exhaustive.items() if w >= (share - 1e-6) * sum(weights)]
    assert result.segments == min(enough)
    assert result.covered_share >= share - 1e-6
    assert cellcolor.check(result.instance, result).valid


@examples(10)
@given(seed=st.integers(0, 10**6), left=st.integers(0, 10**6))
def test_what_is_left_alone_has_no_colors(seed: int, left: int) -> None:
    """The minimum is that of a surface that never had the colors, loops and all."""
    surface = blobs(seed, size=5, colors=3, coverage=(0.6, 1.0))
    mask = np.random.default_rng(left).random(len(surface.vertices)) < 0.2
    assume(any(c and not out for c, out in zip(surface.vertex_colors, mask, strict=True)))
    bare = replace(
        surface,
        vertex_colors=tuple(
            () if out else own for own, out in zip(surface.vertex_colors, mask, strict=True)
        ),
        cracks=tuple(c for c in surface.cracks if not (mask[c.i] or mask[c.j])),
    )
    assert cellcolor.solve(surface, left_alone=mask).segments == cellcolor.solve(bare).segments


def test_the_share_is_of_what_is_not_left_alone() -> None:
    areas = STRIP.vertex_areas
    color = np.array([own[0] for own in STRIP.vertex_colors])
    of = {number: areas[color == number].sum() for number in range(3)}
    half = cellcolor.solve(STRIP, cover=0.5)
    assert (half.lift_offs, half.covered_share) == (0, pytest.approx(of[1] / sum(of.values())))
    assert "50.0 % of what can be covered is asked for" in half.solution.notes[0]
    rest = cellcolor.solve(STRIP, left_alone=C_ONLY)
    assert (rest.lift_offs, rest.covered_share) == (1, 1.0)
    assert f"{of[2] / sum(areas):.1%} of the surface can be covered and is left" in str(
        rest.solution.notes
    )
    both = cellcolor.solve(STRIP, cover=0.5, left_alone=C_ONLY)
    assert both.covered_share == pytest.approx(of[1] / (of[0] + of[1]))


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"cover": 1.5}, "cover"),
        ({"cover": float("nan")}, "cover"),
        ({"left_alone": [True]}, "left_alone"),
        ({"left_alone": replace(STRIP, vertices=STRIP.vertices + 1.0)}, "left_alone"),
    ],
)
def test_what_cannot_be_asked_is_refused(given: dict[str, object], field: str) -> None:
    with pytest.raises(cellcolor.InputError) as found:
        cellcolor.solve(STRIP, **given)
    assert found.value.field == field


def test_the_files_of_a_share_are_checked_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, sol = tmp_path / "strip.surface.json", tmp_path / "sol.json"
    file.write_text(STRIP.to_json())
    assert run("solve", file, "--cover", "0.5", "--json", "-o", sol) == 0
    row = json_lines(capsys.readouterr().out)[0]
    expected = cellcolor.solve(STRIP, cover=0.5)
    assert (row["lift_offs"], row["covered_share"]) == (0, expected.covered_share)
    assert row["proved_for_surface"] is True
    covered = tmp_path / "sol.covered.json"
    assert run("check", covered, sol) == 0
    assert run("check", file, sol) == 1  # half of it is not divided
    assert run("check", file, sol, "--left-alone", covered) == 0
    assert cellcolor.check(file, sol, left_alone=cellcolor.LabelledSurface.read(covered)).valid
    capsys.readouterr()
    for wrong, said in (
        (("--cover", "2"), "not in the range"),
        (("--left-alone", "0,0,0"), "No such file"),
        (("--left-alone", sol), "mask: must be a list of true or false"),
    ):
        assert run("solve", file, *wrong) == 2
        assert said in capsys.readouterr().err


def test_a_graph_without_a_surface_leaves_cells_out(tmp_path: Path) -> None:
    file, sol = tmp_path / "row.json", tmp_path / "sol.json"
    file.write_text(replace(cellcolor.decompose("half_pipe"), surface=None).to_json())
    assert run("solve", file, "--cover", "0.85", "-o", sol) == 0
    covered = cellcolor.Instance.read(tmp_path / "sol.covered.json")
    assert len(covered.cells) < len(cellcolor.Instance.read(file).cells)
    assert run("check", tmp_path / "sol.covered.json", sol) == 0
