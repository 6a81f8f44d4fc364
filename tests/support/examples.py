"""How many examples Hypothesis draws for a test: few by default, more of them when asked for."""

from __future__ import annotations

from hypothesis import settings

DEFAULT = 40
THOROUGH = 5 * DEFAULT


def examples(count: int) -> settings:
    """So many by default, five times as many with ``pytest --hypothesis-profile=thorough``."""
    return settings(max_examples=count * settings().max_examples // DEFAULT)
