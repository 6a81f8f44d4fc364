"""The tables of ``benchmarks/oracle.py``, with small counts, and what the README has of them."""

from __future__ import annotations

import re
import sys

import pytest
from library import INSTANCES
from planners import largest_set_first

import cellcolor
from cellcolor.data.surface import LabelledSurface

sys.path.append(str(INSTANCES.parent / "benchmarks"))
import oracle

pytestmark = pytest.mark.slow

ROOT = INSTANCES.parent
SCENES = {
    "hemisphere, flat": "hemisphere_flat",
    "hemisphere, tilted": "hemisphere_tilted",
    "half pipe": "half_pipe",
    "wok": "wok",
    "wok with an obstacle": "wok_obstacle",
    "square": "square",
}


def test_the_readme_has_what_greedy_pays() -> None:
    """And what the other columns are in one row."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    paper = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    for title, name in SCENES.items():
        row = re.search(rf"^\| {title} \|(.*)\|$", readme, re.MULTILINE)
        assert row is not None
        _, proved, greedy, nearest, *_ = (column.strip(" *") for column in row[1].split("|"))
        file = INSTANCES / "scenes" / f"{name}.surface.json"
        surface = LabelledSurface.read(file)
        judge = cellcolor.Oracle(surface, workers=1)
        assert int(proved) == max(0, judge.bounds.lower - 1) == max(0, judge.bounds.upper - 1)
        assert int(greedy) == judge.judge(largest_set_first(surface)).lift_offs
        assert f"| {name} | {proved} | {greedy} | {nearest} |" in paper
    found = oracle.row_of_planners(INSTANCES / "scenes" / "hemisphere_flat.surface.json")
    assert f"| {' | '.join(found)} |" in paper
