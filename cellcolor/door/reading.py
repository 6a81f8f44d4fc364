"""``cellcolor.read``: the value in a file of any cellcolor format."""

from __future__ import annotations

import re
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.door.extras import extras_for
from cellcolor.door.shipped import find_file
from cellcolor.door.subject import is_scene
from cellcolor.errors import InputError
from cellcolor.files.documents import parse_first_object, read_text

if TYPE_CHECKING:
    from cellcolor.frontend import Scene, Setup

_Value: TypeAlias = (
    LabelledSurface
    | Instance
    | Solution
    | Plan
    | ToolPaths
    | Trajectory
    | TrajectoryVerdict
    | LibraryIndex
)
_KINDS: dict[str, type[_Value]] = {
    LabelledSurface.FORMAT: LabelledSurface,
    Instance.FORMAT: Instance,
    Solution.FORMAT: Solution,
    Plan.FORMAT: Plan,
    ToolPaths.FORMAT: ToolPaths,
    Trajectory.FORMAT: Trajectory,
    TrajectoryVerdict.FORMAT: TrajectoryVerdict,
    LibraryIndex.FORMAT: LibraryIndex,
}
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
    if is_scene(path):
        return _read_toml(path)
    try:
        document = parse_first_object(read_text(path))
        form = document.get("format")
        if not isinstance(form, str) or form not in _KINDS:
            known = ", ".join(map(repr, _KINDS))
            raise InputError(None, "format", f"must be one of {known}, is {form!r}")
        return _KINDS[form].from_document(document)
    except InputError as error:
        raise error.in_file(str(path)) from error


def _read_toml(path: Path) -> Scene | Setup:
    with extras_for(path):
        from cellcolor.frontend import Scene, Setup
    return Setup.read(path) if _SETUP.search(read_text(path)) else Scene.read(path)
