"""The pytest plugin: the fixture ``cellcolor_oracle``, and a time limit for its proofs.

pytest loads this module wherever cellcolor is installed, so it imports nothing that takes time; the
rest is imported when a test asks for the fixture.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest

from cellcolor.testing import PICTURES

if TYPE_CHECKING:
    from cellcolor.door.subject import Solvable
    from cellcolor.testing.surface_under_test import SurfaceUnderTest

_OPTION = "--cellcolor-time-limit"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option for the time limit."""
    parser.getgroup("cellcolor", "fewest lift-offs, proved").addoption(
        _OPTION,
        type=float,
        default=60.0,
        metavar="SECONDS",
        help="for the proof of each surface that cellcolor_oracle is asked for, and for building "
        "it if it is a scene (default: 60)",
    )


@pytest.fixture(scope="session")
def cellcolor_oracle(request: pytest.FixtureRequest) -> Callable[[Solvable], SurfaceUnderTest]:
    """The proof about a surface, to judge plans: ``cellcolor_oracle("part.json")``.

    It takes a labelled surface, a scene, or an instance that names its surface: a file, a shipped
    name, or the value. What is proved is kept in pytest's cache, so that the next run proves
    nothing again; ``--cache-clear`` forgets it. Fixtures of any scope can use it.
    """
    from cellcolor.testing.surface_under_test import surfaces_under_test

    cache = getattr(request.config, "cache", None)
    return surfaces_under_test(
        request.config.getoption(_OPTION),
        None if cache is None else cache.mkdir("cellcolor"),
    )


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> None:
    """Draw what a failed assertion is about, and name the pictures below its message."""
    error = None if call.excinfo is None else call.excinfo.value
    draw = getattr(error, PICTURES, None)
    if error is not None and draw is not None:
        for line in draw(item.nodeid):
            error.add_note(line)
