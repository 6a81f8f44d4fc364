"""A prepared scene elsewhere: the same as the scene prepared there, and nothing is read again."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shipped import shipped

from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend import prepared as module
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.contact import engine
from cellcolor.frontend.parts.placement import Placement
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.reach import prepared_arm

SHIFTS = st.floats(-0.2, 0.2)
ANGLES = st.floats(-math.pi, math.pi)


@pytest.fixture(scope="module")
def wok() -> PreparedScene:
    return prepare(shipped("wok_obstacle", 60))


@pytest.mark.second
@settings(max_examples=6)
@given(shift=st.tuples(SHIFTS, SHIFTS, SHIFTS), turn=st.tuples(SHIFTS, SHIFTS, ANGLES))
def test_a_part_elsewhere_is_the_scene_prepared_there(
    wok: PreparedScene, shift: tuple[float, ...], turn: tuple[float, ...]
) -> None:
    old = wok.scene.placement.position_m
    place = {"position_m": tuple(a + b for a, b in zip(old, shift, strict=True)), "rpy_rad": turn}
    there = wok.scene.moved(**place)
    try:
        anew = prepare(there)
    except InputError as error:
        with pytest.raises(InputError) as found:
            wok.at(Placement(**place))
        assert (found.value.field, found.value.message) == (error.field, error.message)
        return
    moved = wok.at(Placement(**place))
    assert moved.scene == there
    one, other = (build_prepared(each, StageClock(NEVER, None)) for each in (anew, moved))
    assert np.array_equal(one.surface.vertices, other.surface.vertices)
    assert np.array_equal(one.reasons, other.reasons)
    assert one.surface.vertex_colors == other.surface.vertex_colors
    assert one.surface.cracks == other.surface.cracks


def test_nothing_is_read_or_built_again(
    wok: PreparedScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: Any, **__: Any) -> None:
        raise AssertionError("read or built again")

    for where, name in (
        (engine, "_made"),
        (module, "prepare_arm"),
        (module, "Tip"),
        (prepared_arm, "load_robot"),
    ):
        monkeypatch.setattr(where, name, never)
    moved = wok.at(Placement(position_m=(0.5, 0.1, 0.2)))
    assert moved.arm is wok.arm
    assert moved.obstacles is wok.obstacles
    # A vertex of the part's own frame, moved by hand.
    expected = wok.part.surface.vertices[7] + [0.5, 0.1, 0.2]
    assert np.allclose(moved.surface.vertices[7], expected, rtol=0, atol=1e-15)
