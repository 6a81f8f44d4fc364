"""The map of ``place``: every placement that was tried, by what is known of it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from cellcolor import InputError
from cellcolor.door.asking import save_map
from cellcolor.questions.placements import PlacedMinimum, Placements

HERE = PlacedMinimum((0.5, 0, 0, 0, 0, 0), 3, 0.9, True, 200)
BEST = PlacedMinimum((0.6, 0.1, 0, 0, 0, 0), 2, 0.95, True, 200)
BOUNDED = replace(BEST, pose=(0.7, 0.2, 0, 0, 0, 0), segments=None, at_least=4)
SMALL = replace(BEST, pose=(0.8, 0.3, 0, 0, 0, 0), covered_share=0.5)
REFUSED = PlacedMinimum((0.9, 0.4, 0, 0, 0, 0), None, 0.0, False, 0, "it would stand in a link")
LATE = replace(REFUSED, pose=(1.0, 0.4, 0, 0, 0, 0), refused="")
FOUND = Placements("plate", 0.9, HERE, (BEST,), (BOUNDED, SMALL, REFUSED, LATE))


def texts(file: Path) -> set[str]:
    return set(re.findall(r"<text[^>]*>([^<]*)</text>", file.read_text("utf-8")))


def test_each_kind_of_placement_has_its_place_in_the_legend(tmp_path: Path) -> None:
    save_map(FOUND, tmp_path / "map.svg")
    assert texts(tmp_path / "map.svg") >= {
        "plate: placements that were tried",
        "x, m",
        "y, m",
        "where it stands",
        "among the best",
        "1 lift-off",
        "2 lift-offs",
        "at least 3 lift-offs",
        "covers too little",
        "the part cannot stand there",
        "no answer in time",
    }


def test_of_one_variable_the_other_axis_has_the_lift_offs(tmp_path: Path) -> None:
    turned = replace(HERE, pose=(0.5, 0, 0, 0, 0, 1.0))
    save_map(replace(FOUND, best=(turned,), tried=()), tmp_path / "map.svg")
    assert texts(tmp_path / "map.svg") >= {"yaw, rad", "lift-offs"}


def test_what_cannot_be_drawn_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="one placement was tried"):
        save_map(replace(FOUND, best=(HERE,), tried=()), tmp_path / "map.png")
    with pytest.raises(InputError, match=re.escape("must end in .png or .svg")):
        save_map(FOUND, tmp_path / "map.html")
    assert not any(tmp_path.iterdir())
