"""The command line: ``cellcolor build``, ``solve``, ``check`` and the other commands."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import click

from cellcolor.cli.commands import cellcolor
from cellcolor.cli.exits import Exit
from cellcolor.errors import CellcolorError

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: what follows the program's name; None takes them from ``sys.argv``.

    Returns:
        The exit code: 0 done, 1 found invalid, 2 bad usage or input, 3 stopped or not proved.
    """
    try:
        code = cellcolor.main(
            args=None if arguments is None else list(arguments),
            prog_name="cellcolor",
            standalone_mode=False,
        )
    except click.ClickException as error:
        context = getattr(error, "ctx", None)
        place = context.command_path if context else "cellcolor"
        message = " ".join(error.format_message().split())
        print(f"{place}: {message}", file=sys.stderr)
        return Exit.BAD_INPUT
    except CellcolorError as error:
        print(f"cellcolor: {error}", file=sys.stderr)
        return Exit.BAD_INPUT
    except click.Abort:
        print("cellcolor: interrupted", file=sys.stderr)
        return Exit.STOPPED
    return int(code or Exit.DONE)
