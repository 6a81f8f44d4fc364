"""The files: what is written is what is read, and everything forbidden is refused by name."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Protocol

import pytest
from documents import (
    INSTANCE,
    PLAN,
    SOLUTION,
    SURFACE,
    TOOL_PATHS,
    TRAJECTORY,
    VERDICT,
    Change,
    Document,
    broken,
    drop,
    put,
)
from hypothesis import given
from library import INSTANCES, PAPER
from meshes import surfaces

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import (
    CellDivision,
    Solution,
    SubCell,
    read_schemes,
    scheme_key,
    scheme_line,
)
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError


class Kind(Protocol):
    """Any of the formats."""

    @classmethod
    def from_document(cls, document: Document) -> Any: ...
    @classmethod
    def read(cls, path: Path) -> Any: ...


KINDS: dict[type[Kind], Document] = {
    LabelledSurface: SURFACE,
    Instance: INSTANCE,
    Solution: SOLUTION,
    Plan: PLAN,
    Trajectory: TRAJECTORY,
    TrajectoryVerdict: VERDICT,
    ToolPaths: TOOL_PATHS,
}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_written_is_what_was_read(kind: type[Kind]) -> None:
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
def test_every_format_refuses(kind: type[Kind], change: Change, field: str, tmp_path: Path) -> None:
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
    kind: type[Kind], text: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "broken.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as refusal:
        kind.read(path)
    assert refusal.value.file == str(path)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_truncated_anywhere(kind: type[Kind], tmp_path: Path) -> None:
    """No proper beginning of a file is taken for a whole one."""
    text = kind.from_document(KINDS[kind]).to_json().rstrip()
    path = tmp_path / "truncated.json"
    for length in range(0, len(text), 7):
        path.write_text(text[:length], encoding="utf-8")
        with pytest.raises(InputError, match="not JSON") as refusal:
            kind.read(path)
        assert refusal.value.file == str(path)


SURFACE_FAULTS = {
    "edge with three faces": (
        lambda d: (
            d["vertices"].append([0, 0, 1]),
            d["vertex_colors"].append([]),
            d["faces"].append([2, 0, 4]),
        ),
        "faces[2]",
        "not manifold",
    ),
    "face wound the other way": (put("faces", 1, to=[0, 3, 2]), "faces[1]", "winds the other way"),
    "pinched vertex": (
        lambda d: (
            d["vertices"].extend([[-1, 0, 0], [-1, -1, 0]]),
            d["vertex_colors"].extend([[], []]),
            d["faces"].append([0, 4, 5]),
        ),
        "vertices[0]",
        "pinched",
    ),
    "face with a repeated vertex": (put("faces", 0, to=[0, 1, 1]), "faces[0]", "repeats a vertex"),
    "vertex without a face": (
        lambda d: (d["vertices"].append([5, 5, 5]), d["vertex_colors"].append([])),
        "vertices[4]",
        "belongs to no face",
    ),
    "unknown vertex": (put("faces", 1, 2, to=9), "faces[1][2]", "no vertex 9"),
    "negative vertex": (put("faces", 1, 2, to=-1), "faces[1][2]", "no vertex -1"),
    "no faces": (put("faces", to=[]), "faces", "empty"),
    "two coordinates": (put("vertices", 1, to=[1, 0]), "vertices[1][2]", ""),
    "NaN coordinate": (put("vertices", 1, 2, to=float("nan")), "vertices[1][2]", "finite"),
    "infinite coordinate": (put("vertices", 1, 2, to=float("inf")), "vertices[1][2]", "finite"),
    "coordinate beyond everything": (
        put("vertices", 2, 1, to=-1e308),
        "vertices[2][1]",
        "beyond 1e+09 m",
    ),
    "two colors of one name": (put("colors", to=["a", "a"]), "colors[1]", "the name of color 0"),
    "coordinate as text": (put("vertices", 1, 2, to="0"), "vertices[1][2]", "number"),
    "fractional vertex": (put("faces", 0, 0, to=0.5), "faces[0][0]", "integer"),
    "color out of range": (put("vertex_colors", 2, to=[2]), "vertex_colors[2]", "unknown color 2"),
    "color twice": (put("vertex_colors", 2, to=[0, 0]), "vertex_colors[2]", "twice"),
    "colors of a vertex missing": (drop("vertex_colors", 3), "vertex_colors", "3 entries for 4"),
    "crack on what is no edge": (put("cracks", 0, to=[1, 3, [0]]), "cracks[0]", "not an edge"),
    "crack twice": (put("cracks", to=[[0, 2, [0]], [2, 0, [1]]]), "cracks[1]", "already"),
    "crack of an unknown color": (put("cracks", 0, to=[0, 2, [7]]), "cracks[0]", "unknown color 7"),
    "crack of a color of one end": (
        lambda d: (put("vertex_colors", 0, to=[0])(d), put("cracks", 0, 2, to=[1])(d)),
        "cracks[0]",
        "not shared",
    ),
    "crack of no color": (put("cracks", 0, to=[0, 2, []]), "cracks[0]", "at least one color"),
    "crack of a color twice": (put("cracks", 0, to=[0, 2, [1, 1]]), "cracks[0]", "each once"),
    "no such vertex given up": (put("given_up", to=[4]), "given_up[0]", "no vertex 4"),
    "vertex with colors given up": (put("given_up", to=[2, 3]), "given_up[0]", "has colors"),
    "vertex given up twice": (put("given_up", to=[3, 3]), "given_up[1]", "twice"),
    "no name": (drop("name"), "name", "is missing"),
}

INSTANCE_FAULTS = {
    "edge on three sides": (
        put("cells", 0, "loops", to=[[1, 2, 1]]),
        "cells[0].loops[0][2]",
        "twice",
    ),
    "dart of another cell": (
        put("cells", 1, "loops", to=[[-1, 3, 2], [4, -4]]),
        "cells[1].loops[0][2]",
        "does not close",
    ),
    "dart missing": (put("cells", 0, "loops", to=[[1]]), "edges[1]", "dart 2 is missing"),
    "side of a self-edge missing": (
        put("cells", 1, "loops", to=[[-1, 3], [4]]),
        "edges[3]",
        "dart -4 is missing",
    ),
    "side of the outside": (
        put("cells", 0, "loops", to=[[1, -2]]),
        "cells[0].loops[0][1]",
        "close",
    ),
    "dart of no edge": (put("cells", 0, "loops", to=[[1, 9]]), "cells[0].loops[0][1]", "no edge"),
    "dart zero": (put("cells", 0, "loops", to=[[1, 0]]), "cells[0].loops[0][1]", "no edge"),
    "empty loop": (put("cells", 0, "loops", to=[[1, 2], []]), "cells[0].loops[1]", "without darts"),
    "outside on both sides": (put("edges", 1, "left", to=-1), "edges[1]", "-1 on both sides"),
    "edge of no cell": (put("edges", 1, "left", to=7), "edges[1].left", "no cell 7"),
    "edge beyond the outside": (put("edges", 1, "right", to=-2), "edges[1].right", "no cell -2"),
    "edge id twice": (put("edges", 1, "id", to=1), "edges[1].id", "twice"),
    "edge id zero": (put("edges", 1, "id", to=0), "edges[1].id", "positive"),
    "cell ids out of order": (put("cells", 1, "id", to=2), "cells[1].id", "0, 1, 2"),
    "empty color set": (put("cells", 0, "colors", to=[]), "cells[0].colors", "no color"),
    "two colors of one name": (put("colors", to=["a", "a"]), "colors[1]", "the name of color 0"),
    "unknown color": (put("cells", 0, "colors", to=[5]), "cells[0].colors", "unknown color 5"),
    "color twice": (put("cells", 1, "colors", to=[0, 0]), "cells[1].colors", "twice"),
    "joinable color not shared": (
        put("edges", 0, "colors", to=[1]),
        "edges[0].colors",
        "not shared",
    ),
    "joinable color to the outside": (
        put("edges", 1, "colors", to=[0]),
        "edges[1].colors",
        "not shared",
    ),
    "negative area": (put("cells", 0, "area", to=-1.0), "cells[0].area", "greater"),
    "infinite length": (put("edges", 0, "length", to=float("inf")), "edges[0].length", "finite"),
    "member of a cell": (put("cells", 0, "colour", to=1), "cells[0].colour", ""),
    "member of an edge": (put("edges", 0, "darts", to=1), "edges[0].darts", ""),
    "cell of a vertex": (
        put("surface", "vertex_cell", 1, to=2),
        "surface.vertex_cell[1]",
        "no cell 2",
    ),
    "shares beyond the whole": (
        put("coverage", "given_up", to=0.8),
        "coverage",
        "more than the whole",
    ),
    "share above 1": (put("coverage", "unreachable", to=1.5), "coverage.unreachable", "less"),
    "known of what": (put("known", "else", to={"segments": 1}), "known.else", ""),
    "known without segments": (put("known", "paper", to={}), "known.paper.segments", "is missing"),
    "cells missing": (drop("cells"), "cells", "is missing"),
    "id as text": (put("edges", 0, "id", to="1"), "edges[0].id", "integer"),
    "id as true": (put("edges", 0, "id", to=True), "edges[0].id", "integer"),
}

SOLUTION_FAULTS = {
    "unknown with a number": (put("status", to="unknown"), "status", "null"),
    "null segments": (put("segments", to=None), "segments", "must not be null"),
    "null cells": (put("cells", to=None), "cells", "must not be null"),
    "null lift-offs": (put("lift_offs", to=None), "lift_offs", "must not be null"),
    "status": (put("status", to="best"), "status", "optimal"),
    "search space": (put("search_space", to="both"), "search_space", "paper"),
    "negative segments": (put("segments", to=-1), "segments", "greater"),
    "no strands": (put("strands", to=0), "strands", "greater"),
    "no instance": (drop("instance"), "instance", "is missing"),
    "bound of what": (put("bounds", 0, "holds_for", to="all"), "bounds[0].holds_for", "surface"),
    "bound below nothing": (put("bounds", 0, "value", to=-1), "bounds[0].value", "greater"),
    "member of a bound": (put("bounds", 0, "proof", to=1), "bounds[0].proof", ""),
    "note that is not text": (put("notes", 0, to=1), "notes[0]", "string"),
    "bound missing": (drop("surface_lower_bound"), "surface_lower_bound", "is missing"),
    "color as text": (
        put("cells", 0, "subcells", 0, "color", to="red"),
        "cells[0].subcells[0].color",
        "integer",
    ),
}

PLAN_FAULTS = {
    "color as text": (put("vertex_colors", 1, to="red"), "vertex_colors[1]", "integer"),
    "color as true": (put("vertex_colors", 1, to=True), "vertex_colors[1]", "integer"),
    "no colors": (drop("vertex_colors"), "vertex_colors", "is missing"),
}


TRAJECTORY_FAULTS = {
    "too few joints": (put("joints", 1, to=[0.5]), "joints", "rows of numbers"),
    "joints of another arm": (put("joint_names", to=["pan"]), "joints", "needs 1 numbers"),
    "too few times": (put("times", to=[0.0, 1.0]), "joints", "has 3 entries for 2 times"),
    "endless time": (put("times", 1, to=float("inf")), "times[1]", "number"),
    "flat points": (put("points", 0, to=[0.0, 0.0]), "points[0][2]", "is missing"),
    "contact as a number": (put("contact", 0, to=1), "contact[0]", "boolean"),
    "half a segment": (put("segment", 0, to=0.5), "segment[0]", "integer"),
    "sample as text": (put("unplanned", 0, to="1"), "unplanned[0]", "integer"),
    "no reason": (drop("left_out", 0, "reason"), "left_out[0].reason", "is missing"),
    "unknown member": (
        put("extra_lift_offs", 0, "why", to=""),
        "extra_lift_offs[0].why",
        "unknown key",
    ),
}

VERDICT_FAULTS = {
    "valid in spite of faults": (put("valid", to=True), "valid", "something else"),
    "unknown kind": (put("faults", 0, "kind", to="ugly"), "faults[0].kind", "Input should be"),
    "fewer than none": (put("strokes", to=-1), "strokes", "greater than or equal to 0"),
}


TOOL_PATHS_FAULTS = {
    "one point": (put("paths", 0, "points", to=[[0, 0, 0]]), "paths[0].points", "two points"),
    "no point": (put("paths", 0, "points", to=[]), "paths[0].points", "at least two points"),
    "normals": (put("paths", 0, "normals", to=[[0, 0, 1]]), "paths[0].normals", "1 entries for 3"),
    "faces": (put("paths", 0, "faces", to=[0]), "paths[0].faces", "1 entries for 2 steps"),
    "text": (put("paths", 0, "points", to=[["a", 0, 0]]), "paths[0].points[0][0]", "number"),
    "color": (put("paths", 0, "color", to=1.0), "paths[0].color", "integer"),
}


def _cases() -> list[Any]:
    faults = {
        LabelledSurface: SURFACE_FAULTS,
        Instance: INSTANCE_FAULTS,
        Solution: SOLUTION_FAULTS,
        Plan: PLAN_FAULTS,
        Trajectory: TRAJECTORY_FAULTS,
        TrajectoryVerdict: VERDICT_FAULTS,
        ToolPaths: TOOL_PATHS_FAULTS,
    }
    return [
        pytest.param(kind, *fault, id=f"{kind.__name__}: {name}")
        for kind, named in faults.items()
        for name, fault in named.items()
    ]


@pytest.mark.parametrize(("kind", "change", "field", "message"), _cases())
def test_refused(
    kind: type[Kind], change: Change, field: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "broken.json"
    # NaN and infinities as numbers too large for a double, since JSON has no names for them.
    text = json.dumps(broken(KINDS[kind], change)).replace("NaN", "1e999")
    path.write_text(text.replace("Infinity", "1e999"), encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        kind.read(path)
    error = refusal.value
    assert (error.file, error.field) == (str(path), field)
    assert message in error.message
    assert str(error).startswith(f"{path}: {field}: ")
    assert "\n" not in str(error)


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
