"""The command line: ``cellcolor build``, ``solve``, ``check`` and the other commands.

Hardly anything is imported before the signal handlers are set: until then, Ctrl-C would print a
traceback.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys

from cellcolor.cli.ending import INTERRUPTS, Exit

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
        # What Python does last would lose the exit code. Registered first, so it is called last.
        atexit.register(INTERRUPTS.handle_with, signal.SIG_IGN)
        # What a command reads stays in use until it ends, so collecting garbage frees nothing. Done
        # every 700 objects, Python's default, it takes a third of the time of reading and checking.
        gc.set_threshold(50_000)
    try:
        with INTERRUPTS.end_the_command(last=arguments is None):
            from cellcolor.cli.failures import run

            code = run(arguments)
            if arguments is None:
                # The work is done; from now on a signal just ends the process sooner.
                INTERRUPTS.handle_with(lambda *_: os._exit(code))
    except (KeyboardInterrupt, ImportError):
        # A signal came just before or just after the command itself.
        if not INTERRUPTS.seen:
            raise
        print("cellcolor: interrupted", file=sys.stderr)
        code = Exit.STOPPED
    return code
