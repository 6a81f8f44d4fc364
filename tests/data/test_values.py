"""Values compare, hash, pickle and print, whatever they hold."""

from __future__ import annotations

import copy
import json
import pickle
import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from documents import INSTANCE, PLAN, SOLUTION, SURFACE, TOOL_PATHS
from hypothesis import given
from library import INSTANCES
from meshes import surfaces

from cellcolor.data.bounds import KINDS, Bound
from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Coverage, Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import ModelSize, Solution
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.value import Integers, Numbers, RowsOfThree, Truths, Value
from cellcolor.errors import BeatenBound, InputError
from cellcolor.oracle import ProvenRange, Verdict
from examples import examples

PATHS = ToolPaths.from_document(TOOL_PATHS)
VALUES: list[Any] = [
    LabelledSurface.from_document(SURFACE),
    Instance.from_document(INSTANCE | {"meta": {"free": [1, {"deep": None}]}}),
    Solution.from_document(SOLUTION),
    replace(Solution.from_document(SOLUTION), bounds=(Bound("own", 1, "surface", {"a": [1]}),)),
    Plan.from_document(PLAN),
    PATHS,
    PATHS.paths[0],
    Cell(0, (1, 0), ((1, -2),), 0.5),
    Edge(3, OUTSIDE, 0),
    Crack(5, 4, (1,)),
    Coverage(0.5, 0.25, 0.0),
    ProvenRange(2, 4),
    Verdict((), 3, ProvenRange(2, 4)),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_a_copy_is_equal_and_hashes_alike(value: Any) -> None:
    for other in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value)):
        assert other == value
        assert value.__hash__ is None or hash(other) == hash(value)
        assert str(other) == str(value)
        assert repr(other) == repr(value)
    for stranger in (None, 1, "text", *VALUES):
        assert (value == stranger) is (value is stranger)


@given(surfaces())
@examples(20)
def test_surfaces_are_equal_where_all_members_are(surface: LabelledSurface) -> None:
    """Surfaces that differ anywhere are not equal, and no comparison raises."""
    _ = surface.sha256  # a cached property is no member
    same = LabelledSurface.from_document(json.loads(surface.to_json()))
    assert surface == same and hash(surface) == hash(same)
    moved = surface.vertices.copy()
    moved[0, 2] += 1.0
    others = [
        replace(surface, vertices=moved),
        replace(surface, name=surface.name + "'"),
        replace(surface, faces=surface.faces[:, [0, 2, 1]]),
        replace(surface, meta={"another": True}),
    ]
    assert all(other != surface for other in others)


@pytest.mark.parametrize(
    "error",
    [InputError("file", "field", "message"), InputError(None, None, "m"), BeatenBound("x", 1, 2)],
    ids=str,
)
def test_errors_pickle(error: Exception) -> None:
    """A process pool hands them over this way."""
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)


def test_nothing_dumps_its_content() -> None:
    """A representation is a line, however large the value is."""
    surface = LabelledSurface.read(INSTANCES / "scenes" / "wok.surface.json")
    instance = Instance.read(INSTANCES / "scenes" / "wok.json")
    plan = Plan([next(iter(colors), None) for colors in surface.vertex_colors])
    for value in (surface, instance, plan, Solution.from_document(SOLUTION)):
        assert len(repr(value)) < 200 and "\n" not in repr(value)
        assert type(value).__name__ in repr(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (ProvenRange(2, 2), "exactly 2 segments"),
        (ProvenRange(2, 4), "between 2 and 4 segments"),
        (
            Verdict((), 2, ProvenRange(2, 2)),
            "2 segments, 1 lift-off, optimal: no division of the surface has fewer",
        ),
        (
            Verdict((), 5, ProvenRange(2, 3)),
            "5 segments, 4 lift-offs, 2 fewer are proved to be enough",
        ),
        (
            Verdict((), 3, ProvenRange(2, 4)),
            "3 segments, 2 lift-offs, not known to be optimal; "
            "the fewest are between 2 and 4 segments",
        ),
        (Verdict(("a: b", "c: d"), None, None), "not valid: a: b (and 1 other problem)"),
        (Cell(0, (1, 0), ((1, -2),)), "cell 0: colors 0 and 1, 2 darts on 1 loop"),
        (Cell(0, (4,), ((1,), (-2,)), 0.5), "cell 0: color 4, 2 darts on 2 loops, 0.5 m²"),
        (Edge(3, OUTSIDE, 0), "edge 3: the outside on its left, cell 0 on its right"),
        (
            Edge(3, 1, 0, (), 0.25),
            "edge 3: cell 1 on its left, cell 0 on its right, joinable colors: none, 0.25 m",
        ),
        (Crack(5, 4, (1, 0, 2)), "crack between vertices 4 and 5: colors 0, 1 and 2"),
        (
            Coverage(0.5, 0.25, 0.05),
            "70.0 % of 0.5 m² can be covered, 25.0 % is unreachable, 5.0 % given up",
        ),
        (PATHS.paths[0], "tool path on segment 0: 0.700 m, 3 points"),
        (PATHS, "triangle: 1 tool path, contour, 0.70 m"),
        (Plan((0, None, 2)), "plan for 3 vertices, 2 of them painted, in 2 colors"),
    ],
    ids=str,
)
def test_values_say_what_they_are(value: object, text: str) -> None:
    assert str(value) == text


def solved(status: str, segments: int | None, bound: int, surface_bound: int, **more: Any) -> Any:
    """A solution in the search space paper with these numbers; without a division for None."""
    return replace(
        Solution.from_document(SOLUTION),
        search_space="paper",
        strands=1,
        status=status,
        segments=segments,
        lift_offs=None if segments is None else segments - 1,
        lower_bound=bound,
        surface_lower_bound=surface_bound,
        proved_for_surface=segments == surface_bound,
        **{"bounds": None} | more | ({"cells": None} if segments is None else {}),
    )


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        (
            ("optimal", 2, 2, 2),
            "2 segments, 1 lift-off, optimal: proved for any division of the surface",
        ),
        (
            ("optimal", 2, 2, 1),
            "2 segments, 1 lift-off, optimal in the search space paper; "
            "any division of the surface has at least 1",
        ),
        (
            ("feasible", 2, 1, 1),
            "2 segments, 1 lift-off, not proved to be the fewest: at least 1 in the search "
            "space paper; any division of the surface has at least 1",
        ),
        (("unknown", None, 1, 1), "no division found; at least 1 segment"),
    ],
    ids=["proved", "paper", "feasible", "unknown"],
)
def test_a_solution_says_no_more_than_is_proved(numbers: tuple[Any, ...], text: str) -> None:
    assert str(solved(*numbers)) == text


@pytest.mark.parametrize(
    ("kind", "by"),
    [
        ("model", ", by the complete model (4,320 variables, 25,093 constraints)"),
        ("exact", ", by a recursion over the graph"),
        ("search", ", by exhaustive search"),
        ("of somebody else", ""),
    ],
)
def test_what_proves_a_minimum_of_the_search_space_alone(kind: str, by: str) -> None:
    bounds = (Bound("cover", 1, "surface"), Bound(kind, 2, "strands"))
    size = ModelSize(4320, 25093)
    found = solved("optimal", 2, 2, 1, bounds=bounds, model=size)
    space = f"optimal in the search space paper{by}; any division of the surface has at least 1"
    assert str(found) == f"2 segments, 1 lift-off, {space}"
    assert found.why_not_fewer() is None
    wide = solved("optimal", 2, 2, 2, bounds=(Bound("crossings", 2, "surface"),), model=size)
    reason = wide.why_not_fewer()
    assert reason is not None and "model (4,320 variables, 25,093 constraints) has" in reason
    assert wide.proved_by is None


def test_every_kind_of_bound_for_the_surface_has_its_reason() -> None:
    """Those that the page on solutions lists; a kind that is not known gives no reason."""
    page = (INSTANCES.parent / "docs" / "formats" / "solutions.md").read_text("utf-8")
    listed = dict(re.findall(r"^  - `(\w+)`: (.*(?:\n    .*)*)", page, re.MULTILINE))
    assert set(listed) == set(KINDS)
    assert all(kind.objective for kind in KINDS.values())
    for_strands = {kind for kind, told in listed.items() if re.search(r"these\s+strands", told)}
    assert for_strands == {"model", "search"}
    told = {kind for kind, own in KINDS.items() if own.by}
    assert told == for_strands | {"exact"}
    found = solved("optimal", 2, 2, 2)
    for kind in KINDS.keys() - for_strands:
        bounds = (Bound("other", 1, "surface"), Bound(kind, 2, "surface"))
        assert ", because " in str(replace(found, bounds=bounds))
    assert "because" not in str(replace(found, bounds=(Bound("own", 2, "surface"),)))
    assert "because" not in str(replace(found, bounds=(Bound("model", 2, "strands"),)))


@dataclass(frozen=True, eq=False)
class Arrays(Value):
    rows: RowsOfThree
    numbers: Numbers
    integers: Integers
    truths: Truths


WHOLE: dict[str, Any] = {
    "rows": [[1, 2, 3]],
    "numbers": [1, 2.5],
    "integers": [1],
    "truths": [True],
}


def test_lists_and_arrays_become_copies_of_one_kind() -> None:
    given = np.array([[1, 2, 3]])
    made = Arrays(**WHOLE | {"rows": given})
    given[:] = 0
    arrays = [made.rows, made.numbers, made.integers, made.truths]
    assert [array.tolist() for array in arrays] == list(WHOLE.values())
    assert [array.dtype for array in arrays] == [float, float, int, bool]
    assert not any(array.flags.writeable for array in arrays)


@pytest.mark.parametrize(
    ("member", "content", "complaint"),
    [
        ("rows", [[1, 2]], r"rows\[0\]\[2\]: is missing"),
        ("rows", np.ones((1, 2)), "rows: each entry needs 3 numbers"),
        ("rows", np.ones(3), "rows: must be rows"),
        ("rows", [[1, 2, 3], [1, 2]], r"rows\[1\]\[2\]: is missing"),
        ("rows", [[1, 2, float("nan")]], r"rows\[0\]\[2\]: is not a finite number"),
        ("rows", [["a", "b", "c"]], r"rows\[0\]\[0\]: .* a valid number"),
        ("rows", np.array([["a", "b", "c"]]), "rows: must be numbers"),
        ("rows", [[True, True, True]], r"rows\[0\]\[0\]: .* a valid number"),
        ("numbers", np.ones((1, 1)), "numbers: must be one row"),
        ("numbers", [0.0, float("inf")], r"numbers\[1\]: is not a finite number"),
        ("integers", [1.0], r"integers\[0\]: .* a valid integer"),
        ("integers", np.ones(1), "integers: must be integers"),
        ("truths", [1], r"truths\[0\]: .* a valid boolean"),
    ],
)
def test_anything_else_is_refused_by_name(member: str, content: Any, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        Arrays(**WHOLE | {member: content})
