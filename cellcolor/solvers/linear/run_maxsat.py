"""RC2 on a file in WCNF, as a program: ``run_maxsat FILE SECONDS SEED``; see ``rival``.

RC2 draws nothing at random and needs no time limit, for it can only be killed.
"""

from __future__ import annotations

import sys

from cellcolor.solvers.linear.printed import say, say_solution


def main(file: str, _seconds: str, _seed: str) -> None:
    """Solve a model, and print what is known as soon as it is."""
    from pysat.examples.rc2 import RC2
    from pysat.formula import WCNF

    class Told(RC2):  # type: ignore[misc]
        """RC2, whose cost is a lower bound after each core."""

        def process_core(self) -> None:
            super().process_core()
            say(f"bound {self.cost}")

    with Told(WCNF(from_file=file), solver="g4", adapt=True, exhaust=True, minz=True) as solver:
        found = solver.compute()
        if found is not None:
            say_solution([f"x{abs(value)}" for value in found], [float(v > 0) for v in found])
            say("done")


if __name__ == "__main__":
    main(*sys.argv[1:])
