"""Where the instance library is."""

from pathlib import Path

INSTANCES = Path(__file__).parents[2] / "instances"
PAPER = INSTANCES / "paper"
