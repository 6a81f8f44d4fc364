"""A prepared scene elsewhere: the same as the scene prepared there."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shipped import shipped

from cellcolor.deadline import NEVER
from cellcolor.errors import InputError
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.prepared import PreparedScene, prepare

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
            wok.at(there)
        assert (found.value.field, found.value.message) == (error.field, error.message)
        return
    moved = wok.at(there)
    assert moved.scene == there
    one, other = (build_prepared(each, StageClock(NEVER, None)) for each in (anew, moved))
    assert np.array_equal(one.surface.vertices, other.surface.vertices)
    assert np.array_equal(one.reasons, other.reasons)
    assert one.surface.vertex_colors == other.surface.vertex_colors
    assert one.surface.cracks == other.surface.cracks
