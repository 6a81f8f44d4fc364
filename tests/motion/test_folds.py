"""Where a normal leads behind the triangle that it stands on, no path goes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.deadline import NEVER
from cellcolor.mesh.dividing import small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.small_triangles import FOLDED, ArmRefusals, CornerStates

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1, 0], [0.5, -0.3, 0]]) * 0.02
FACES = np.array([[0, 1, 2], [0, 3, 1]])
SHARES = st.tuples(st.floats(0, 1), st.floats(0, 1)).map(lambda two: sorted((0.0, 1.0, *two)))


def refusals(normals: np.ndarray, direction: bool) -> ArmRefusals:
    """Of a flat square in one segment, before an arm that can do everything."""
    mesh = TriangleMesh(POINTS, FACES)
    fine, side = small_triangles(mesh)
    joints, reasons = np.zeros((len(side), 3, 1)), np.zeros((len(side), 3), dtype=np.uint8)
    zero, wound = np.zeros(len(side), int), np.zeros(len(side), dtype=bool)
    everywhere = unit_everywhere(mesh, normals)
    states = CornerStates(mesh, fine, everywhere, side, zero, joints, reasons, wound)

    class Judge:
        reason_names = ("valid", "no", "joint limits")

        def __call__(self, joints: np.ndarray, _deadline: Any) -> Any:
            return SimpleNamespace(reasons=np.zeros(len(joints), dtype=np.uint8))

    prepared: Any = SimpleNamespace(
        judge=Judge(),
        arm=SimpleNamespace(follow=lambda points, *_: np.zeros((len(points), 1))),
        robot=SimpleNamespace(task=SimpleNamespace(direction=direction)),
    )
    return ArmRefusals(prepared, 0, states, 0, np.ones(4, dtype=bool), 0.001, NEVER)


def leaning(degrees: list[float]) -> np.ndarray:
    """Unit normals (4, 3) that lean along -y, by so much at each point."""
    angles = np.radians(degrees)
    return np.column_stack([np.zeros(4), -np.sin(angles), np.cos(angles)])


@given(st.lists(st.floats(0, 150), min_size=4, max_size=4), st.lists(SHARES, max_size=6))
def test_only_places_with_a_normal_that_leads_behind_are_refused(
    degrees: list[float], places: list[list[float]]
) -> None:
    normals = leaning(degrees)
    refuse = refusals(normals, direction=True)
    for face in FACES:
        shares = np.array([np.diff(one) for one in places] + [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        mixed = shares @ normals[face]
        if np.linalg.norm(mixed, axis=1).min() < 0.1:
            continue
        mixed /= np.linalg.norm(mixed, axis=1, keepdims=True)
        off = np.degrees(np.arccos(np.clip(mixed[:, 2], -1, 1)))
        codes = refuse(shares @ POINTS[face], mixed)
        sure = np.abs(off - 85) > 1e-6
        assert [refuse.names[code] == FOLDED for code in codes[sure]] == (off[sure] > 85).tolist()
    behind = {face for face, own in enumerate(FACES) if max(degrees[at] for at in own) > 85 + 1e-6}
    assert behind <= refuse.doubtful


@pytest.mark.parametrize("direction", [True, False])
def test_a_tool_that_stays_upright_may_stand_anywhere(direction: bool) -> None:
    refuse = refusals(leaning([120.0] * 4), direction)
    (code,) = refuse(POINTS[:1], leaning([120.0] * 4)[:1])
    assert (refuse.names[code] == FOLDED) == direction
    assert bool(refuse.doubtful) == direction


def test_the_place_of_a_refusal_is_where_the_normal_leads_behind() -> None:
    """And not a sample elsewhere that has failed."""
    normals = leaning([120.0] * 4)
    refuse = refusals(normals, direction=True)
    refuse.add(0, POINTS[2], "no")
    place, up = POINTS[3] / 2 + POINTS[0] / 2, np.array([0.0, 0.0, 1.0])
    assert refuse.tested(place, normals[0]).tolist() == place.tolist()
    assert refuse.tested(place, up).tolist() == POINTS[2].tolist()
