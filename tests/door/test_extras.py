"""What needs an extra that is not installed says so at once, and which one."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from commands import run
from meshes import drawn

import cellcolor
from cellcolor.door import planning

LINE = "needs {}: pip install 'fewest-lift-offs[motion]'"


@pytest.mark.parametrize("module", planning._NEEDED)
def test_planning_asks_for_the_extra_before_anything_is_built(
    module: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Whatever is missing of it: what the front end needs comes with it."""
    monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.setattr(planning, "scene_of", None)
    assert run("plan", "wok", "-o", str(tmp_path / "out")) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"cellcolor: planning a motion: {LINE.format(module)}"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("module", ["scipy", "potpourri3d"])
def test_tool_paths_ask_for_it(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    surface = drawn("aa aa", {"a": [0]})
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(cellcolor.InputError) as refusal:
        cellcolor.cover(surface, cellcolor.Plan([0] * 4), spacing_m=0.1, tool_radius_m=0.1)
    assert str(refusal.value) == f"tool paths: {LINE.format(module)}"
