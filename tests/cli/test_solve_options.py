"""``solve``: options that ask for more than the fewest segments."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import run
from library import INSTANCES, PAPER

from cellcolor.data.solution import Solution

RING = PAPER / "ring.json"

CORRIDORS = PAPER / "parallel-corridors.json"

Capture = pytest.CaptureFixture[str]


class TestMore:
    """Options beyond the contract: a second objective, a start, a warning, a reason."""

    def test_warm_start(self, tmp_path: Path) -> None:
        """A start that is optimal already is what comes back when there is no time for more."""
        start, target = tmp_path / "start.json", tmp_path / "solution.json"
        instance = INSTANCES / "random" / "hub_24.json"
        assert run("solve", instance, "-o", start) == 0
        assert run("solve", instance, "--warm-start", start, "--time-limit", "1e-9", "-o", target)
        assert Solution.read(target).cells == Solution.read(start).cells
        # Without it every cell is painted whole, so that only one color's petals are joined.
        assert run("solve", instance, "--time-limit", "1e-9", "-o", target)
        assert (Solution.read(target).segments or 0) > (Solution.read(start).segments or 0)

    @pytest.mark.parametrize(
        ("arguments", "expected"),
        [
            ([RING], "instance.sha256: the solution is not for"),
            ([CORRIDORS, "--search-space", "surface"], "strands: is 1, wanted are 2"),
        ],
    )
    def test_wrong_start(
        self, arguments: list[object], expected: str, tmp_path: Path, capsys: Capture
    ) -> None:
        start = tmp_path / "start.json"
        assert run("solve", CORRIDORS, "-o", start) == 0
        capsys.readouterr()
        assert run("solve", *arguments, "--warm-start", start) == 2
        err = capsys.readouterr().err
        assert err.count("\n") == 1 and str(start) in err and expected in err

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
