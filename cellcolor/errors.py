"""Errors that a user can act on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from os import PathLike
from typing import Any


class CellcolorError(Exception):
    """Base of every error that cellcolor raises on purpose."""

    def __reduce__(self) -> tuple[Any, ...]:
        # Python would hand the text to __init__, which may take other things.
        return _unpickled, (type(self), *self.args), vars(self)


def _unpickled(kind: type[CellcolorError], *args: object) -> CellcolorError:
    return kind.__new__(kind, *args)


class InputError(CellcolorError):
    """Something that was passed in cannot be used.

    Attributes:
        file: the file at fault, or None when the data never was in a file.
        field: the member at fault, written like ``cells[3].loops[0]``, or None.
        message: what is wrong with it, one line.
    """

    def __init__(self, file: str | PathLike[str] | None, field: str | None, message: str) -> None:
        self.file = None if file is None else str(file)
        self.field = field
        self.message = " ".join(message.split())
        super().__init__(": ".join(part for part in (self.file, field, self.message) if part))

    def in_file(self, file: str) -> InputError:
        """The same error with the file named, for data that learns its file late."""
        return InputError(file, self.field, self.message)


@contextmanager
def naming(file: str | PathLike[str] | None) -> Iterator[None]:
    """Name the file, if there is one, in errors that name none."""
    try:
        yield
    except InputError as error:
        if error.file or file is None:
            raise
        raise error.in_file(str(file)) from error


def refuse(faults: Iterable[tuple[str, str]]) -> None:
    """Raise the first of some faults, each a field and what is wrong with it.

    Raises:
        InputError: there is one.
    """
    for field, message in faults:
        raise InputError(None, field, message)


@contextmanager
def system_errors(file: str | PathLike[str], usual: str) -> Iterator[None]:
    """Name the file in errors of the operating system, with a usual text if it gives no reason."""
    try:
        yield
    except OSError as error:
        raise InputError(str(file), None, error.strerror or usual) from error


class SolverMissing(CellcolorError):
    """A solver that is known by name cannot run here: what it needs is not installed.

    Attributes:
        name: of the solver.
        how: what to do about it, such as a command that installs what is missing.
    """

    def __init__(self, name: str, how: str) -> None:
        self.name = name
        self.how = how
        super().__init__(f"the solver {name} is not installed: {how}")


class TooLarge(CellcolorError):
    """What was asked for would take more memory than anybody means to spend; it was not begun."""


class ContradictionError(CellcolorError):
    """Two things that cellcolor itself found contradict each other: cellcolor is wrong.

    No input can be the reason, so each of these is worth a report.
    """


class RefusedResult(ContradictionError):
    """The checker refuses what a solver returned: one of the two is wrong."""


class BeatenBound(ContradictionError):
    """A valid plan has fewer segments than the proven lower bound of its surface.

    Attributes:
        name: of the surface.
        segments: of the plan.
        lower: the bound that it beats.
    """

    def __init__(self, name: str, segments: int, lower: int) -> None:
        self.name = name
        self.segments = segments
        self.lower = lower
        super().__init__(
            f"internal contradiction: a valid plan on {name!r} has fewer segments, {segments}, "
            f"than the proven lower bound of {lower}; please report this surface and plan"
        )
