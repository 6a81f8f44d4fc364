"""What needs an extra that is not installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cellcolor.errors import InputError

DISTRIBUTION = "fewest-lift-offs"
"""What to install; ``cellcolor`` on the Python Package Index is somebody else's program."""

_EXTRAS = {
    "clingo": "peers",
    "matplotlib": "viz",
    "mpl_toolkits": "viz",
    "plotly": "viz",
    "coal": "frontend",
    "fcl": "frontend",
    "pinocchio": "frontend",
    "scipy": "frontend",
    "trimesh": "frontend",
    "ompl": "motion",
    "potpourri3d": "motion",
    "toppra": "motion",
}


@contextmanager
def extras_for(path: Path | str) -> Iterator[None]:
    """Turn the lack of an extra into a line that says what to install for a file or a purpose."""
    try:
        yield
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in _EXTRAS:
            raise
        line = f"needs {missing}: pip install '{DISTRIBUTION}[{_EXTRAS[missing]}]'"
        raise InputError(str(path), None, line) from error
