"""Things by name, with entry points of distributions that do not exist."""

from __future__ import annotations

from importlib.metadata import EntryPoint, EntryPoints

import pytest

from cellcolor import registered
from cellcolor.errors import InputError

GROUP = "cellcolor.things"
OWN = {"one": "math:pi", "two": "math:tau"}


@pytest.fixture(autouse=True)
def others(monkeypatch: pytest.MonkeyPatch) -> None:
    """Others register a third thing, a second ``one``, and a fourth twice."""
    points = EntryPoints(
        EntryPoint(name, value, GROUP)
        for name, value in [
            ("three", "math:e"),
            ("one", "math:inf"),
            ("four", "math:nan"),
            ("four", "math:inf"),
            ("broken", "no_such_module:x"),
        ]
    )
    monkeypatch.setattr(registered, "entry_points", points.select)


def test_own_names_come_first_and_cannot_be_taken() -> None:
    assert registered.known_names(OWN, GROUP) == ("one", "two", "broken", "four", "three")
    assert registered.find("one", OWN, GROUP).value == "math:pi"


def test_what_others_register_is_found() -> None:
    assert registered.load(registered.find("three", OWN, GROUP)) == pytest.approx(2.718281828)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("five", "thing: there is no 'five'; there are one, two, broken, four, three"),
        ("four", "thing: 'four' is registered as math:inf and as math:nan"),
        ("broken", "thing: 'broken', registered as no_such_module:x, cannot be loaded: Module"),
    ],
)
def test_faults_are_told_in_a_line(name: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        registered.load(registered.find(name, OWN, GROUP, "thing"), "thing")
