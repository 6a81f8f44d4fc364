"""Errors for extras that are not installed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from cellcolor.errors import InputError

DISTRIBUTION = "fewest-lift-offs"
"""What to install; ``cellcolor`` on the Python Package Index is somebody else's program."""

_EXTRAS = {
    "distributed": "cluster",
    "matplotlib": "viz",
    "mpl_toolkits": "viz",
    "plotly": "viz",
    "coal": "frontend",
    "fcl": "frontend",
    "pinocchio": "frontend",
    "scipy": "frontend",
    "trimesh": "frontend",
    "gpytoolbox": "parts",
    "ompl": "motion",
    "potpourri3d": "motion",
    "toppra": "motion",
}


@contextmanager
def extras_for(path: Path | str) -> Iterator[None]:
    """Turn a missing extra into a line that says what to install for a file or a purpose."""
    try:
        yield
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in _EXTRAS:
            raise
        raise _lack(path, missing, _EXTRAS[missing]) from error


def require_motion(purpose: str, modules: Sequence[str]) -> None:
    """Fail at once if the extra ``motion`` is missing, not only when the first path is laid.

    Args:
        purpose: what the modules are needed for.
        modules: of this extra, or of ``frontend``, which comes with it.

    Raises:
        InputError: one of them is not installed.
    """
    for module in modules:
        if find_spec(module) is None:
            raise _lack(purpose, module, "motion")


def _lack(purpose: Path | str, module: str, extra: str) -> InputError:
    line = f"needs {module}: pip install '{DISTRIBUTION}[{extra}]'"
    return InputError(str(purpose), None, line)
