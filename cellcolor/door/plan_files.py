"""The files of a plan's folder (docs/plan.md)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from cellcolor.data.instance import Instance, SurfaceReference
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.door.subject import Subject
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
from cellcolor.painting.paint import Painted

_SIDE, _SURFACE = "instance.reasons.npz", "instance.surface.json"

KINDS: dict[str, FileKind] = {
    _SIDE: SIDE_FILE,
    _SURFACE: kind_of_format(LabelledSurface.FORMAT),
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
            message = "belongs to a plan that got further; files of two plans are not mixed"
            raise InputError(str(folder / name), None, message)
    with make_folder(folder):
        write([Output(folder / name, KINDS[name], [files[name]]) for name in files])
    return tuple(files)


def files_so_far(
    subject: Subject,
    solution: Solution | None,
    painted: Painted | None,
    paths: ToolPaths | None,
) -> dict[str, bytes]:
    """The files of a plan before its motion, by name, as far as it came."""
    surface = subject.surface
    surface = replace(surface, meta=surface.meta | {"side_file": _SIDE})
    content: dict[str, bytes] = {
        _SIDE: subject.build().candidates.to_bytes(),
        _SURFACE: surface.to_json().encode(),
        "instance.json": _named(subject).encode(),
    }
    if solution is not None:
        content["solution.json"] = solution.to_json().encode()
    if painted is not None:
        content["painted.plan.json"] = painted.plan.to_json().encode()
        content["painted.surface.json"] = painted.surface.to_json().encode()
    if paths is not None:
        content["paths.json"] = paths.to_json().encode()
    return content


def files_of_motion(
    painted: Painted, paths: ToolPaths, trajectory: Trajectory, verdict: TrajectoryVerdict
) -> dict[str, bytes]:
    """The files of a judged motion, by name."""
    from cellcolor.exports.interface import PlannedMotion
    from cellcolor.pictures.report_page.surface_modes import segment_fills

    fills = segment_fills(painted)
    motion = PlannedMotion(painted.surface, painted.segment_of, fills, paths, trajectory)
    return {
        "trajectory.json": trajectory.to_json().encode(),
        "verdict.json": verdict.to_json().encode(),
        **{name: export.content(motion) for name, export in EXPORTS.items()},
    }


def _named(subject: Subject) -> str:
    """The instance, which names the surface's file beside it."""
    decomposition, sha256 = subject.decomposition, subject.surface.sha256
    reference = SurfaceReference(_SURFACE, tuple(decomposition.vertex_cell), sha256)
    return replace(decomposition.instance, surface=reference).to_json()
