"""The command line: ``cellcolor build``, ``solve``, ``check`` and the other commands.

Little is imported before the signals have their handlers: until then Ctrl-C ends in a traceback.
"""

from __future__ import annotations

import atexit
import gc
import os
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
        atexit.register(INTERRUPTS.ignore)  # the first registered is the last called
        # What a command reads lives as long as it does. To look it through after every 700 new
        # objects, as Python does, takes a third of the time of reading and checking.
        gc.set_threshold(50_000)
    try:
        with INTERRUPTS.end_the_command(last=arguments is None):
            from cellcolor.cli.failures import run

            code = run(arguments)
            if arguments is None:
                # The work is done; a signal can only hasten the end of the process.
                INTERRUPTS.handle_with(lambda *_: os._exit(code))
    except (KeyboardInterrupt, ImportError):
        # In the moments before and after the command proper.
        if not INTERRUPTS.seen:
            raise
        print("cellcolor: interrupted", file=sys.stderr)
        code = Exit.STOPPED
    return code
