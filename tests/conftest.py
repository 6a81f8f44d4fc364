"""Where the instance library is."""

from __future__ import annotations

from pathlib import Path

import pytest

INSTANCES = Path(__file__).parents[1] / "instances"


@pytest.fixture
def paper() -> Path:
    """The folder of the paper's figures and the reference cases."""
    return INSTANCES / "paper"
