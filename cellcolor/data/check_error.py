"""Why there is no verdict, as ``cellcolor check`` prints it for programs in any language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cellcolor.data.value import AboutAFile


@dataclass(frozen=True, slots=True)
class CheckError(AboutAFile):
    """Why nothing can be said about a solution, a plan or a trajectory.

    Attributes:
        file: what was to be checked, as the command named it; ``-`` for standard input.
        valid: null, as it is not known.
        error: what is wrong, one line that names file and member.
        at_file: the file at fault, null if no single one is.
        at_field: the member at fault, such as ``vertex_colors[3]``, or null.
        exit_code: the command's: 2 for bad input, 3 where the time limit came first.
    """

    FORMAT = "cellcolor/check-error"

    file: str
    valid: None
    error: str
    at_file: str | None
    at_field: str | None
    exit_code: Literal[2, 3]
