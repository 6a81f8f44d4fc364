"""Reading whatever can be solved: an instance, a labelled surface or a robot scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cellcolor.cli.extras import extras_for
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.progress import build_progress_of
from cellcolor.cli.terminal import complain
from cellcolor.data import instance as instance_file
from cellcolor.data import surface as surface_file
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.files.documents import read_document


@dataclass(frozen=True, slots=True)
class BuiltScene:
    """A robot scene, built.

    Attributes:
        surface: what the front end made of it.
        report: what it has to say about that, several lines, warnings among them.
        warnings: what is probably not meant, a sentence each.
        side_file: makes the bytes of the surface's side file, reasons and configurations.
    """

    surface: LabelledSurface
    report: str
    warnings: tuple[str, ...]
    side_file: Callable[[], bytes]


def is_scene(path: Path) -> bool:
    """Scenes are told by their suffix, everything else by its ``format``."""
    return path.suffix == ".toml"


def build_scene(path: Path, deadline: Deadline = NEVER) -> BuiltScene:
    """Run the front end.

    Raises:
        InputError: the scene cannot be used, or the front end is not installed.
        OutOfTime: the deadline came first.
    """
    with extras_for(path):
        from cellcolor.frontend import build_surface
        from cellcolor.frontend.candidates_file import side_file
    INTERRUPTS.check()
    with build_progress_of(path) as report_stage:
        result = build_surface(path, deadline, report_stage)
    INTERRUPTS.check()
    report = result.report
    return BuiltScene(result.surface, str(report), report.warnings, partial(side_file, result))


def read_graph(path: Path) -> Instance | LabelledSurface:
    """An instance or a labelled surface, whichever the file says it is.

    Raises:
        InputError: the file cannot be read, is neither, or holds something forbidden.
    """
    document = read_document(path)
    try:
        match document.get("format"):
            case instance_file.FORMAT:
                return Instance.from_document(document)
            case surface_file.FORMAT:
                return LabelledSurface.from_document(document)
            case other:
                expected = f"{instance_file.FORMAT!r} or {surface_file.FORMAT!r}"
                raise InputError(None, "format", f"must be {expected}, is {other!r}")
    except InputError as error:
        raise error.in_file(str(path)) from error


def graph_of(
    surface: LabelledSurface, path: Path, reference: str | None, deadline: Deadline = NEVER
) -> Instance:
    """The topological graph of a surface.

    Args:
        surface: the labelled surface.
        path: the file it came from, for errors.
        reference: where the instance's file will say that the surface is; None leaves that out.
        deadline: when to give up.

    Raises:
        InputError: the surface cannot be decomposed.
        OutOfTime: the deadline came first.
    """
    try:
        return decompose(surface, reference, deadline)
    except InputError as error:
        raise error.in_file(str(path)) from error


def read_subject(path: Path, deadline: Deadline = NEVER) -> Instance | LabelledSurface:
    """An instance, or the labelled surface that is in the file or that a scene makes.

    What the front end warns of goes to standard error.

    Raises:
        InputError: with the file named.
        OutOfTime: the deadline came before there was a surface.
    """
    if not is_scene(path):
        return read_graph(path)
    scene = build_scene(path, deadline)
    for warning in scene.warnings:
        complain(f"{path}: warning: {warning}")
    return scene.surface


def instance_of(
    subject: Instance | LabelledSurface, path: Path, deadline: Deadline = NEVER
) -> Instance:
    """The instance that can be solved: a surface becomes what ``build`` writes beside it.

    Args:
        subject: what :func:`read_subject` found in the file.
        path: the file.
        deadline: when the decomposition has to end.

    Raises:
        InputError: with the file named.
        OutOfTime: the deadline came before there was an instance.
    """
    if isinstance(subject, Instance):
        return subject
    reference = f"{path.stem}.surface.json" if is_scene(path) else path.name
    return graph_of(subject, path, reference, deadline)


def read_instance(path: Path, deadline: Deadline = NEVER) -> Instance:
    """An instance from anything that can be solved.

    Raises:
        InputError: with the file named.
        OutOfTime: the deadline came before there was an instance.
    """
    return instance_of(read_subject(path, deadline), path, deadline)
