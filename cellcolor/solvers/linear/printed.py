"""The lines that the programs of the rivals print; see ``rival``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def say(line: str) -> None:
    """Print a line at once."""
    print(line, flush=True)


def say_solution(names: Sequence[str], values: Iterable[float]) -> None:
    """Print the variables that are 1."""
    true = [name for name, value in zip(names, values, strict=True) if value > 0.5]
    say(f"solution {' '.join(true)}")
