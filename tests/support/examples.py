"""How many examples Hypothesis draws for a test: few by default, more of them when asked for."""

from __future__ import annotations

from hypothesis import settings

DEFAULT, THOROUGH = 30, 200

MIDDLE = 40
"""What numbers of examples are given for: a profile with more draws more for each test."""


def examples(count: int) -> settings:
    """Three quarters of so many by default, to save time in the ordinary run, and five times as
    many with ``pytest --hypothesis-profile=thorough``."""
    return settings(max_examples=max(1, count * settings().max_examples // MIDDLE))
