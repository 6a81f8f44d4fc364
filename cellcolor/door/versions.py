"""``cellcolor.show_versions``: what a problem report should include."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

from cellcolor.lab.machine import this_machine

DISTRIBUTIONS = (
    *("click", "networkx", "numpy", "ortools", "pydantic", "rich"),
    *("pin", "python-fcl", "scipy", "trimesh", "EAIK", "ompl", "potpourri3d", "toppra"),
    *("gpytoolbox", "matplotlib", "plotly"),
    *("clingo", "highspy", "pychoco", "pyscipopt", "python-sat", "dask", "distributed"),
)
"""What the package and its extras need, except those for tests and docs."""


def show_versions() -> None:
    """Print the versions of cellcolor, of Python and of all that cellcolor uses."""
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
