"""What the tests of several commands start from."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from piped import ROW, Pipe

import cellcolor.solvers.checked
from cellcolor.data.solution import Solution


@pytest.fixture
def not_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that is stopped with a division and a bound below it."""
    solve = cellcolor.solvers.checked.solve

    def stopped(*arguments: Any, **options: Any) -> Solution:
        solution = solve(*arguments, **options)
        return replace(solution, status="feasible", lower_bound=0)

    monkeypatch.setattr(cellcolor.solvers.checked, "solve", stopped)


@pytest.fixture
def row(tmp_path: Path) -> Path:
    path = tmp_path / "row.surface.json"
    path.write_text(ROW.to_json(), encoding="utf-8")
    return path


@pytest.fixture
def pipe(monkeypatch: pytest.MonkeyPatch) -> Pipe:
    """Puts something into standard input."""

    def put(content: str | bytes) -> None:
        raw = content if isinstance(content, bytes) else content.encode()
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(raw)))

    return put
