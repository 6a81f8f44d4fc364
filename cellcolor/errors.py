"""Errors that a user can act on."""

from __future__ import annotations

__all__ = ["CellcolorError", "InputError", "TooLarge"]


class CellcolorError(Exception):
    """Base of every error that cellcolor raises on purpose."""


class InputError(CellcolorError):
    """Something that was handed in cannot be used.

    Attributes:
        file: the file at fault, or None when the data never was in a file.
        field: the member at fault, written like ``cells[3].loops[0]``, or None.
        message: what is wrong with it, one line.
    """

    def __init__(self, file: str | None, field: str | None, message: str) -> None:
        self.file = file
        self.field = field
        self.message = " ".join(message.split())
        super().__init__(": ".join(part for part in (file, field, self.message) if part))

    def in_file(self, file: str) -> InputError:
        """The same error with the file named, for data that learns its file late."""
        return InputError(file, self.field, self.message)


class TooLarge(CellcolorError):
    """What was asked for would take more memory than anybody means to spend; it was not begun."""
