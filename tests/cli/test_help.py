"""Help texts."""

from __future__ import annotations

import pytest
from commands import run

import cellcolor.cli.failures

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize("columns", [80, 50])
def test_help_is_cut_nowhere(
    columns: int, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert run("--help") == 0
    _, _, listed = capsys.readouterr().out.partition("Commands:")
    text = "".join(listed.split())  # lines may end at hyphens
    for name, command in cellcolor.cli.failures.cellcolor.commands.items():
        assert command.help is not None
        paragraph = "".join(command.help.partition("\n\n")[0].split())
        assert f"{name}{paragraph}" in text
