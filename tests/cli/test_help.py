"""Help texts."""

from __future__ import annotations

import re
from typing import cast

import click
import pytest
from commands import run

from cellcolor.cli.failures import cellcolor

Capture = pytest.CaptureFixture[str]


COMMANDS = {**cellcolor.commands, **cast(click.Group, cellcolor.commands["bench"]).commands}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_described(name: str, capsys: Capture) -> None:
    """By the command, or where the front door says what its keyword means."""
    group = ["bench"] if name in ("run", "summary") else []
    assert run(*group, name, "--help") == 0
    assert not re.search("None|`|:class", capsys.readouterr().out)
    options = [own for own in COMMANDS[name].params if isinstance(own, click.Option)]
    assert all(own.help for own in options)


@pytest.mark.parametrize("columns", [80, 50])
def test_help_is_cut_nowhere(
    columns: int, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert run("--help") == 0
    _, _, listed = capsys.readouterr().out.partition("Commands:")
    text = "".join(listed.split())  # lines may end at hyphens
    for name, command in cellcolor.commands.items():
        assert command.help is not None
        paragraph = "".join(command.help.partition("\n\n")[0].split())
        assert f"{name}{paragraph}" in text
