"""What is installed: ``cellcolor.show_versions``, and errors for extras that are not."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

from cellcolor.errors import InputError

DISTRIBUTION = "fewest-lift-offs"
"""What to install; ``cellcolor`` on the Python Package Index is somebody else's program."""

_EXTRAS = {
    "matplotlib": "viz",
    "coal": "frontend",
    "fcl": "frontend",
    "igl": "frontend",
    "pinocchio": "frontend",
    "scipy": "frontend",
    "trimesh": "frontend",
    "gpytoolbox": "parts",
    "potpourri3d": "motion",
}
DISTRIBUTIONS = (
    *("click", "networkx", "numpy", "ortools", "pydantic", "rich"),
    *("pin", "python-fcl", "libigl", "scipy", "trimesh", "EAIK", "potpourri3d"),
    *("gpytoolbox", "matplotlib"),
    *("clingo", "highspy", "pychoco", "pyscipopt", "python-sat"),
)
"""What the package and its extras need, except those for tests and docs."""


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


def show_versions() -> None:
    """Print the versions of cellcolor, of Python and of all that cellcolor uses."""
    from cellcolor.machine import this_machine

    machine = this_machine()
    rows = [
        ("cellcolor", machine.cellcolor),
        ("python", machine.python),
        ("system", platform.platform()),
        ("processor", f"{machine.cpu}, {machine.cores} cores, {machine.memory_mb} MB"),
        *((name, _version(name)) for name in DISTRIBUTIONS),
    ]
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        print(f"{name:<{width}}  {value}")


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
