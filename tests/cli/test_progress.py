"""How far long work is, where no terminal shows it."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from cellcolor.cli import terminal


def test_without_a_terminal_a_line_now_and_then(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(terminal, "_MINUTE", 0.05)
    said = ""
    with terminal.at_work(Path("folder/part.toml"), "building") as tell:
        tell("validity between vertices")
        while "2 minutes" not in said:
            time.sleep(0.01)
            said += capsys.readouterr().err
    assert "part.toml: validity between vertices, 2 minutes so far\n" in said
    time.sleep(0.1)
    assert capsys.readouterr().err.count("\n") <= 1  # of the last moment; nothing goes on


def test_what_is_quick_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    with terminal.at_work(Path("part.toml"), "building") as tell:
        tell("preparation")
    assert capsys.readouterr().err == ""
