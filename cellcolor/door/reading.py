"""Files as values: ``cellcolor.read``, claims of all types, and joint solutions to be labelled."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from cellcolor.configurations.files import read_joint_solutions
from cellcolor.configurations.labelling import Conflicts, Labelling, from_configurations
from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory, TrajectoryTable, read_trajectory_csv
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.value import Document, read_one_of
from cellcolor.deadline import NEVER, Deadline
from cellcolor.door.installed import extras_for, find_file
from cellcolor.door.subject import is_scene
from cellcolor.errors import InputError, naming
from cellcolor.files.documents import read_document, read_text
from cellcolor.files.writing import path_of

_KINDS: tuple[type[Document], ...] = (
    *(LabelledSurface, Instance, Solution, Plan),
    *(ToolPaths, Trajectory, TrajectoryVerdict, LibraryIndex),
)
ReadTrajectory: TypeAlias = Trajectory | TrajectoryTable
"""A trajectory, or a table that a scene's arm has to complete."""
_SETUP = re.compile(r"^[ \t]*\[?[ \t]*robot\b", re.MULTILINE)
"""The table, or a key of it, that every setup has and no scene."""


def read(source: str | PathLike[str]) -> Any:
    """The value in a file: scene, setup, surface, solution, plan, tool paths, trajectory, …

    The suffix ``.toml`` identifies scenes and setups, ``format`` all other files. For a file of
    optimal schemes it is the solution in the first line. The type is ``Any``: the caller knows
    what the file contains, and would otherwise have to rule out all other types every time.

    Args:
        source: the file, as a text or a path, or as a text the name of a shipped one
            (``cellcolor.library``); a file of that name goes first.

    Raises:
        InputError: the file cannot be read, or contains something that its format forbids.
    """
    path = find_file(source)
    if not is_scene(path):
        return read_one_of(path, _KINDS)
    with extras_for(path):
        from cellcolor.frontend import Scene, Setup
    return Setup.read(path) if _SETUP.search(read_text(path)) else Scene.read(path)


def format_of_claim(file: str | PathLike[str]) -> str | None:
    """The format of a claim, None if unreadable; the suffix identifies tables."""
    if _is_table(file):
        return Trajectory.FORMAT
    try:
        form = read_document(file).get("format")
    except InputError:
        return None
    return form if isinstance(form, str) else None


def read_claim(
    file: str | PathLike[str], kinds: Collection[type[Document]] = (Plan, Solution, Trajectory)
) -> Any:
    """Read a plan, a trajectory or a solution, as the file says; of the kinds, or a table.

    Raises:
        InputError: it cannot be used; names file and member, or file, line and column.
    """
    return read_trajectory_csv(file) if _is_table(file) else read_one_of(file, kinds)


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
    if isinstance(plan, np.ndarray):
        if plan.ndim == 1 and plan.dtype.kind == "i":
            return [None if color == -1 else color for color in plan.tolist()]
        if plan.ndim == 2:
            message = (
                f"is an array {plan.shape}; pass joint angles as cellcolor.JointPlan, a row "
                "for each vertex, or as cellcolor.ContactPath, a row for each sample"
            )
            raise InputError(None, "vertex_colors", message)
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


def label(
    source: str | PathLike[str],
    *,
    mesh: str | PathLike[str] | None = None,
    conflicts: Conflicts = "refuse",
    reach_m: float | None = None,
    deadline: Deadline = NEVER,
) -> Labelling:
    """A labelled surface from a file of joint solutions.

    Args:
        source: ``.npz``, ``.json`` or ``.csv``
            (:func:`~cellcolor.configurations.files.read_joint_solutions`).
        mesh: an OBJ, PLY or STL file in m, for ``.csv``, whose vertices are numbered from 0 in the
            order of this file.
        conflicts: see :func:`~cellcolor.configurations.labelling.from_configurations`.
        reach_m: of the arm; a part far larger is refused.
        deadline: when to give up.

    Raises:
        InputError: see there; names the file.
        OutOfTime: the deadline came first.
    """
    path = path_of(source)
    own: dict[str, Any] = {}
    if mesh is not None:
        from cellcolor.frontend.parts.mesh_file import read_mesh

        own["vertices"], own["faces"] = read_mesh(path_of(mesh), deadline)
    found = read_joint_solutions(path, len(own["vertices"]) if own else None) | own
    with naming(path):
        return from_configurations(
            **found, conflicts=conflicts, reach_m=reach_m, name=path.stem, deadline=deadline
        )
