"""The pytest plugin: the fixture ``cellcolor_oracle``, its options, and verdicts in reports.

pytest loads this module wherever cellcolor is installed, so it imports nothing that takes time; the
rest is imported when a test asks for the fixture.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from cellcolor.testing import PICTURES

if TYPE_CHECKING:
    from cellcolor.door.subject import Solvable
    from cellcolor.testing.surface_under_test import SurfaceUnderTest

_RUNNING = pytest.StashKey[pytest.Item]()
_FIXTURE = "cellcolor_oracle"
_TIME_LIMIT, _CACHE = "--cellcolor-time-limit", "--cellcolor-cache"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options."""
    group = parser.getgroup("cellcolor", "fewest lift-offs, proved")
    group.addoption(
        _TIME_LIMIT,
        type=float,
        default=60.0,
        metavar="SECONDS",
        help="for the proof of each surface that cellcolor_oracle is asked for, and for building "
        "it if it is a scene (default: 60)",
    )
    group.addoption(
        _CACHE,
        type=Path,
        metavar="DIR",
        help="where proofs and pictures are kept (default: in pytest's cache)",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line("markers", f"cellcolor: uses {_FIXTURE} (marked by cellcolor itself)")


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark tests that use the fixture, so that ``-m cellcolor`` selects them."""
    if _FIXTURE in getattr(item, "fixturenames", ()):
        item.add_marker("cellcolor")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Remember whose verdicts come next."""
    item.session.stash[_RUNNING] = item


@pytest.fixture(scope="session")
def cellcolor_oracle(request: pytest.FixtureRequest) -> Callable[[Solvable], SurfaceUnderTest]:
    """The proof about a surface, to judge plans: ``cellcolor_oracle("part.json")``.

    It takes a labelled surface, a scene, or an instance that names its surface: a file, a shipped
    name, or the value. What is proved is kept in pytest's cache, so that the next run proves
    nothing again; ``--cache-clear`` forgets it. Fixtures of any scope can use it. The verdict is a
    property of the test, which ``--junit-xml`` writes.
    """
    from cellcolor.testing.surface_under_test import SurfaceUnderTest

    config, session = request.config, request.session
    cache, folder = getattr(config, "cache", None), config.getoption(_CACHE)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    elif cache is not None:
        folder = cache.mkdir("cellcolor")

    def record(surface: str, verdict: str) -> None:
        properties = session.stash[_RUNNING].user_properties
        name = f"cellcolor: {surface}"  # the last verdict, of a property test's many
        properties[:] = [own for own in properties if own[0] != name] + [(name, verdict)]

    limit: float = config.getoption(_TIME_LIMIT)
    return partial(SurfaceUnderTest, time_limit=limit, folder=folder, record=record)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> None:
    """Draw what a failed assertion is about, and name the pictures below its message."""
    error = None if call.excinfo is None else call.excinfo.value
    draw = getattr(error, PICTURES, None)
    if error is not None and draw is not None:
        for line in draw(item.nodeid):
            error.add_note(line)
