"""What steps of the front end take beside what they return, held against what they may take."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Iterator
from functools import cache, partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from shipped import shipped

from cellcolor import memory
from cellcolor.deadline import NEVER
from cellcolor.errors import TooLarge
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.calibrated import missing
from cellcolor.frontend.arm.newton import polished
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach.between import remains_valid
from cellcolor.frontend.reach.continuity import link
from cellcolor.frontend.reach.tracking import Tracker
from cellcolor.trajectory_checker.dense import poses_of
from cellcolor.trajectory_checker.fine_mesh import refined
from cellcolor.trajectory_checker.repeated import _near

pytestmark = pytest.mark.second

SMALL = 4_000_000  # bytes, for parts of 300 configurations, so that little work has many

Step = Callable[[], object]


@cache
def prepared(arm: str) -> PreparedScene:
    return prepare(shipped(f"../arms/{arm}"))


@cache
def solutions(arm: str, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, directions and all solutions there: those of the vertices again and again."""
    scene = prepared(arm)
    rows = np.arange(count) % len(scene.surface.vertices)
    points, directions = scene.surface.vertices[rows], -scene.surface.normals[rows]
    return points, directions, scene.arm.inverse(points, directions)


def temporary(step: Step) -> int:
    """What numpy holds at one time, beside what was there before and what is there after."""
    tracemalloc.start()
    try:
        result = step()
        kept, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert result is not None
    return peak - kept


def of_arm(arm: str) -> Iterator[tuple[str, Step]]:
    scene = prepared(arm)
    count = 500 if arm == "ur5e_calibrated_wok" else 6_000
    points, directions, found = solutions(arm, count)
    some = found[~np.isnan(found[:, :, 0])][:count]
    at = len(some)
    yield "inverse", lambda: scene.arm.inverse(points, directions)
    first = np.zeros(len(points), dtype=np.intp)
    yield "follow", lambda: scene.arm.follow(points, directions, first)
    yield (
        "polished",
        lambda: polished(scene.robot, some[:, None] + 1e-3, points[:at], directions[:at], 1.0),
    )
    yield "missing", lambda: missing(scene.robot, found)
    yield "judge", lambda: scene.judge(some)
    yield "described", lambda: Tracker(scene.robot, scene.arm.measure).described(found)
    yield "poses", lambda: poses_of(scene.robot, some, NEVER)


ARMS = ("ur5e_wok", "ur5e_calibrated_wok", pytest.param("kr6_wok", marks=pytest.mark.slow))
OF_ARM = ("inverse", "follow", "polished", "missing", "judge", "described", "poses")


@pytest.mark.parametrize("step", OF_ARM)
@pytest.mark.parametrize("arm", ARMS)
def test_steps_with_configurations(arm: str, step: str, monkeypatch: pytest.MonkeyPatch) -> None:
    work = dict(of_arm(arm))[step]
    whole = work()
    monkeypatch.setattr(memory, "CHUNK", 300)
    # What solves a calibrated arm works in parts within the parts of who asks.
    deep = 2 if step in ("inverse", "follow") else 1
    assert temporary(work) <= deep * SMALL
    if isinstance(whole, np.ndarray):
        assert np.array_equal(np.asarray(work()), whole, equal_nan=True)


def located() -> object:
    scene = prepared("ur5e_wok")
    fine = refined(scene.surface, 0.01, NEVER)
    fine._tree, fine._facing, fine._radius  # noqa: B018  # these are kept
    return partial(fine.locate, fine.vertices, -scene.surface.normals[[0] * len(fine.vertices)])


def near() -> object:
    points = np.random.default_rng(0).uniform(0, 1, (3_000, 3))
    tree = cKDTree(points)
    return [len(one) for one, _ in _near(tree, points, 0.3)]


def test_steps_with_faces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "CHUNK", 300)
    locate = located()
    assert callable(locate)
    # Of all points together it keeps numbers of triangles, weights, places and normals.
    points = len(locate.args[0])  # type: ignore[attr-defined]
    assert temporary(locate) <= SMALL + 512 * points
    assert temporary(near) <= SMALL


def test_points_between_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where few edges are cut into many pieces, and where pieces are cut again."""
    monkeypatch.setattr(memory, "CHUNK", 300)
    surface = prepared("ur5e_wok").surface
    edges = surface.edges()[:50]
    ends = np.tile(1.5 * surface.vertices[:, None], (16, 1, 1, 1))
    largest = 0

    def test(points: np.ndarray, _: object, __: object) -> tuple[np.ndarray, np.ndarray]:
        nonlocal largest
        largest = max(largest, len(points))
        return np.ones(len(points), dtype=bool), np.tile(points, (16, 1, 1)) * 1.5

    def step() -> object:
        branches, pieces = np.zeros(len(edges), dtype=np.intp), np.full(len(edges), 200)
        return remains_valid(surface, edges, branches, pieces, ends, np.full(16, 1e-4), test)

    assert temporary(step) <= SMALL and 200 < largest <= 300


def test_links(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = prepared("ur5e_wok")
    surface, count = scene.surface, len(scene.surface.vertices)
    candidates = scene.judge(solutions("ur5e_wok", count)[2])
    edges = surface.edges()
    step = partial(link, surface, edges, candidates, scene.arm.measure, None, probe=scene.arm.probe)
    whole = step()
    monkeypatch.setattr(memory, "CHUNK", 300)
    # Who calls gives so many edges as fit; here are all, whose ends and motions stay beside.
    ends = 8 * len(edges) * 256 * 7
    assert temporary(step) <= ends + 3 * SMALL
    assert (step() == whole).all()


@given(st.lists(st.integers(0, 50), max_size=60), st.integers(1, 90))
def test_batches_are_whole_and_fit(sizes: list[int], most: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(memory, "CHUNK", most)
        parts = list(memory.batches(np.array(sizes, dtype=np.int64)))
        rows = list(memory.chunks(len(sizes)))
    for found in (parts, rows):
        assert [k for part in found for k in range(part.start, part.stop)] == list(
            range(len(sizes))
        )
    assert all(part.stop - part.start <= most for part in rows)
    for part in parts:
        assert part.stop - part.start == 1 or sum(sizes[part]) <= most


def test_more_than_the_machine_has_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "machine_memory", lambda: 10_000_000)
    with pytest.raises(
        TooLarge, match=r"judging 100,000 configurations of the arm would take 0.0 GB"
    ):
        prepared("ur5e_wok").judge(np.full((100_000, 6), np.nan))
    with pytest.raises(TooLarge, match="on one mesh edge would take"):
        surface = prepared("ur5e_wok").surface
        edges, one = surface.edges()[:1], np.zeros(1, dtype=np.intp)
        ends = surface.vertices[None, :, None]
        remains_valid(
            surface, edges, one, np.array([10**6]), ends, np.ones(1), lambda *_: pytest.fail()
        )
    with pytest.raises(TooLarge, match="passes the same place too often"):
        points = np.zeros((400, 3))
        next(_near(cKDTree(points), points, 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("arm", ["ur5e_wok", "kr6_wok"])
def test_a_whole_build(arm: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside what is kept for each vertex, no more than the steps that call each other may take."""
    scene = prepared(arm).scene.varied(object={"target_vertices": 1_000})
    monkeypatch.setattr(memory, "CHUNK", 300)
    vertices = 1_000
    slots, joints, points = 8, 6, len(prepared(arm).judge.tracked_steps)
    # Of a solution: joints twice, determinant, reason, color, bodies; three edges a vertex, each
    # with a link and its copies.
    solution = 2 * 8 * joints + 8 + 1 + 8 + 24 * points
    of_vertex = slots * (solution + 3 * 4 * 8) + 2_048  # the mesh, and its lists of colors
    # An edge's links, points on them, solving, Newton's method.
    assert temporary(lambda: build_surface(scene)) <= 2 * vertices * of_vertex + 4 * SMALL
