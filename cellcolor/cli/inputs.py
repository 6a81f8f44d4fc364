"""Opening inputs for a command: with progress and warnings, and stopped by signals."""

from __future__ import annotations

from pathlib import Path

from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.progress import stages_of
from cellcolor.cli.terminal import complain
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.door.subject import Subject, open_subject


def open_file(path: Path, deadline: Deadline = NEVER) -> Subject:
    """Read what is in a file, and build a scene.

    Libraries that catch everything can swallow a signal; it is raised before and after a build.

    Raises:
        InputError: with the file named.
        OutOfTime: the deadline came before there was a surface.
    """
    INTERRUPTS.check()
    with stages_of(path, "building") as report_stage:
        subject = open_subject(path, deadline, report_stage)
    INTERRUPTS.check()
    return subject


def read_subject(path: Path, deadline: Deadline = NEVER) -> Subject:
    """The same, for commands that print no report: what a scene warns of goes to standard error."""
    subject = open_file(path, deadline)
    for warning in subject.warnings:
        complain(f"{path}: warning: {warning}")
    return subject


def read_instance(path: Path, deadline: Deadline = NEVER) -> Instance:
    """An instance from anything that can be solved; see :func:`read_subject`."""
    return read_subject(path, deadline).graph(deadline)
