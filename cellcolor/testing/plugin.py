"""The pytest plugin: the fixture ``cellcolor_oracle``, and a time limit for its proofs.

pytest loads this module wherever cellcolor is installed, so it imports nothing that takes time; the
rest is imported when a test asks for the fixture.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest

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
        help="for the proof of each surface that cellcolor_oracle is asked for (default: 60)",
    )


@pytest.fixture
def cellcolor_oracle(request: pytest.FixtureRequest) -> Callable[[Solvable], SurfaceUnderTest]:
    """What is proved of a surface, to hold plans against: ``cellcolor_oracle("part.json")``.

    It takes a labelled surface, a scene, or an instance that names its surface: a file, a shipped
    name, or the value. What is proved is kept in pytest's cache, so that the next run proves
    nothing again; ``--cache-clear`` forgets it.
    """
    from cellcolor.testing.surface_under_test import surfaces_under_test

    cache = getattr(request.config, "cache", None)
    return surfaces_under_test(
        request.config.getoption(_OPTION),
        None if cache is None else cache.mkdir("cellcolor"),
        request.node.nodeid,
    )
