"""Values made in Python: what JSON would normalise is normalised, what it would refuse is refused.

Plans, surfaces and graphs that say the same in another order, or in numbers of numpy, have to
decompose, solve and be judged alike.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from documents import INSTANCE
from hypothesis import given
from hypothesis import strategies as st
from meshes import drawn, surfaces

import cellcolor
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Coverage, Instance, KnownResult, KnownResults, SurfaceReference
from cellcolor.data.plan import Plan
from cellcolor.data.solution import (
    Seam,
)
from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from examples import examples

Disguise = Callable[[Any], Any]


def _ints(numbers: Any) -> Any:
    return np.array(numbers, dtype=np.int32) if len(numbers) else []


DISGUISES: tuple[Disguise, ...] = (tuple, list, _ints)
"""The same integers as Python's and numpy's users have them."""


def as_found_elsewhere(mesh: LabelledSurface, random: Any) -> LabelledSurface:
    """The same surface, with whatever order and types Python allows."""

    def shuffled(numbers: Any) -> Any:
        numbers = list(numbers)
        random.shuffle(numbers)
        return random.choice(DISGUISES)(numbers)

    cracks = [
        Crack(np.int64(max(c.i, c.j)), np.int32(min(c.i, c.j)), shuffled(c.colors))
        for c in mesh.cracks
    ]
    random.shuffle(cracks)
    points: Any = random.choice((np.asarray, np.ndarray.tolist))(mesh.vertices)
    faces: Any = random.choice((np.asarray, np.ndarray.tolist))(mesh.faces)
    return LabelledSurface(
        mesh.name,
        list(mesh.colors),
        points,
        faces.astype(np.uint32) if isinstance(faces, np.ndarray) else faces,
        [shuffled(colors) for colors in mesh.vertex_colors],
        cracks,
        {"seconds": 1, "list": (1, 2)},
    )


@examples(25)
@given(surfaces(), st.randoms(use_true_random=False))
def test_surfaces_and_their_graphs_are_those_of_the_file(
    mesh: LabelledSurface, random: Any
) -> None:
    made = as_found_elsewhere(mesh, random)
    read = LabelledSurface.from_document(json.loads(made.to_json()))
    assert read.to_json() == made.to_json()
    assert read.sha256 == made.sha256 == mesh.sha256
    assert decompose(made) == decompose(read)
    assert decompose(made).cells == decompose(mesh).cells
    plan = Plan([colors[0] if colors else None for colors in read.vertex_colors])
    assert check_plan(made, plan) == check_plan(mesh, plan)


def test_a_crack_given_backwards_is_a_crack() -> None:
    """A corner cut off by cracks: the oracle once said 1 segment, optimal."""
    mesh = drawn("aa aa", {"a": [0]})
    made = LabelledSurface(
        mesh.name,
        mesh.colors,
        mesh.vertices,
        mesh.faces,
        mesh.vertex_colors,
        (Crack(1, 0, (0,)), Crack(2, 0, (0,))),
    )
    read = LabelledSurface.from_document(json.loads(made.to_json()))
    verdict = cellcolor.judge(made, Plan((0, 0, 0, 0)))
    assert verdict == cellcolor.judge(read, Plan((0, 0, 0, 0)))
    assert (verdict.segments, verdict.optimal) == (2, True)


def test_colors_of_vertices_out_of_order_are_one_cell() -> None:
    mesh = drawn("ab ba", {"a": [0, 1], "b": [0, 1]})
    mixed = LabelledSurface(
        "mixed", mesh.colors, mesh.vertices, mesh.faces, ((0, 1), (1, 0), (1, 0), (0, 1))
    )
    assert [cell.colors for cell in decompose(mixed).cells] == [(0, 1)]


def test_graphs_are_those_of_the_file() -> None:
    one, two = np.int64(1), np.int16(2)
    made: Any = Instance(
        "pair",
        ["red", "blue"],
        [
            Cell(np.int8(0), np.array([0]), [[one, two]], np.float32(0.5)),
            Cell(one, [1, 0], [np.array([-1, 3]), (4, -4)]),
        ],
        [
            Edge(one, 0, 1, None, 1.5),
            Edge(two, 0, np.int64(-1)),
            Edge(3, 1, -1),
            Edge(4, 1, 1, [0]),
        ],
        {"source": "by hand"},
        SurfaceReference("pair.surface.json", np.array([0, 1, -1]), "0" * 64),
        KnownResults(KnownResult(one, one), KnownResult(one)),
        Coverage(2, np.float64(0.25), 0.125),
    )
    assert made == Instance.from_document(INSTANCE)
    assert json.loads(made.to_json()) == INSTANCE


REFUSED: dict[str, tuple[Callable[[], object], str, str]] = {
    "cell numbered True": (lambda: Cell(True, (0,), ()), "id", "integer"),
    "color as float": (lambda: Cell(0, (1.0,), ()), "colors[0]", "integer"),
    "colors as text": (lambda: Cell(0, "01", ()), "colors", "array"),
    "colors as a set": (lambda: Cell(0, {0, 1}, ()), "colors", "array"),
    "loop of one number": (lambda: Cell(0, (0,), (1,)), "loops[0]", "array"),
    "cells as documents": (
        lambda: Instance("x", ("red",), ({"id": 0},), ()),
        "cells[0]",
        "Cell",
    ),
    "meta that is no JSON": (lambda: Instance("x", (), (), (), {"a": {1}}), "meta", "JSON"),
    "end of a crack as float": (lambda: Crack(1.0, 2, (0,)), "i", "integer"),
    "share that is not a number": (
        lambda: Coverage(1.0, float("nan"), 0.0),
        "unreachable",
        "finite",
    ),
    "bound as True": (lambda: Bound("cover", True, "surface"), "value", "integer"),
    "seam of no end": (lambda: Seam(5, 0, None, 1, 1), "from_", "integer"),
}


@pytest.mark.parametrize(("make", "field", "message"), REFUSED.values(), ids=REFUSED.keys())
def test_refused(make: Callable[[], object], field: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        make()
    assert refusal.value.field is not None and refusal.value.field.startswith(field)
    assert message in refusal.value.message


@pytest.mark.parametrize(
    ("member", "content", "field"),
    [
        ("vertices", np.zeros((3, 2)), "vertices"),
        ("vertices", [[0, 0, 0], [1, 0, True], [0, 1, 0]], "vertices[1][2]"),
        ("vertices", None, "vertices"),
        ("faces", [[0, 1, 2.0]], "faces[0][2]"),
        ("faces", [[0, 1, 10**30]], "faces"),
        ("faces", "012", "faces"),
        ("vertex_colors", [[0], [0], [0.0]], "vertex_colors[2][0]"),
        ("vertex_colors", [[0], [0], 0], "vertex_colors[2]"),
        ("colors", "red", "colors"),
        ("meta", {"a": float("nan")}, "meta"),
        ("name", 7, "name"),
    ],
)
def test_surface_refused(member: str, content: Any, field: str) -> None:
    members: dict[str, Any] = {
        "name": "triangle",
        "colors": ["red"],
        "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "faces": [[0, 1, 2]],
        "vertex_colors": [[0], [0], [0]],
    }
    LabelledSurface(**members)
    with pytest.raises(InputError) as refusal:
        LabelledSurface(**members | {member: content})
    assert refusal.value.field == field


PLANS = [
    (0, 1, None),
    [0, 1, None],
    np.array([0, 1, 2]),
    np.array([0, 1, None], dtype=object),
    np.ma.masked_array([0, 1, 5], mask=[False, False, True]),
    [np.int64(0), np.uint8(1), None],
    (True, 0),
    [np.bool_(True)],
    np.array([True, False]),
    (0.0, 1.0),
    np.array([0.0, np.nan]),
    ("red", "blue"),
    np.array(["red"]),
    "01",
    {0: 1},
    np.array([[0, 1]]),
    7,
    None,
]


@pytest.mark.parametrize("colors", PLANS, ids=repr)
def test_plans_are_taken_or_refused_as_from_a_file(colors: Any) -> None:
    """Against the file that says the same, where there is one."""
    content = colors.tolist() if isinstance(colors, np.ndarray) else colors
    if isinstance(content, (list, tuple)):
        content = [c.item() if isinstance(c, np.generic) else c for c in content]
    document = {"format": "cellcolor/plan", "version": 1, "vertex_colors": content}

    def outcome(make: Callable[[], Plan]) -> tuple[Any, ...]:
        try:
            return make().vertex_colors, None
        except InputError as error:
            return None, str(error)

    made = outcome(lambda: Plan(colors))
    text = json.dumps(document, allow_nan=True)
    if "NaN" in text:
        assert made[0] is None
    else:
        assert made == outcome(lambda: Plan.from_document(json.loads(text)))
    if made[0] is None:
        assert made[1].startswith("vertex_colors")
