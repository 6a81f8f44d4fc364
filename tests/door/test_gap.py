"""How best division and bound met over time: steps that never go back, and their picture."""

from itertools import pairwise
from pathlib import Path

import pytest
from commands import run

import cellcolor
from cellcolor.door.drawing import curves_of_gap


@pytest.fixture(scope="module", params=["half_pipe_8000_clean", "hub_60", "hub_loops_2x6"])
def result(request: pytest.FixtureRequest) -> cellcolor.Result:
    return cellcolor.solve(request.param, time_limit=1)


def test_the_gap_only_closes(result: cellcolor.Result) -> None:
    assert result.gap
    for before, after in pairwise(result.gap):
        assert before.seconds <= after.seconds
        assert before.lower_bound <= after.lower_bound
        assert before.segments is None or (after.segments or 0) <= before.segments
    last = result.gap[-1]
    assert (last.segments, last.lower_bound) == (result.segments, result.solution.lower_bound)


def test_the_picture_has_a_line_for_the_division_and_each_bound(result: cellcolor.Result) -> None:
    *kinds, bound, best = (curves := curves_of_gap(result))
    assert curves[best][-1][1] == result.segments
    assert curves[bound][-1][1] == result.solution.lower_bound
    bounds = result.solution.bounds or ()
    assert [label.split(":")[0] for label in kinds] == [own.kind for own in bounds]


def test_the_command_draws_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("solve", "half_pipe_8000_clean", "--picture", tmp_path / "gap.png") == 0
    assert (tmp_path / "gap.png").read_bytes().startswith(b"\x89PNG")
    assert run("solve", "half_pipe_8000_clean", "--picture", tmp_path / "gap.html") == 2
    assert "must end in .png or .svg" in capsys.readouterr().err
    assert run("solve", "wok_500_raw", "square_500_raw", "--picture", tmp_path / "gap.png") == 2
    assert "--picture is of a single file" in capsys.readouterr().err
