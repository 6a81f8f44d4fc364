"""A bound that is too high is noticed when bounds are attacked by brute force."""

from __future__ import annotations

import sys

import pytest
from shipped import TOP

sys.path.append(str(TOP / "benchmarks"))
import attacked_bounds


def test_true_bounds_withstand(capsys: pytest.CaptureFixture[str]) -> None:
    assert attacked_bounds.main(["10", "1"]) == 0
    assert "; 0 wrong" in capsys.readouterr().out


def test_a_bound_that_is_too_high_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(attacked_bounds, "greedy_strangers", lambda _: range(100))
    assert attacked_bounds.main(["2", "1"]) == 1
    assert "strangers 100, of" in capsys.readouterr().out
