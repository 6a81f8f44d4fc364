"""The files: what is written is what is read, and what no format allows is refused by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from documents import INSTANCE, KINDS, SOLUTION, SURFACE, Change, broken, drop, put
from hypothesis import given
from library import INSTANCES, PAPER
from meshes import surfaces

from cellcolor.data import value
from cellcolor.data.instance import Instance
from cellcolor.data.solution import (
    CellDivision,
    Solution,
    SubCell,
    read_schemes,
    scheme_key,
    scheme_line,
)
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_written_is_what_was_read(kind: type[value.Document]) -> None:
    assert json.loads(kind.from_document(KINDS[kind]).to_json()) == KINDS[kind]


GRAPHS = [
    path
    for path in sorted(INSTANCES.rglob("*.json"))
    if path.name != "index.json" and not path.name.endswith(".solution.json")
]


@pytest.mark.parametrize("path", GRAPHS, ids=lambda path: path.name)
def test_library_files_are_as_written(path: Path) -> None:
    """The library holds the text that the package itself writes, so that fingerprints agree."""
    text = path.read_text(encoding="utf-8")
    kind = LabelledSurface if path.name.endswith(".surface.json") else Instance
    assert kind.read(path).to_json() == text


@pytest.mark.parametrize("path", sorted(PAPER.glob("*.json")), ids=lambda p: p.name)
def test_library_instances_say_what_is_known_and_why(path: Path) -> None:
    if path.name.endswith(".surface.json"):
        assert path.with_name(path.name.replace(".surface", "")).exists()
        return
    instance = Instance.read(path)
    assert instance.known is not None
    assert instance.known.paper is not None
    assert instance.meta is not None
    assert {"source", "why"} <= set(instance.meta)


@given(surfaces())
def test_surfaces_and_their_instances_come_back(labelled: LabelledSurface) -> None:
    text = labelled.to_json()
    again = LabelledSurface.from_document(json.loads(text))
    assert again.to_json() == text
    instance = decompose(labelled, "s.json")
    assert Instance.from_document(json.loads(instance.to_json())) == instance


def test_order_of_colors_in_a_vertex_means_nothing() -> None:
    swapped = LabelledSurface.from_document(broken(SURFACE, put("vertex_colors", 0, to=[1, 0])))
    assert swapped.to_json() == LabelledSurface.from_document(SURFACE).to_json()


def test_joinable_colors() -> None:
    instance = Instance.from_document(INSTANCE)
    # The smaller set where the file gives one, else what both cells share; nothing to the outside.
    assert [instance.joinable(dart) for dart in (1, -1, 2, 3, -4)] == [(0,), (0,), (), (), (0,)]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(
    ("change", "field"),
    [
        (put("format", to="cellcolor/else"), "format"),
        (drop("format"), "format"),
        (put("version", to=4), "version"),
        (put("version", to="1"), "version"),
        (put("version", to=True), "version"),
        (drop("version"), "version"),
        (put("colour", to=1), "colour"),
    ],
    ids=["format", "no format", "version", "version text", "version true", "no version", "member"],
)
def test_every_format_refuses(
    kind: type[value.Document], change: Change, field: str, tmp_path: Path
) -> None:
    path = tmp_path / "broken.json"
    path.write_text(json.dumps(broken(KINDS[kind], change)), encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        kind.read(path)
    assert (refusal.value.file, refusal.value.field) == (str(path), field)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not JSON"),
        ("[]", "must be a JSON object"),
        ('{"format": 1, "format": 1}', "member appears twice"),
        ('{"format": NaN}', "NaN is not a JSON number"),
        ("[" * 100_000, "nested too deeply"),
    ],
    ids=["empty", "list", "repeated member", "NaN", "deep"],
)
def test_every_format_refuses_text(
    kind: type[value.Document], text: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "broken.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as refusal:
        kind.read(path)
    assert refusal.value.file == str(path)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_truncated_anywhere(kind: type[value.Document], tmp_path: Path) -> None:
    """No proper beginning of a file is taken for a whole one."""
    text = kind.from_document(KINDS[kind]).to_json().rstrip()
    path = tmp_path / "truncated.json"
    for length in range(0, len(text), 7):
        path.write_text(text[:length], encoding="utf-8")
        with pytest.raises(InputError, match="not JSON") as refusal:
            kind.read(path)
        assert refusal.value.file == str(path)


def test_schemes_follow_a_solution(tmp_path: Path) -> None:
    solution = Solution.from_document(SOLUTION)
    divisions = [
        (CellDivision(0, (SubCell(color, (1, -2), 0), SubCell(1, (), 1))),) for color in (0, 2)
    ]
    path = tmp_path / "all.jsonl"
    lines = [json.dumps(solution.to_document()), *map(scheme_line, divisions)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert Solution.read(path) == solution
    assert list(read_schemes(path)) == divisions
    assert json.loads(lines[1]) == {
        "format": "cellcolor/scheme",
        "cells": [
            {
                "id": 0,
                "subcells": [
                    {"color": 0, "darts": [1, -2], "segment": 0},
                    {"color": 1, "darts": [], "segment": 1},
                ],
            }
        ],
    }


def test_a_solution_alone_has_no_schemes(tmp_path: Path) -> None:
    path = tmp_path / "one.json"
    path.write_text(Solution.from_document(SOLUTION).to_json(), encoding="utf-8")
    assert list(read_schemes(path)) == []


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('{"format": "cellcolor/scheme", "cells": [', "line 2"),
        ('{"format": "cellcolor/solution", "cells": []}', "line 2, format"),
        ('{"format": "cellcolor/scheme", "cells": [{"id": 0}]}', "line 2, cells[0].subcells"),
        ('{"format": "cellcolor/scheme", "cells": [], "more": 1}', "line 2, more"),
    ],
)
def test_broken_scheme(line: str, field: str, tmp_path: Path) -> None:
    path = tmp_path / "all.jsonl"
    path.write_text(f"{json.dumps(SOLUTION)}\n{line}\n", encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        list(read_schemes(path))
    assert (refusal.value.file, refusal.value.field) == (str(path), field)


def test_schemes_are_the_same_whatever_their_order() -> None:
    one, other = SubCell(0, (1, 2), 0), SubCell(1, (3, 4), 1)
    swapped = SubCell(0, (2, 1), 5)
    key = scheme_key((CellDivision(0, (one, other)),))
    assert key == scheme_key((CellDivision(0, (other, swapped)),))
    assert key != scheme_key((CellDivision(0, (one, SubCell(2, (3, 4), 1))),))
    assert key != scheme_key((CellDivision(0, (one, SubCell(1, (3,), 1))),))
