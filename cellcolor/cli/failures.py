"""Running one command: its failures as lines on standard error and as exit codes."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence

import click

from cellcolor.cli import ask, bench, minimum, motion, outside, parts  # noqa: F401, each adds its commands
from cellcolor.cli.ending import INTERRUPTS, Exit
from cellcolor.cli.options import cellcolor
from cellcolor.cli.terminal import complain, guarded_streams, shortened, shown
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError


def run(arguments: Sequence[str] | None) -> Exit:
    """Run one command; see :func:`cellcolor.cli.main`."""
    with guarded_streams() as output:
        code = _run(sys.argv[1:] if arguments is None else list(arguments))
        output.flush()
        if output.lost is not None:
            complain(f"standard output: {output.lost}")
            code = Exit.BAD_INPUT
        return code


def _run(arguments: list[str]) -> Exit:
    try:
        # Not click's own main(): that has exit code 1 for a closed standard output.
        with cellcolor.make_context("cellcolor", arguments) as context:
            return Exit(cellcolor.invoke(context) or Exit.DONE)
    except click.exceptions.Exit as end:  # after --help and --version
        return Exit(end.exit_code)
    except click.ClickException as error:
        failed: click.Context | None = getattr(error, "ctx", None)
        place = failed.command_path if failed else "cellcolor"
        message = shortened(shown(" ".join(error.format_message().split())))
        print(f"{place}: {message}", file=sys.stderr)
        return Exit.BAD_INPUT
    except (KeyboardInterrupt, click.Abort):
        complain("interrupted")
        return Exit.STOPPED
    except CellcolorError as error:
        complain(error)
        return Exit.STOPPED if isinstance(error, OutOfTime) else Exit.BAD_INPUT
    except MemoryError:
        complain("out of memory")
        return Exit.STOPPED
    except Exception:
        # An interrupted import fails in many ways, of which KeyboardInterrupt is one.
        if INTERRUPTS.seen:
            complain("interrupted")
            return Exit.STOPPED
        # A fault of this program; with Python's exit code 1 it would mean "invalid".
        traceback.print_exc()
        return Exit.BAD_INPUT
