"""Pictures by name: ``--view``, and what each declares that it needs."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import run
from pages import DRAWN, saved, side_file

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("view", "option"),
    [
        (["cells"], []),
        (["color", "--color", "1"], ["--color", "1"]),
    ],
    ids=lambda value: " ".join(value) or "none",
)
def test_a_name_draws_what_its_option_does(
    view: list[str], option: list[str], tmp_path: Path
) -> None:
    path, _ = side_file(tmp_path)
    one, other = tmp_path / "one.svg", tmp_path / "other.svg"
    assert run("show", path, "-o", one, "--view", *view) == 0
    assert run("show", path, "-o", other, *option) == 0
    assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--view", "pie"], "'pie' is not one of 'arm', 'cells'"),
        (["--view", "color"], "color: the picture color needs it"),
        (["--view", "segments"], "solution: the picture segments needs it"),
        (["--view", "cells", "--color", "1"], "color: the picture cells does not take it"),
        (["--view", "cells", "--branch", "1"], "branch: the picture cells does not take it"),
    ],
    ids=lambda value: " ".join(value[1:]) if isinstance(value, list) else "",
)
def test_usage(arguments: list[str], message: str, tmp_path: Path, capsys: Capture) -> None:
    path = saved(DRAWN, tmp_path)
    capsys.readouterr()
    assert run("show", path, "-o", tmp_path / "x.svg", *arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("cellcolor") and message in line
    assert not (tmp_path / "x.svg").exists()
