"""Why there is no verdict, as ``cellcolor check`` prints it for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from pydantic import ConfigDict, TypeAdapter

from cellcolor.files.documents import about_a_file, take_body, validate
from cellcolor.files.validation import settle

FORMAT = "cellcolor/check-error"


@dataclass(frozen=True, slots=True)
class CheckError:
    """Why nothing can be said about a solution, a plan or a trajectory.

    Attributes:
        file: what was to be checked, as the command named it; ``-`` for standard input.
        valid: null, as it is not known.
        error: what is wrong, one line that names file and member.
        at_file: the file at fault, null if no single one is.
        at_field: the member at fault, such as ``vertex_colors[3]``, or null.
        exit_code: the command's: 2 for bad input, 3 where the time limit came first.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", strict=True)

    file: str
    valid: None
    error: str
    at_file: str | None
    at_field: str | None
    exit_code: Literal[2, 3]

    def __post_init__(self) -> None:
        settle(self)

    def to_document(self) -> dict[str, Any]:
        """The JSON object, the file's name first."""
        return about_a_file(self, FORMAT)

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> CheckError:
        """An error from a parsed JSON object.

        Raises:
            InputError: a member is missing, unknown or of the wrong type.
        """
        return validate(_ADAPTER, take_body(document, FORMAT))


_ADAPTER = TypeAdapter(CheckError)
