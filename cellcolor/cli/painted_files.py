"""The two files of a painting: its surface, and the plan on it beside."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.files.writing import Output, check_output, is_stream, kind_of_format, write

if TYPE_CHECKING:
    from cellcolor.painting.paint import Painted

_SURFACE = kind_of_format(LabelledSurface.FORMAT)
_PLAN = kind_of_format(Plan.FORMAT)
_ENDING = ".surface.json"


def check_painted(output: Path, inputs: Sequence[Path]) -> Path:
    """Refuse a place where a painting cannot be written; returns that of its plan.

    Args:
        output: the surface's file, with the ending ``.surface.json``.
        inputs: files that the same command reads.

    Raises:
        InputError: with the reason.
    """
    if not output.name.endswith(_ENDING) or is_stream(output):
        raise InputError(str(output), None, f"must be a file with the ending {_ENDING}")
    plan_path = output.with_name(output.name.removesuffix(_ENDING) + ".plan.json")
    check_output(output, _SURFACE, inputs)
    check_output(plan_path, _PLAN, inputs)
    return plan_path


def write_painted(painted: Painted, output: Path, inputs: Sequence[Path]) -> None:
    """Write both files, or after a failure none; see :func:`check_painted`."""
    plan_path = check_painted(output, inputs)
    write(
        [
            Output(plan_path, _PLAN, [painted.plan.to_json().encode()]),
            Output(output, _SURFACE, [painted.surface.to_json().encode()]),
        ],
        inputs,
    )
