"""``read``, ``build``, ``solve``, ``check`` and ``judge`` as a stranger calls them."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documents import PLAN, SOLUTION
from hypothesis import given
from library import INSTANCES, PAPER
from meshes import drawn, surfaces
from shipped import ROBOTS, SCENES

import cellcolor
from cellcolor import InputError, LabelledSurface, Plan, Solution
from cellcolor.cli import main
from examples import examples

RING = PAPER / "ring.json"
RING_SURFACE = PAPER / "ring.surface.json"
HALVES = drawn("AAABBB AAABBB", {"A": [0], "B": [1]})
"""Red on the left, blue on the right, nothing shared: two segments."""


def test_whatever_it_is_the_answer_is_the_same() -> None:
    """A path, its text, a shipped name, a value; the graph or its surface."""
    sources: list[Any] = [
        RING,
        str(RING),
        "ring",
        cellcolor.read("ring"),
        RING_SURFACE,
        "ring.surface.json",
        LabelledSurface.read(RING_SURFACE),
    ]
    for source in sources:
        result = cellcolor.solve(source)
        assert (result.segments, result.lift_offs, result.optimal) == (2, 1, True)
        assert cellcolor.check(source, result).valid


def test_read_takes_every_format(tmp_path: Path) -> None:
    values = (Solution.from_document(SOLUTION), Plan.from_document(PLAN))
    for value in values:
        file = tmp_path / "file.json"
        file.write_text(value.to_json(), encoding="utf-8")
        assert cellcolor.read(file) == value
    file.write_text('{"format": "cellcolor/other"}', encoding="utf-8")
    with pytest.raises(InputError, match=r"file\.json: format: must be .*cellcolor/plan"):
        cellcolor.read(file)
    file.write_text('{"format": ["cellcolor/plan"]}', encoding="utf-8")
    with pytest.raises(InputError, match=r"file\.json: format: must be "):
        cellcolor.read(file)
    file.write_text("[]", encoding="utf-8")
    with pytest.raises(InputError, match=r"file\.json: must be a JSON object"):
        cellcolor.read(file)


def test_scenes_and_setups_are_told_apart() -> None:
    from cellcolor.frontend import Scene, Setup

    assert isinstance(cellcolor.read(ROBOTS / "ur5_polishing.toml"), Setup)
    for file in SCENES.glob("*.toml"):
        assert isinstance(cellcolor.read(file), Scene)


def test_a_scene_is_built() -> None:
    stages: list[str] = []
    built = cellcolor.build("square", progress=stages.append)
    assert stages[0] == "preparation" and len(stages) > 3
    stored = LabelledSurface.read(SCENES / "square.surface.json")
    assert built.surface.colors == stored.colors
    assert "square" in str(built) and len(repr(built)) < 200
    assert built == pickle.loads(pickle.dumps(built))
    found = cellcolor.solve(built)
    assert found.surface is built.surface
    assert found.segments == cellcolor.solve("square.json").segments
    with pytest.raises(InputError, match="time_limit"):
        cellcolor.build("square", time_limit=-1)
    with pytest.raises(cellcolor.OutOfTime):
        cellcolor.build("square", time_limit=1e-6)


def test_a_result_says_what_is_proved_and_why() -> None:
    assert str(cellcolor.solve(HALVES)) == (
        "2 segments, 1 lift-off, optimal: proved for any division of the surface, "
        "because cells 0 and 1 share no color"
    )
    assert str(cellcolor.solve("parallel-corridors")) == (
        "3 segments, 2 lift-offs, optimal in the search space paper, "
        "by a recursion over the graph; any division of the surface has at least 2"
    )
    whole = drawn("AA AA", {"A": [0]})
    assert str(cellcolor.solve(whole)) == (
        "1 segment, 0 lift-offs, optimal: proved for any division of the surface"
    )
    bare = drawn("AA AA", {"A": []})
    assert str(cellcolor.solve(bare)) == "no division: no point of the surface can be covered"


def test_a_result_is_a_value(tmp_path: Path) -> None:
    result = cellcolor.solve(HALVES)
    again = pickle.loads(pickle.dumps(result))
    assert again == result and hash(again) == hash(result) and repr(again) == repr(result)
    assert len(repr(result)) < 250
    assert result != cellcolor.solve("ring")
    assert result.surface == HALVES
    assert cellcolor.solve(cellcolor.decompose(HALVES)).surface is None
    file = tmp_path / "s.json"
    result.save(str(file))
    result.save(file)  # over an older solution
    assert cellcolor.read(file) == replace(
        result.solution, seconds=round(result.solution.seconds, 4)
    )
    with pytest.raises(InputError, match="is not overwritten"):
        result.save(_copy(RING, tmp_path))


def _copy(file: Path, folder: Path) -> Path:
    copy = folder / file.name
    copy.write_bytes(file.read_bytes())
    return copy


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"time_limit": 0}, "time_limit: must be a positive number of seconds or None, is 0"),
        ({"time_limit": "10"}, "time_limit: must be a positive number of seconds or None, is '10'"),
        ({"time_limit": True}, "time_limit: must be a positive number"),
        ({"time_limit": float("nan")}, "time_limit: must be a positive number"),
        ({"strands": 2}, "strands: must be 1 in search space 'paper'"),
    ],
    ids=str,
)
def test_wrong_options_are_refused(options: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError) as caught:
        cellcolor.solve("ring", **options)
    assert text in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("source", [None, 3, 2.5, [1], object(), b"ring", PLAN])
def test_what_cannot_be_solved_is_refused(source: Any) -> None:
    functions: list[Any] = [cellcolor.solve, cellcolor.show, cellcolor.decompose]
    solution = Solution.from_document(SOLUTION)
    functions += [lambda s: cellcolor.check(s, solution), cellcolor.proven_range]
    for function in functions:
        with pytest.raises(InputError, match="must be a scene, a surface, an instance or a file"):
            function(source)


def test_options_reach_the_solver() -> None:
    found = cellcolor.solve("parallel-corridors", search_space="surface", strands=3, seed=4)
    assert (found.solution.strands, found.segments) == (3, 2)
    assert cellcolor.solve("ring", solver="dfs").solution.solver == "dfs"
    seen: list[tuple[int | None, int]] = []
    cellcolor.solve("hub_24", progress=lambda best, least: seen.append((best, least)))
    assert seen and seen[-1][0] == 15


def test_check_finds_what_is_wrong() -> None:
    found = cellcolor.solve("ring")
    assert str(cellcolor.check("ring", found)) == "valid: 2 segments"
    wrong = replace(found.solution, segments=1, lift_offs=0)
    report = cellcolor.check("ring", wrong)
    assert not report.valid and str(report).startswith("not valid: ")
    assert not cellcolor.check("split-cell", found).valid


@given(surfaces())
@examples(12)
def test_a_plan_is_any_sequence_of_colors(surface: LabelledSurface) -> None:
    """Plan, list, tuple, arrays: one verdict; -1 stands for None in an array of integers only."""
    colors = [next(iter(own), None) for own in surface.vertex_colors]
    bounds = cellcolor.ProvenRange(0, len(colors))
    verdict = cellcolor.judge(surface, Plan(tuple(colors)), bounds=bounds)
    assert verdict.valid
    bare = np.array([-1 if color is None else color for color in colors])
    for plan in (colors, tuple(colors), bare, bare.astype(np.int8), np.array(colors, object)):
        assert cellcolor.judge(surface, plan, bounds=bounds) == verdict
    if None in colors:
        assert not cellcolor.judge(surface, bare.tolist(), bounds=bounds).valid


def test_the_proven_range_is_that_of_the_surface() -> None:
    assert cellcolor.proven_range("parallel-corridors.surface.json").exact
    assert str(cellcolor.proven_range(HALVES)) == "exactly 2 segments"
    with pytest.raises(InputError, match=r"ring\.json: surface: is missing"):
        cellcolor.proven_range("ring")


def test_decompose_gives_what_is_solved() -> None:
    for source in ("ring", "ring.surface.json", LabelledSurface.read(RING_SURFACE)):
        assert cellcolor.decompose(source) == cellcolor.solve(source).instance
    assert cellcolor.decompose(HALVES).surface is None  # it is in no file
    with pytest.raises(cellcolor.OutOfTime):
        cellcolor.decompose(RING_SURFACE, time_limit=1e-9)


def test_time_ends_the_work() -> None:
    with pytest.raises(cellcolor.OutOfTime):
        cellcolor.solve(INSTANCES / "random" / "blobs_0.surface.json", time_limit=1e-9)


@pytest.mark.parametrize("bounds", [3, (2, 2), "exactly 2"])
def test_bounds_are_a_proven_range(bounds: Any) -> None:
    with pytest.raises(InputError, match=r"^bounds: must be what cellcolor\.proven_range returns"):
        cellcolor.judge(HALVES, [0] * len(HALVES.vertices), bounds=bounds)


def test_a_setup_is_no_scene() -> None:
    with pytest.raises(InputError, match=r"ur5_polishing\.toml: is a robot's setup, not a scene"):
        cellcolor.solve("ur5_polishing")


def test_an_instance_read_from_a_file_says_where_its_surface_is(tmp_path: Path) -> None:
    """A value does not know the folder that it was read from."""
    surface, file = tmp_path / "s.surface.json", tmp_path / "s.json"
    surface.write_text(HALVES.to_json(), encoding="utf-8")
    assert main(["build", str(surface), "-o", str(file)]) == 0
    assert cellcolor.proven_range(file).exact
    functions: list[Any] = [cellcolor.proven_range, lambda i: cellcolor.show(i, view="cells")]
    for function in functions:
        with pytest.raises(InputError, match=r"surface: lies in 's\.surface\.json' beside"):
            function(cellcolor.read(file))
        with pytest.raises(InputError, match="surface: is missing"):
            function(cellcolor.read(RING))
