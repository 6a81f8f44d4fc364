"""What each format forbids is refused by file and field."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from documents import KINDS, Change, broken, drop, put

from cellcolor.data import value
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.errors import InputError

FAULTS: dict[type[value.Document], list[tuple[Change, str, str]]] = {
    LabelledSurface: [
        (
            lambda d: (
                d["vertices"].append([0, 0, 1]),
                d["vertex_colors"].append([]),
                d["faces"].append([2, 0, 4]),
            ),
            "faces[2]",
            "not manifold",
        ),
        (put("faces", 1, to=[0, 3, 2]), "faces[1]", "winds the other way"),
        (
            lambda d: (
                d["vertices"].extend([[-1, 0, 0], [-1, -1, 0]]),
                d["vertex_colors"].extend([[], []]),
                d["faces"].append([0, 4, 5]),
            ),
            "vertices[0]",
            "pinched",
        ),
        (put("faces", 0, to=[0, 1, 1]), "faces[0]", "repeats a vertex"),
        (
            lambda d: (d["vertices"].append([5, 5, 5]), d["vertex_colors"].append([])),
            "vertices[4]",
            "belongs to no face",
        ),
        (put("faces", 1, 2, to=9), "faces[1][2]", "no vertex 9"),
        (put("faces", 1, 2, to=-1), "faces[1][2]", "no vertex -1"),
        (put("faces", to=[]), "faces", "empty"),
        (put("vertices", 1, to=[1, 0]), "vertices[1][2]", ""),
        (put("vertices", 1, 2, to=float("nan")), "vertices[1][2]", "finite"),
        (put("vertices", 1, 2, to=float("inf")), "vertices[1][2]", "finite"),
        (put("vertices", 2, 1, to=-1e308), "vertices[2][1]", "beyond 1e+09 m"),
        (put("colors", to=["a", "a"]), "colors[1]", "the name of color 0"),
        (put("vertices", 1, 2, to="0"), "vertices[1][2]", "number"),
        (put("faces", 0, 0, to=0.5), "faces[0][0]", "integer"),
        (put("vertex_colors", 2, to=[2]), "vertex_colors[2]", "unknown color 2"),
        (put("vertex_colors", 2, to=[0, 0]), "vertex_colors[2]", "twice"),
        (drop("vertex_colors", 3), "vertex_colors", "3 entries for 4"),
        (put("cracks", 0, to=[1, 3, [0]]), "cracks[0]", "not an edge"),
        (put("cracks", to=[[0, 2, [0]], [2, 0, [1]]]), "cracks[1]", "already"),
        (put("cracks", 0, to=[0, 2, [7]]), "cracks[0]", "unknown color 7"),
        (
            lambda d: (put("vertex_colors", 0, to=[0])(d), put("cracks", 0, 2, to=[1])(d)),
            "cracks[0]",
            "not shared",
        ),
        (put("cracks", 0, to=[0, 2, []]), "cracks[0]", "at least one color"),
        (put("cracks", 0, to=[0, 2, [1, 1]]), "cracks[0]", "each once"),
        (put("given_up", to=[4]), "given_up[0]", "no vertex 4"),
        (put("given_up", to=[2, 3]), "given_up[0]", "has colors"),
        (put("given_up", to=[3, 3]), "given_up[1]", "twice"),
        (drop("name"), "name", "is missing"),
    ],
    Instance: [
        (put("cells", 0, "loops", to=[[1, 2, 1]]), "cells[0].loops[0][2]", "twice"),
        (
            put("cells", 1, "loops", to=[[-1, 3, 2], [4, -4]]),
            "cells[1].loops[0][2]",
            "does not close",
        ),
        (put("cells", 0, "loops", to=[[1]]), "edges[1]", "dart 2 is missing"),
        (put("cells", 1, "loops", to=[[-1, 3], [4]]), "edges[3]", "dart -4 is missing"),
        (put("cells", 0, "loops", to=[[1, -2]]), "cells[0].loops[0][1]", "close"),
        (put("cells", 0, "loops", to=[[1, 9]]), "cells[0].loops[0][1]", "no edge"),
        (put("cells", 0, "loops", to=[[1, 0]]), "cells[0].loops[0][1]", "no edge"),
        (put("cells", 0, "loops", to=[[1, 2], []]), "cells[0].loops[1]", "without darts"),
        (put("edges", 1, "left", to=-1), "edges[1]", "-1 on both sides"),
        (put("edges", 1, "left", to=7), "edges[1].left", "no cell 7"),
        (put("edges", 1, "right", to=-2), "edges[1].right", "no cell -2"),
        (put("edges", 1, "id", to=1), "edges[1].id", "twice"),
        (put("edges", 1, "id", to=0), "edges[1].id", "positive"),
        (put("cells", 1, "id", to=2), "cells[1].id", "0, 1, 2"),
        (put("cells", 0, "colors", to=[]), "cells[0].colors", "no color"),
        (put("colors", to=["a", "a"]), "colors[1]", "the name of color 0"),
        (put("cells", 0, "colors", to=[5]), "cells[0].colors", "unknown color 5"),
        (put("cells", 1, "colors", to=[0, 0]), "cells[1].colors", "twice"),
        (put("edges", 0, "colors", to=[1]), "edges[0].colors", "not shared"),
        (put("edges", 1, "colors", to=[0]), "edges[1].colors", "not shared"),
        (put("cells", 0, "area", to=-1.0), "cells[0].area", "greater"),
        (put("edges", 0, "length", to=float("inf")), "edges[0].length", "finite"),
        (put("cells", 0, "colour", to=1), "cells[0].colour", ""),
        (put("edges", 0, "darts", to=1), "edges[0].darts", ""),
        (put("surface", "vertex_cell", 1, to=2), "surface.vertex_cell[1]", "no cell 2"),
        (put("coverage", "given_up", to=0.8), "coverage", "more than the whole"),
        (put("coverage", "unreachable", to=1.5), "coverage.unreachable", "less"),
        (put("known", "else", to={"segments": 1}), "known.else", ""),
        (put("known", "paper", to={}), "known.paper.segments", "is missing"),
        (drop("cells"), "cells", "is missing"),
        (put("edges", 0, "id", to="1"), "edges[0].id", "integer"),
        (put("edges", 0, "id", to=True), "edges[0].id", "integer"),
    ],
    Solution: [
        (put("status", to="unknown"), "status", "null"),
        (put("segments", to=None), "segments", "must not be null"),
        (put("cells", to=None), "cells", "must not be null"),
        (put("lift_offs", to=None), "lift_offs", "must not be null"),
        (put("status", to="best"), "status", "optimal"),
        (put("search_space", to="both"), "search_space", "paper"),
        (put("segments", to=-1), "segments", "greater"),
        (put("strands", to=0), "strands", "greater"),
        (drop("instance"), "instance", "is missing"),
        (put("bounds", 0, "holds_for", to="all"), "bounds[0].holds_for", "surface"),
        (put("bounds", 0, "value", to=-1), "bounds[0].value", "greater"),
        (put("bounds", 0, "proof", to=1), "bounds[0].proof", ""),
        (put("notes", 0, to=1), "notes[0]", "string"),
        (drop("surface_lower_bound"), "surface_lower_bound", "is missing"),
        (
            put("cells", 0, "subcells", 0, "color", to="red"),
            "cells[0].subcells[0].color",
            "integer",
        ),
    ],
    Plan: [
        (put("vertex_colors", 1, to="red"), "vertex_colors[1]", "integer"),
        (put("vertex_colors", 1, to=True), "vertex_colors[1]", "integer"),
        (drop("vertex_colors"), "vertex_colors", "is missing"),
    ],
    Trajectory: [
        (put("joints", 1, to=[0.5]), "joints", "rows of numbers"),
        (put("joint_names", to=["pan"]), "joints", "needs 1 numbers"),
        (put("times", to=[0.0, 1.0]), "joints", "has 3 entries for 2 times"),
        (put("times", 1, to=float("inf")), "times[1]", "number"),
        (put("points", 0, to=[0.0, 0.0]), "points[0][2]", "is missing"),
        (put("contact", 0, to=1), "contact[0]", "boolean"),
        (put("segment", 0, to=0.5), "segment[0]", "integer"),
        (put("unplanned", 0, to="1"), "unplanned[0]", "integer"),
        (drop("left_out", 0, "reason"), "left_out[0].reason", "is missing"),
        (put("extra_lift_offs", 0, "why", to=""), "extra_lift_offs[0].why", "unknown key"),
    ],
    TrajectoryVerdict: [
        (put("valid", to=True), "valid", "something else"),
        (put("faults", 0, "kind", to="ugly"), "faults[0].kind", "Input should be"),
        (put("strokes", to=-1), "strokes", "greater than or equal to 0"),
    ],
    ToolPaths: [
        (put("paths", 0, "points", to=[[0, 0, 0]]), "paths[0].points", "two points"),
        (put("paths", 0, "points", to=[]), "paths[0].points", "at least two points"),
        (put("paths", 0, "normals", to=[[0, 0, 1]]), "paths[0].normals", "1 entries for 3"),
        (put("paths", 0, "faces", to=[0]), "paths[0].faces", "1 entries for 2 steps"),
        (put("paths", 0, "points", to=[["a", 0, 0]]), "paths[0].points[0][0]", "number"),
        (put("paths", 0, "color", to=1.0), "paths[0].color", "integer"),
    ],
}
"""Of each format what is changed in a valid file, the member at fault, and what is said of it."""


@pytest.mark.parametrize(
    ("kind", "change", "field", "message"),
    [
        pytest.param(kind, *fault, id=f"{kind.__name__}: {fault[1]}: {fault[2]}")
        for kind, faults in FAULTS.items()
        for fault in faults
    ],
)
def test_refused(
    kind: type[value.Document], change: Change, field: str, message: str, tmp_path: Path
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
