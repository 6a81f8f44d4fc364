"""Claims about a surface: a plan, a solution or a trajectory, identified by its file or type."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_csv import TrajectoryTable, read_trajectory_csv
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document

ReadTrajectory: TypeAlias = Trajectory | TrajectoryTable
"""A trajectory, or a table that a scene's arm has to complete."""


def format_of_claim(file: str | PathLike[str]) -> str | None:
    """The format of a claim, None if unreadable; the suffix identifies tables."""
    if _is_table(file):
        return Trajectory.FORMAT
    try:
        form = read_document(file).get("format")
    except InputError:
        return None
    return form if isinstance(form, str) else None


def read_claim(file: str | PathLike[str]) -> Plan | Solution | ReadTrajectory:
    """Read a plan, a trajectory or a solution, as the file says.

    Raises:
        InputError: it cannot be used; names file and member.
    """
    form = format_of_claim(file)
    if form == Trajectory.FORMAT:
        return read_trajectory(file)
    return Plan.read(file) if form == Plan.FORMAT else Solution.read(file)


def read_trajectory(file: str | PathLike[str]) -> ReadTrajectory:
    """What is in a trajectory's file.

    Raises:
        InputError: it cannot be used; names file and member, or file, line and column.
    """
    return read_trajectory_csv(file) if _is_table(file) else Trajectory.read(file)


def _is_table(file: str | PathLike[str]) -> bool:
    """Whether a file is a table of a trajectory, which its suffix says."""
    return Path(file).suffix == ".csv"


def color_numbers(surface: LabelledSurface, plan: Any) -> Any:
    """One color per vertex as a plan has them; anything else is left for the plan to reject.

    Args:
        plan: numbers, names, or None for none; in an array of integers -1 for none.

    Raises:
        InputError: an array of another kind, or a name that the surface does not have.
    """
    if isinstance(plan, np.ndarray) and plan.ndim == 1 and plan.dtype.kind == "i":
        return [None if color == -1 else color for color in plan.tolist()]
    if isinstance(plan, np.ndarray) and plan.ndim == 2:
        message = (
            f"is an array {plan.shape}; pass joint angles as cellcolor.JointPlan, a row "
            "for each vertex, or as cellcolor.ContactPath, a row for each sample"
        )
        raise InputError(None, "vertex_colors", message)
    if isinstance(plan, np.ndarray):
        if plan.dtype.kind not in "iuUO":
            wanted = "color numbers (-1 for none) or names"
            message = f"must be {wanted}, is an array of {plan.dtype}"
            raise InputError(None, "vertex_colors", message)
        plan = plan.tolist()
    if not isinstance(plan, Sequence) or isinstance(plan, (bytes, bytearray)):
        return plan
    number = {name: color for color, name in enumerate(surface.colors)}
    colors = []
    for vertex, color in enumerate(plan):
        if isinstance(color, str):
            if color not in number:
                message = f"the surface has no color {color!r}"
                raise InputError(None, f"vertex_colors[{vertex}]", message)
            color = number[color]
        colors.append(color)
    return colors
