"""A build ends when its time does, wherever it is, and says what it is doing."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dirty import BOX, OUTWARD, obj
from shipped import shipped

from cellcolor.cli import main
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.frontend import build_surface
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.prepared import prepare

STAGES = [
    "preparation",
    "inverse kinematics",
    "validity at the vertices",
    "continuity",
    "validity between vertices",
    "colors and cracks",
    "surface",
]


@pytest.fixture
def part(scene_file: Callable[..., Path], tmp_path: Path) -> Path:
    """A box to be refined, beside a mesh obstacle and one by its measures."""
    (tmp_path / "box.obj").write_text(obj(BOX, OUTWARD))
    text = scene_file().read_text()
    start, end = text.index("[object]"), text.index("[placement]")
    table = '[object]\nkind = "mesh"\nfile = "box.obj"\nmeters_per_unit = 0.1\nmax_edge_m = 0.04\n'
    obstacles = (
        '\n[[obstacle]]\nkind = "mesh"\nfile = "box.obj"\nmeters_per_unit = 0.05\n'
        "position_m = [0.5, 0.3, 0.0]\n"
        '\n[[obstacle]]\nkind = "sphere"\nradius_m = 0.05\nposition_m = [0.3, 0.4, 0.1]\n'
    )
    file = tmp_path / "scene.toml"
    file.write_text(text[:start] + table + text[end:] + obstacles)
    return file


def counting(monkeypatch: pytest.MonkeyPatch, patience: float) -> list[int]:
    """Let every deadline pass when it has been asked so often; how often they were."""
    asked = [0]

    def check(_self: Deadline) -> None:
        asked[0] += 1
        if asked[0] > patience:
            raise OutOfTime("in a test")

    monkeypatch.setattr(Deadline, "check", check)
    return asked


def test_every_stage_asks_and_ends(part: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = counting(monkeypatch, np.inf)
    begun: list[tuple[str, int]] = []
    build_surface(part, Deadline(), lambda stage: begun.append((stage, asked[0])))
    assert [stage for stage, _ in begun] == STAGES
    # Once for its name, and at least once more on its way.
    times = [count for _, count in begun] + [asked[0]]
    assert all(np.diff(times) >= 2), times
    for patience in range(0, asked[0], max(1, asked[0] // 10)):
        counting(monkeypatch, patience)
        with pytest.raises(OutOfTime):
            build_surface(part, Deadline())


def test_no_instance_in_time_is_unknown(
    part: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One line and exit code 3, whether the scene or its graph took too long."""
    surface = tmp_path / "built.json"
    assert main(["build", str(part), "-o", str(surface)]) == 0
    for file in (part, tmp_path / "built.surface.json"):
        capsys.readouterr()
        out = tmp_path / "out.json"
        command = ["solve", str(file), "--time-limit", "1e-9", "--json", "-o", str(out)]
        assert main(command) == 3
        printed = capsys.readouterr()
        assert len(printed.err.splitlines()) == 1 and "unknown" in printed.err
        (line,) = map(json.loads, printed.out.splitlines())
        assert (line["file"], line["status"]) == (str(file), "unknown")
        assert not out.exists()


def test_a_prepared_scene_outlives_the_deadline_that_it_was_prepared_by() -> None:
    """No deadline is part of it: what is asked later has a deadline of its own, or none."""
    soon = Deadline.after(2.0)
    prepared = prepare(shipped("square", 50), soon)
    time.sleep(soon.left)
    with pytest.raises(OutOfTime):
        prepared.arm.inverse(prepared.surface.vertices, -prepared.surface.normals, soon)
    with pytest.raises(OutOfTime):
        prepared.judge(np.zeros((1, 6)), soon)
    assert build_prepared(prepared, StageClock(NEVER, None)).report.reachable > 0
