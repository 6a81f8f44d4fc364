"""The files of a plan's folder (docs/plan.md)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.errors import InputError
from cellcolor.exports.registry import EXPORTS
from cellcolor.files.writing import (
    HTML,
    SIDE_FILE,
    FileKind,
    Output,
    check_output,
    is_folder_or_nothing,
    kind_of_format,
    write,
)

SIDE, SURFACE = "instance.reasons.npz", "instance.surface.json"

KINDS: dict[str, FileKind] = {
    SIDE: SIDE_FILE,
    SURFACE: kind_of_format(LabelledSurface.FORMAT),
    "instance.json": kind_of_format(Instance.FORMAT),
    "solution.json": kind_of_format(Solution.FORMAT),
    "painted.plan.json": kind_of_format(Plan.FORMAT),
    "painted.surface.json": kind_of_format(LabelledSurface.FORMAT),
    "paths.json": kind_of_format(ToolPaths.FORMAT),
    "trajectory.json": kind_of_format(Trajectory.FORMAT),
    "verdict.json": kind_of_format(TrajectoryVerdict.FORMAT),
    **{name: export.kind for name, export in EXPORTS.items()},
    "report.html": HTML,
}
"""Every file by name; one that refers to others comes after them."""


def check_folder(folder: Path, inputs: list[Path]) -> None:
    """Refuse a folder where writing would destroy something, or cannot succeed.

    Raises:
        InputError: with the reason.
    """
    if is_folder_or_nothing(folder):
        for name, kind in KINDS.items():
            check_output(folder / name, kind, inputs)


@contextmanager
def make_folder(folder: Path) -> Iterator[None]:
    """A folder, which is taken away again if nothing could be written to it.

    Raises:
        InputError: it cannot be made.
    """
    made = [place for place in (folder, *folder.parents) if not place.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException as error:
        for place in made:
            if place.is_dir() and not any(place.iterdir()):
                place.rmdir()
        if isinstance(error, OSError):
            raise InputError(str(folder), None, error.strerror or "cannot be made") from error
        raise


def save(folder: Path, files: Mapping[str, bytes]) -> tuple[str, ...]:
    """Write the files of a plan, all of them or none: their names.

    Raises:
        InputError: the folder has files of another plan that these would not replace; something
            else is there; or it cannot be written.
    """
    for name in KINDS.keys() - files.keys():
        if (folder / name).exists():
            whose = (
                "for another arm"
                if name in EXPORTS and "verdict.json" in files
                else "that got further"
            )
            message = f"belongs to a plan {whose}; files of two plans are not mixed"
            raise InputError(str(folder / name), None, message)
    with make_folder(folder):
        write([Output(folder / name, KINDS[name], [files[name]]) for name in files])
    return tuple(files)
