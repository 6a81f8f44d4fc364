"""Distances along the surface, passes and repeated stretches, on surfaces without any robot."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER
from cellcolor.errors import TooLarge
from cellcolor.frontend.parts.surface import Surface
from cellcolor.trajectory_checker.area import counted, in_strips, passes, repeated_stretches
from cellcolor.trajectory_checker.contact import Contact
from cellcolor.trajectory_checker.covered import reach
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fine_mesh import FineMesh, refined
from examples import examples


def strip(heights: list[tuple[float, float]], width: float = 0.06) -> Surface:
    """A profile (x, z) drawn out along y; its outside is on the left of the way."""
    profile = np.array(heights)
    ys = np.linspace(0, width, 7)
    vertices = np.array([[x, y, z] for x, z in profile for y in ys])
    at = np.arange(len(vertices)).reshape(len(profile), len(ys))
    a, b, c, d = (p.ravel() for p in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    along = np.gradient(profile, axis=0)
    normals = np.column_stack([-along[:, 1], np.zeros(len(profile)), along[:, 0]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Surface(vertices, faces, np.repeat(normals, len(ys), axis=0))


FLAT = strip([(x, 0.0) for x in np.linspace(0, 0.1, 11)])
# There and back 1 mm lower, around a narrow end.
SHEET = strip([(x, 0.0) for x in np.linspace(0, 0.1, 11)] + [(0.1, -0.001)]
              + [(x, -0.001) for x in np.linspace(0.09, 0, 10)])  # fmt: skip


def contact_along(
    points: Array, mesh: FineMesh, stroke: Array | None = None, segment: Array | None = None
) -> Contact:
    """The tool at points, one stroke of one segment if nothing else is said."""
    k = len(points)
    none, zero = np.zeros((k, 1)), np.zeros(k, dtype=np.int64)
    down, contact = np.tile([0.0, 0.0, -1.0], (k, 1)), np.ones(k, dtype=bool)
    stroke, segment = (zero if given is None else given for given in (stroke, segment))
    dense = Dense(np.arange(k), np.zeros(k), none, points, down, contact, stroke)
    return Contact(dense, np.arange(k), mesh.locate(points, up(points)), segment, zero)


def along(*corners: tuple[float, float]) -> Array:
    """Points half a millimeter apart from corner to corner, on z = 0."""
    parts = []
    for start, end in pairwise(corners):
        count = int(np.ceil(np.hypot(end[0] - start[0], end[1] - start[1]) / 0.0005))
        parts.append(np.linspace(start, end, count, endpoint=False))
    flat = np.concatenate([*parts, [corners[-1]]])
    return np.column_stack([flat, np.zeros(len(flat))])


def up(points: Array) -> Array:
    return np.tile([0.0, 0.0, 1.0], (len(points), 1))


def fine(surface: Surface) -> FineMesh:
    return refined(surface, 0.0025, NEVER)


@examples(6)
@given(seed=st.integers(0, 10_000))
def test_distances_on_a_plane_are_plain_distances(seed: int) -> None:
    """Never shorter, and by less than a tenth longer; over a whole surface it is one or two %."""
    random = np.random.default_rng(seed)
    points = np.column_stack([random.uniform(0, [0.1, 0.06], (3, 2)), np.zeros(3)])
    mesh = fine(FLAT)
    distance, nearest = reach(mesh, mesh.locate(points, up(points)), 0.03)
    plain = np.linalg.norm(mesh.vertices[:, None] - points, axis=2)
    near = plain.min(axis=1) < 0.027
    assert np.all(distance >= plain.min(axis=1) - 1e-9)
    assert np.all(distance[near] <= 1.09 * plain.min(axis=1)[near] + 3e-4)
    assert np.all(distance[plain.min(axis=1) > 0.03] == np.inf)
    own = nearest >= 0
    of_nearest = plain[own, nearest[own]]
    assert np.all(of_nearest <= distance[own] + 1e-9)


def test_the_back_of_a_sheet_is_far_from_its_front() -> None:
    mesh = fine(SHEET)
    points = along((0.03, 0.0), (0.03, 0.06))
    distance, _ = reach(mesh, mesh.locate(points, up(points)), 0.015)
    back = mesh.vertices[:, 2] < -0.0005
    assert np.all(np.isinf(distance[back]))
    front = ~back & (np.abs(mesh.vertices[:, 0] - 0.03) < 0.013)
    assert np.all(distance[front] < 0.015)
    # Around the end it is as near as the way is long.
    points = along((0.095, 0.0), (0.095, 0.06))
    distance, _ = reach(mesh, mesh.locate(points, up(points)), 0.015)
    x, below = mesh.vertices[:, 0], mesh.vertices[:, 2] == -0.001
    way = 0.005 + 0.001 + (0.1 - x)
    assert np.all(np.isfinite(distance[below & (way < 0.0145)]))
    # Two edges are taken for one straight way, across the rim as well.
    assert np.all(np.isinf(distance[below & (way > 0.017)]))
    visits = passes(contact_along(points, mesh), mesh, 0.005).sum(axis=1)
    assert not visits[below & (x < 0.097)].any()


def visits_on_flat(points: Array, strokes: Array | None = None) -> tuple[Array, Array]:
    mesh = fine(FLAT)
    visits = passes(contact_along(points, mesh, strokes), mesh, 0.005)
    return mesh.vertices, visits.sum(axis=1)


def test_passes_are_counted() -> None:
    """Two lines 10 mm apart, joined at one end: each place beside a line is visited once."""
    line = along((0.02, 0.01), (0.02, 0.05), (0.03, 0.05), (0.03, 0.01))
    vertices, visits = visits_on_flat(line)
    x, y = vertices[:, 0], vertices[:, 1]
    inside = (y > 0.012) & (y < 0.04)
    assert set(visits[inside & (np.abs(x - 0.02) < 0.0048)]) == {1}
    assert set(visits[inside & (np.abs(x - 0.03) < 0.0048)]) == {1}
    assert set(visits[(x < 0.0149) | (x > 0.0351)]) == {0}
    # Around the turn it is one pass all along.
    assert set(visits[(np.abs(x - 0.025) < 0.004) & (np.abs(y - 0.049) < 0.002)]) == {1}


@examples(12)
@given(
    begin=st.floats(0.0, 0.02),
    length=st.floats(0.03, 0.06),
    off=st.sampled_from([0.0, 0.002, 0.003]),
)
def test_repeated_stretches(begin: float, length: float, off: float) -> None:
    """A second stroke beside a part of the first one, nearer than 2.5 mm or not."""
    first = along((0.0, 0.03), (0.1, 0.03))
    second = along((begin + length, 0.03 + off), (begin, 0.03 + off))
    points = np.concatenate([first, second])
    stroke = np.repeat([0, 1], [len(first), len(second)])
    none = np.full(len(points), -1)
    found = repeated_stretches(contact_along(points, fine(FLAT), stroke), none, 0.0025, 0.02)
    if off > 0.0025:
        assert not len(found)
        return
    ((one, other, earlier_one, earlier_other),) = found.tolist()
    assert (one, other) == (len(first), len(points) - 1)
    assert points[earlier_one, 0] == pytest.approx(begin + length, abs=0.003)
    assert points[earlier_other, 0] == pytest.approx(begin, abs=0.003)


def test_crossing_an_earlier_pass_is_no_repetition() -> None:
    points = along((0.0, 0.03), (0.1, 0.03), (0.1, 0.05), (0.05, 0.05), (0.05, 0.0))
    none = np.full(len(points), -1)
    assert not len(repeated_stretches(contact_along(points, fine(FLAT)), none, 0.0025, 0.02))


@examples(20)
@given(border=st.floats(0.03, 0.06), overlap=st.floats(0.004, 0.03), twice=st.booleans())
def test_segments_may_overlap_in_a_strip_beside_what_is_theirs_alone(
    border: float, overlap: float, twice: bool
) -> None:
    """Lines 10 mm apart on both sides of a border, or by the second segment everywhere."""
    mesh, spacing = fine(FLAT), 0.01
    left = np.arange(border + overlap / 2, 0.0, -spacing)
    right = np.arange(0.0013 if twice else border - overlap / 2, 0.1, spacing)
    lines = [along((x, 0.0), (x, 0.06)) for x in (*left, *right)]
    points, segment = np.concatenate(lines), np.repeat([0, 1], [len(left), len(right)])
    stroke = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    segment = segment[stroke]
    contact = contact_along(points, mesh, stroke, segment)
    visits = passes(contact, mesh, spacing / 2)
    in_strip = in_strips(mesh, visits, overlap + 1.25 * spacing)
    found, x = counted(mesh, visits, in_strip), mesh.vertices[:, 0]
    within = np.abs(mesh.vertices[:, 1] - 0.03) < 0.02

    def by(places: np.ndarray) -> np.ndarray:
        return (np.abs(x[:, None] - places) <= spacing / 2).sum(axis=1)

    shared = (by(left) > 0) & (by(right) > 0)
    single, double = np.maximum(by(left), by(right)), by(left) + by(right)
    # Where both come everywhere, the first has nothing alone, so all of it counts twice.
    wanted = np.where(shared & twice, double, single)
    sure = within & (np.abs(np.abs(x[:, None] - [*left, *right]) - spacing / 2) > 1e-3).all(axis=1)
    assert np.array_equal(found[sure], wanted[sure])
    strip = np.where(in_strip(contact.at.points, segment), segment, -1)
    assert (strip[segment == 0] == (-1 if twice else 0)).all()
    if not twice:
        assert not len(repeated_stretches(contact, strip, 0.0025, 0.02))


def test_what_stays_in_one_place_is_refused() -> None:
    """Ten thousand places of contact in one square millimeter are a hundred million pairs."""
    random = np.random.default_rng(0)
    points = np.column_stack([random.uniform(0.05, 0.051, (10_000, 2)), np.zeros(10_000)])
    contact, none = contact_along(points, fine(FLAT)), np.full(len(points), -1)
    with pytest.raises(TooLarge, match="too often to be measured"):
        repeated_stretches(contact, none, 0.0025, 0.02)
