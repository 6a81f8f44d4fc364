"""The command line: ``cellcolor build``, ``solve``, ``check`` and the other commands.

Hardly anything is imported before the signal handlers are set: until then, Ctrl-C would print a
traceback.
"""

from __future__ import annotations

import gc
import signal
import sys

from cellcolor.cli.ending import INTERRUPTS, Exit
from cellcolor.signals import SIGNALS

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: what follows the program's name; None takes them from ``sys.argv``.

    Returns:
        0 done, 1 found invalid, 2 bad usage or input, 3 stopped or not proved.
    """
    if arguments is None:
        # So they are again after the command: what Python does last would lose the exit code.
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)
        # What a command reads stays in use until it ends, so collecting garbage frees nothing. Done
        # every 700 objects, Python's default, it takes a third of the time of reading and checking.
        gc.set_threshold(50_000)
    try:
        with INTERRUPTS.end_the_command():
            from cellcolor.cli.failures import run

            code = run(arguments)
    except (KeyboardInterrupt, ImportError):
        # A signal came while the commands were imported, or just after the command itself.
        if not INTERRUPTS.seen:
            raise
        print("cellcolor: interrupted", file=sys.stderr)
        code = Exit.STOPPED
    return code
