"""What the tests of several commands start from."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

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
