"""Joint solutions without a robot become colors and cracks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES
from shipped import SCENES
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.arrays import Array, Index
from cellcolor.configurations.labelling import from_configurations
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from examples import examples

CIRCLE = 2 * np.pi


def plate(columns: int, rows: int, side: float = 0.02) -> tuple[Array, Index]:
    """A flat grid of triangles, its lower left corner at the origin."""
    vertices = [(side * x, side * y, 0.0) for y in range(rows) for x in range(columns)]
    faces = []
    for low in (y * columns + x for y in range(rows - 1) for x in range(columns - 1)):
        faces += [(low, low + 1, low + columns + 1), (low, low + columns + 1, low + columns)]
    return np.array(vertices), np.array(faces)


def shuffled(configurations: Sequence[Array], seed: int) -> tuple[list[Array], list[Index]]:
    """In another order at each vertex, turned by full circles; and where each one was."""
    rng = np.random.default_rng(seed)
    order = [rng.permutation(len(own)) for own in configurations]
    turned = [
        own[place] + CIRCLE * rng.integers(-1, 2, (len(place), *own.shape[1:]))
        for own, place in zip(configurations, order, strict=True)
    ]
    return turned, order


@pytest.mark.parametrize(
    "name",
    ["wok", "wok_obstacle", "square", "half_pipe", "hemisphere_flat", "hemisphere_tilted"],
)
def test_a_scene_without_its_robot_has_the_same_minimum(name: str) -> None:
    """Its valid configurations in any order, turned by full circles, and without names."""
    surface = LabelledSurface.read(SCENES / f"{name}.surface.json")
    table = CandidateTable.read(SCENES / f"{name}.reasons.npz")
    own = [
        solutions[colors >= 0]
        for solutions, colors in zip(table.configurations, table.node_color, strict=True)
    ]
    found = from_configurations(
        surface.vertices, surface.faces, shuffled(own, 1)[0], conflicts="cut", reach_m=0.85
    )
    assert found.doubtful_share < 0.05
    ours, theirs = (cellcolor.solve(each).solution for each in (found.surface, surface))
    assert ours.status == theirs.status == "optimal"
    assert ours.segments == theirs.segments


@pytest.mark.slow
@pytest.mark.parametrize(
    "path",
    [
        path
        for folder in ("arms", "parts")
        for path in sorted((INSTANCES / folder).glob("*.toml"))
        # A tenth of the bracket's edges is doubtful: that is a question of its mesh.
        if path.stem not in ("bracket", "torus_refused")
    ],
    ids=lambda path: path.stem,
)
def test_built_scenes_without_their_robots_have_the_same_minima(path: Path) -> None:
    built = cellcolor.build(path)
    pairs = zip(built.configurations, built.node_color, strict=True)
    own = [solutions[colors >= 0] for solutions, colors in pairs]
    surface = built.surface
    found = from_configurations(
        surface.vertices, surface.faces, shuffled(own, 1)[0], conflicts="cut"
    )
    ours, theirs = (cellcolor.solve(each).solution for each in (found.surface, surface))
    assert (ours.status, ours.segments) == (theirs.status, theirs.segments)


@examples(40)
@given(
    seed=st.integers(0, 10**6),
    columns=st.integers(2, 5),
    rows=st.integers(2, 4),
    branches=st.integers(1, 3),
)
def test_planted_branches_are_found(seed: int, columns: int, rows: int, branches: int) -> None:
    check_planted(seed, columns, rows, branches)


@pytest.mark.slow
def test_planted_branches_of_2000_surfaces(record_property: pytest.RecordProperty) -> None:
    rng = np.random.default_rng(0)
    for seed in range(2000):
        check_planted(seed, *rng.integers((2, 2, 1), (6, 5, 4)).tolist())
        record_property("surfaces", seed + 1)


def check_planted(seed: int, columns: int, rows: int, branches: int) -> None:
    """Branches that are far apart, each at some vertices; the minimum against brute force over the
    colorings of the planted surface."""
    rng = np.random.default_rng(seed)
    vertices, faces = plate(columns, rows)
    far = rng.uniform(-3, 3, (1, 4)) + CIRCLE / branches * np.arange(branches)[:, None]
    slope = rng.uniform(-1, 1, (branches, 2, 4))
    there = rng.random((len(vertices), branches)) < 0.7
    there[0, 0] = True
    whole = [far + np.einsum("d,bdj->bj", vertex[:2], slope) for vertex in vertices]
    given_, order = shuffled([own[has] for own, has in zip(whole, there, strict=True)], seed)
    found = from_configurations(vertices, faces, given_)
    assert not found.doubtful
    planted = LabelledSurface(
        "planted",
        tuple(f"branch {number}" for number in range(branches)),
        vertices,
        faces,
        tuple(tuple(np.flatnonzero(has).tolist()) for has in there),
    )
    # A color lies in one branch, and each vertex has as many colors as branches.
    branch_of: dict[int, int] = {}
    for has, place, colors in zip(there, order, found.color_of, strict=True):
        for branch, color in zip(np.flatnonzero(has)[place].tolist(), colors.tolist(), strict=True):
            assert branch_of.setdefault(color, branch) == branch
    assert found.surface.cracks == ()
    minimum = cellcolor.solve(found.surface, search_space="surface").solution
    if minimum.proved_for_surface and there.sum(axis=1).max() ** len(vertices) < 20_000:
        assert minimum.segments == vertex_minimum(planted)


def around(vertices: Array, turns: float) -> Array:
    """An angle (n,) that grows by so many full circles once around the middle of a plate."""
    middle = vertices.mean(axis=0) + np.array([1e-3, 2e-3, 0.0])
    x, y, _ = (vertices - middle).T
    return np.asarray(turns * np.arctan2(y, x))


def test_a_color_that_does_not_close_has_a_crack() -> None:
    """A joint that is half a circle off after one way around: no motion along one ray of edges."""
    vertices, faces = plate(12, 12)
    far = np.linalg.norm(vertices - vertices.mean(axis=0), axis=1) > 0.06  # a ring
    angle = around(vertices, 0.5)
    found = from_configurations(
        vertices,
        faces,
        [np.array([[own, 0.0]]) if here else [] for own, here in zip(angle, far, strict=True)],
    )
    assert len(found.surface.colors) == 1
    middle = vertices.mean(axis=0) + np.array([1e-3, 2e-3, 0.0])
    crossing = set()
    for i, j in found.surface.mesh.edges.tolist():
        (ax, ay, _), (bx, by, _) = vertices[[i, j]] - middle
        if far[[i, j]].all() and (ay < 0) != (by < 0) and min(ax, bx) < 0:
            crossing.add((i, j))
    assert {(crack.i, crack.j) for crack in found.surface.cracks} == crossing
    assert not found.doubtful  # half a circle is a jump


def test_two_solutions_that_change_places_are_refused_or_cut() -> None:
    """As of a cuspidal arm: once around, each of two solutions has become the other."""
    vertices, faces = plate(12, 12)
    far = np.linalg.norm(vertices - vertices.mean(axis=0), axis=1) > 0.06
    angle = around(vertices, 0.5)
    both = [
        np.array([[own, 0.0], [own + np.pi, 0.0]]) if here else []
        for own, here in zip(angle, far, strict=True)
    ]
    with pytest.raises(InputError, match=r"configurations\[0\]: one color has two configurations"):
        from_configurations(vertices, faces, both)
    found = from_configurations(vertices, faces, both, conflicts="cut")
    assert found.cut > 0
    assert len(found.surface.colors) == 2
    for colors in found.color_of:
        assert len(set(colors.tolist())) == len(colors)


def test_the_caller_settles_what_is_doubtful() -> None:
    """Two solutions near each other: only the caller knows which one goes on."""
    vertices, faces = plate(2, 2)
    pair = [np.array([[0.0], [0.3]]), np.array([[0.15], [0.45]])]
    given_ = [pair[0], pair[1], pair[1], pair[1]]
    asked: list[tuple[int, int, int, int]] = []

    def linked(i: int, a: int, j: int, b: int) -> bool:
        asked.append((i, a, j, b))
        return a == b

    found = from_configurations(vertices, faces, given_, linked=linked)
    assert not found.doubtful
    assert {(i, j) for i, _, j, _ in asked} == {(0, 1), (0, 2), (0, 3)}
    assert [own.tolist() for own in found.color_of] == [[0, 1]] * 4
    without = from_configurations(vertices, faces, given_)
    assert set(without.doubtful_edges) == {(0, 1), (0, 2), (0, 3)}
    assert without.surface.meta["doubtful_edges"] == [[0, 1], [0, 2], [0, 3]]
    assert "3 of 5 mesh edges doubtful (60.0%)" in str(without)
    (note,) = cellcolor.solve(without.surface).solution.notes
    assert "3 mesh edges of its surface are doubtful" in note


def test_a_number_does_not_make_two_colors_one() -> None:
    """Color "up" has two components, and another color is called "up 1"."""
    vertices, faces = plate(3, 2)
    far = [[[0.0], [0.5]], [[2.0]], [[0.0]]] * 2
    names = [["up", "up 1"], ["up"], ["up"]] * 2
    found = from_configurations(vertices, faces, far, names=names)
    assert sorted(found.surface.colors) == ["up 1", "up 2", "up 3", "up 4"]


def test_a_plan_in_joint_angles_is_judged() -> None:
    """Two branches over a plate; a plan that changes its branch in the middle lifts off once."""
    vertices, faces = plate(4, 2)
    both = [np.array([[x, 0.0], [x + 2, 1.0]]) for x, _, _ in vertices]
    found = from_configurations(vertices, faces, both, limits=[[-1.0, -1.0], [2.05, 2.0]])
    joints = np.array([own[int(v % 4 > 1)] for v, own in enumerate(both)]) + CIRCLE
    joints[3] = joints[7] = np.nan  # the last ones of branch 2 are outside the limits
    plan = cellcolor.JointPlan(joints + 5e-4)
    colors = found.colors_of(plan)
    assert colors == (0, 0, 1, None) * 2
    verdict = cellcolor.judge(found.surface, colors)
    assert [v.vertex for v in verdict.violations] == [3, 7]
    whole = found.colors_of(cellcolor.JointPlan(np.array([own[0] for own in both])))
    assert cellcolor.judge(found.surface, whole).optimal
    joints[3] = both[3][1]
    with pytest.raises(InputError, match=r"joints\[3\]: is outside the joint limits"):
        found.colors_of(cellcolor.JointPlan(joints))
    joints[3] = [0.5, 0.5]
    with pytest.raises(InputError, match=r"joints\[3\]: is no configuration of vertex 3, at"):
        found.colors_of(cellcolor.JointPlan(joints))
    with pytest.raises(InputError, match=r"has shape \(1, 2\), must be \(8, 2\)"):
        found.colors_of(cellcolor.JointPlan(joints[:1]))


def test_names_keep_configurations_apart() -> None:
    vertices, faces = plate(2, 2)
    near = [np.array([[0.0], [0.1]])] * 4
    named = from_configurations(vertices, faces, near, names=[["up", "down"]] * 4)
    assert named.surface.colors == ("up", "down")
    assert not named.doubtful


def test_limits_leave_configurations_out_and_end_motions() -> None:
    """A joint that would have to pass its end stop between two vertices: a crack, if not a gap."""
    vertices, faces = plate(3, 2)
    given_ = [np.array([[angle]]) for angle in (3.0, 3.1, 3.2, 3.0, 3.1, 3.2)]
    free = from_configurations(vertices, faces, given_)
    assert len(free.surface.colors) == 1
    # 3.2 is -3.083 as well, which is inside; but no motion gets there from 3.1.
    held = from_configurations(vertices, faces, given_, limits=[[-3.12], [3.12]])
    assert held.outside == 0
    assert len(held.surface.colors) == 2
    narrow = from_configurations(vertices, faces, given_, limits=[[-3.05], [3.05]])
    assert narrow.outside == 4
    assert str(narrow).splitlines()[1] == "4 configurations outside the joint limits"
    line = from_configurations(vertices, faces, given_, limits=[[0.0], [4.0]], periods=np.inf)
    assert len(line.surface.colors) == 1


def test_a_vertex_without_solutions_is_unreachable() -> None:
    vertices, faces = plate(2, 2)
    found = from_configurations(vertices, faces, [[[0.0]], [], np.empty((0, 1)), [[0.0]]])
    assert [len(own) for own in found.surface.vertex_colors] == [1, 0, 0, 1]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"configurations": [[[0.0]]] * 3}, "vertex_colors: has 3 entries for 4 vertices"),
        ({"configurations": [[[0.0]], [[0.0, 1.0]], [], []]}, "configurations[1]: has 2 joints"),
        ({"configurations": [[[0.0]], [[np.nan]], [], []]}, "configurations[1][0][0]: is not a"),
        ({"configurations": [[[0.0]], [0.0], [], []]}, "configurations[1]: has 1 dimensions"),
        ({"configurations": [[["a"]], [], [], []]}, "configurations[0]: is no array"),
        (
            {"configurations": [[[0.0]], [[90.0]], [], []]},
            "configurations[1][0][0]: is 90: are the angles in degrees?",
        ),
        ({"configurations": [[]] * 4}, "configurations: no vertex has any"),
        ({"faces": [[0, 1, 9]]}, "faces[0]"),
        ({"names": [["up"]] * 3}, "names: has 3 entries for 4 vertices"),
        ({"names": [["up", "down"]] * 4}, "names[0]: has 2 names for 1 configurations"),
        ({"limits": [[0.0, 0.0], [1.0, 1.0]]}, "limits: has shape (2, 2), must be (2, 1)"),
        ({"limits": [[1.0], [0.0]]}, "limits[:, 0]: go from 1 to 0"),
        ({"periods": [1.0, 2.0]}, "periods: has shape (2,), there are 1 joints"),
        ({"periods": 0.0}, "periods: must be above 0"),
        ({"max_step": 0.0}, "max_step: must be above 0"),
        ({"reach_m": 0.001}, "vertices: extend over 0.02 m, and the arm reaches 0.001 m"),
        ({"conflicts": "ignore"}, "conflicts: must be 'refuse' or 'cut'"),
    ],
)
def test_bad_input_is_named(changes: dict[str, Any], message: str) -> None:
    vertices, faces = plate(2, 2)
    good = {"vertices": vertices, "faces": faces, "configurations": [[[0.0]]] * 4}
    with pytest.raises(InputError, match=re.escape(message)):
        from_configurations(**(good | changes))
