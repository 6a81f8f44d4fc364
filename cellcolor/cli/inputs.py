"""Opening inputs for a command: with progress and warnings, and stopped by signals."""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.cli.terminal import at_work, complain
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.door.subject import Subject, open_subject, scene_of
from cellcolor.errors import InputError, system_errors

if TYPE_CHECKING:
    from cellcolor.frontend import Scene

STANDARD_INPUT = "-"
_NAME = "standard input"
_UNITS = {
    "mm": ("position_m", 1e-3),
    "m": ("position_m", 1.0),
    "deg": ("rotation_rad", radians(1.0)),
    "rad": ("rotation_rad", 1.0),
}


def open_file(path: Path, deadline: Deadline = NEVER, tolerance: str | None = None) -> Subject:
    """Read what is in a file, and build a scene.

    Args:
        deadline: when a build has to end.
        tolerance: of a scene's part, see :func:`with_tolerance`.

    Raises:
        InputError: with the file named.
        OutOfTime: the deadline came before there was a surface.
    """
    with at_work(path, "building") as tell:
        subject = open_subject(with_tolerance(path, tolerance), deadline, tell)
    return replace(subject, path=path)


def with_tolerance(path: Path, text: str | None) -> Path | Scene:
    """A scene whose part may stand off.

    Args:
        path: of the scene.
        text: a length in ``mm`` or ``m``, an angle in ``deg`` or ``rad``, or both with a comma
            between; None leaves the scene as it is.

    Raises:
        InputError: the text is something else, or the file is no scene's.
    """
    if text is None:
        return path
    tolerance: dict[str, float] = {}
    for word in text.split(","):
        found = re.fullmatch(r"([0-9.eE+-]+)(mm|m|deg|rad)", word.strip())
        key, factor = ("", 1.0) if found is None else _UNITS[found[2]]
        try:
            tolerance[key] = factor * float("" if found is None or key in tolerance else found[1])
        except ValueError as error:
            message = (
                f"must be a length, an angle, or both, with units, such as 2mm,0.5deg, is {text!r}"
            )
            raise InputError(None, "--tolerance", message) from error
    scene = scene_of(path)
    return scene.varied(tolerance=tolerance, file=scene.file)


def read_subject(path: Path, deadline: Deadline = NEVER, tolerance: str | None = None) -> Subject:
    """The same, for commands that print no report: what a scene warns of goes to standard error."""
    subject = open_file(path, deadline, tolerance)
    warn_of(path, subject)
    return subject


def warn_of(path: Path, subject: Subject) -> None:
    """Tell of likely mistakes in a scene."""
    for warning in subject.warnings:
        complain(f"{path}: warning: {warning}")


def read_instance(path: Path) -> Instance:
    """An instance from anything that can be solved; see :func:`read_subject`."""
    return read_subject(path).graph()


@contextmanager
def input_file(given: str) -> Iterator[Path]:
    """The file that a command was given, standard input having been copied into one.

    Files are read more than once, which a pipe cannot be. What is wrong with the copy is said of
    standard input.

    Args:
        given: the file's name, or ``-``; a file of that name is ``./-``.
    """
    if given != STANDARD_INPUT:
        yield Path(given)
        return
    with tempfile.TemporaryDirectory(prefix="cellcolor-") as folder:
        copy = Path(folder) / _NAME
        with system_errors(_NAME, "cannot be read"):
            copy.write_bytes(b"" if sys.stdin is None else sys.stdin.buffer.read())
        try:
            yield copy
        except InputError as error:
            if error.file != str(copy):
                raise
            raise error.in_file(_NAME) from error


def name_of(given: str) -> str:
    """What a file that a command was given is called in messages."""
    return _NAME if given == STANDARD_INPUT else given
