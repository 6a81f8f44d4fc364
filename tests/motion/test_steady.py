"""Normals along a path turn steadily, and stay within 0.4 degrees of the surface's."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcolor
from cellcolor.arrays import Array, angles_between
from cellcolor.motion.samples import Samples
from cellcolor.motion.steady import OFF, steady
from examples import examples


def along_x(angle: Callable[[Array], Array]) -> Callable[[Array], Samples]:
    """A straight path; a place is a millimeter, and normals turn in the plane of x and z."""

    def at(places: Array) -> Samples:
        x, turned = 1e-3 * places, angle(1e-3 * places)
        zero = np.zeros_like(x)
        normals = np.stack([np.sin(turned), zero, np.cos(turned)], axis=1)
        return Samples(np.stack([x, zero, zero], axis=1), normals, np.zeros(len(x), dtype=np.int64))

    return at


def turned(samples: Samples) -> Array:
    return np.asarray(np.arctan2(samples.normals[:, 0], samples.normals[:, 2]))


def test_a_sudden_bend_becomes_a_gentle_one() -> None:
    """The normal stands still, then turns by 10 rad/m.

    The mean over a bell curve w wide is 10 w / sqrt(2 pi) off there, so w may be 1.3 mm, and 1 mm
    is one of the widths. Then the rate changes by 10 / (w sqrt(2 pi)) a meter at most.
    """
    at = along_x(lambda x: 10.0 * np.maximum(x - 0.05, 0.0))
    places = np.arange(0.0, 100.0, 0.25)
    found = turned(steady(at, 100.0)(places))
    bend = np.diff(found, 2) / 0.25e-3**2
    assert np.abs(bend).max() < 1.1 * 10.0 / (1e-3 * np.sqrt(2 * np.pi))
    assert np.abs(np.diff(turned(at(places)), 2)).max() / 0.25e-3**2 > 9 * np.abs(bend).max()


def test_what_turns_evenly_stays() -> None:
    at = along_x(lambda x: 3.0 * x)
    places = np.linspace(10.0, 90.0, 50)  # at an end the arm begins to turn from rest
    assert turned(steady(at, 100.0)(places)) == pytest.approx(turned(at(places)), abs=1e-5)


@given(st.lists(st.floats(-2000.0, 2000.0), min_size=1, max_size=12), st.integers(2, 200))
@examples(40)
def test_never_far_off(rates: list[float], last: int) -> None:
    """Rates in rad/m from knot to knot; some paths are shorter than a bell curve, and some turns as
    sharp as at a fold."""
    knots = np.linspace(0.0, 1e-3 * last, len(rates) + 1)
    angles = np.concatenate([[0.0], np.cumsum(np.diff(knots) * rates)])
    at = along_x(lambda x: np.interp(x, knots, angles))
    places = np.linspace(0.0, last, 7 * last)
    found = steady(at, float(last))(places)
    assert np.linalg.norm(found.normals, axis=1) == pytest.approx(1.0)
    assert angles_between(found.normals, at(places).normals).max() < 1.001 * OFF


def test_a_closed_path_ends_as_it_begins() -> None:
    """Round a circle of 30 mm; where it begins the normal stops tilting and tilts back."""
    whole = 188.0

    def at(places: Array) -> Samples:
        turn = 2 * np.pi * (places % whole) / whole
        tilt = 0.1 * np.sin(turn / 2)
        points = 0.03 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
        normals = np.stack([np.sin(tilt), 0 * tilt, np.cos(tilt)], axis=1)
        return Samples(points, normals, np.zeros(len(places), dtype=np.int64))

    found = turned(steady(at, whole)(np.array([0.0, 0.5, whole - 0.5, whole])))
    assert found[0] == pytest.approx(found[-1], abs=1e-9)
    assert found[0] > 1e-4  # the bend is rounded, not held
    assert found[1] - found[0] == pytest.approx(found[2] - found[-1], abs=1e-5)


@pytest.mark.second
def test_a_sphere_is_driven_at_the_speed_asked_for() -> None:
    """Nine tenths of 50 mm/s or more in 97 % of the time, and no stop but where a stroke ends or
    turns back on itself, as it does at the end of a narrow corner of a segment."""
    drive = cellcolor.plan("sphere").trajectory
    at_speed = in_contact = 0.0
    ends = np.flatnonzero(np.diff(drive.contact.astype(int), prepend=0, append=0))
    for first, last in ends.reshape(-1, 2):
        times = drive.times[first:last]
        ways = np.linalg.norm(np.diff(drive.points[first:last], axis=0), axis=1)
        spans = np.diff(times)
        at_speed += spans[ways >= 0.045 * spans].sum()
        in_contact += spans.sum()
        every = np.arange(times[0] + 0.3, times[-1] - 0.3, 0.02)
        tips = np.stack([np.interp(every, times, x) for x in drive.points[first:last].T], axis=1)
        steps = np.diff(tips, axis=0)
        for stop in np.flatnonzero(np.linalg.norm(steps, axis=1) <= 0.1 * 0.05 * 0.02):
            before, after = (
                steps[stop - 10 : stop].sum(axis=0),
                steps[stop + 1 : stop + 11].sum(axis=0),
            )
            turn = before @ after / (np.linalg.norm(before) * np.linalg.norm(after))
            assert turn < np.cos(np.radians(150))
    assert at_speed > 0.97 * in_contact
