"""Tool paths as values and as files."""

from __future__ import annotations

import copy
import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from documents import TOOL_PATHS

from cellcolor.data.tool_paths import ToolPaths
from cellcolor.errors import InputError

PATHS = ToolPaths.from_document(TOOL_PATHS)
PATH = PATHS.paths[0]


def test_written_and_read_it_is_the_same(tmp_path: Path) -> None:
    file = tmp_path / "paths.json"
    file.write_text(PATHS.to_json(), encoding="utf-8")
    assert ToolPaths.read(file) == PATHS
    assert json.loads(PATHS.to_json()) == TOOL_PATHS


def test_copies_are_equal_and_others_are_not() -> None:
    for value, other in ((PATH, replace(PATH, segment=1)), (PATHS, replace(PATHS, name="x"))):
        assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)
        assert value != other and value != "text"
    assert replace(PATHS, paths=(replace(PATH, points=PATH.points + 1),)) != PATHS


def test_lengths_are_those_of_the_steps() -> None:
    assert PATH.length == pytest.approx(0.3 + 0.4)
    assert replace(PATHS, paths=(PATH, PATH)).length == pytest.approx(1.4)
    assert str(PATH) == "tool path on segment 0: 0.700 m, 3 points"
    assert str(PATHS) == "triangle: 1 tool path, contour, 0.70 m"


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "one point": ({"points": [[0, 0, 0]]}, r"paths\[0\].points: a path needs at least two points"),
    "no point": ({"points": []}, r"paths\[0\].points: a path needs at least two points"),
    "normals": ({"normals": [[0.0, 0.0, 1.0]]}, r"paths\[0\].normals: has 1 entries for 3 points"),
    "faces": ({"faces": [0]}, r"paths\[0\].faces: has 1 entries for 2 steps"),
    "text": ({"points": [["a", 0, 0]]}, r"paths\[0\].points\[0\]\[0\]"),
    "member": ({"color": 1.0}, r"paths\[0\].color"),
    "unknown": ({"speed": 1.0}, "speed"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_the_format_forbids_is_named(name: str, tmp_path: Path) -> None:
    change, complaint = BAD[name]
    document = copy.deepcopy(TOOL_PATHS)
    document["paths"][0] |= change
    file = tmp_path / "bad.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(InputError, match=complaint) as refused:
        ToolPaths.read(file)
    assert str(refused.value).startswith(str(file))
