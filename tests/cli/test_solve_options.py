"""``solve``: options that ask for more than the fewest segments."""

from __future__ import annotations

import pytest
from commands import run
from library import PAPER

RING = PAPER / "ring.json"

CORRIDORS = PAPER / "parallel-corridors.json"

Capture = pytest.CaptureFixture[str]


class TestMore:
    def test_too_many_workers(self, capsys: Capture) -> None:
        assert run("solve", RING, "--workers", 1000) == 0
        assert "1000 workers share" in capsys.readouterr().err

    def test_reason_for_the_bound(self, capsys: Capture) -> None:
        assert run("solve", RING) == 0
        # Cells 0 and 1 have red, and cell 2 in the middle is blue.
        out = capsys.readouterr().out
        assert any(
            f"because cells {cell} and 2 share no color" in " ".join(out.split()) for cell in (0, 1)
        )

    def test_what_proves_a_minimum_of_the_search_space(self, capsys: Capture) -> None:
        assert run("solve", CORRIDORS, "--solver", "dfs") == 0
        assert "optimal in the search space paper, by exhaustive search" in " ".join(
            capsys.readouterr().out.split()
        )
