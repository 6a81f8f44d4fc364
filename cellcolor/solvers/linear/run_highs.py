"""HiGHS on a file in MPS, as a program: ``run_highs FILE SECONDS SEED``; see ``rival``."""

from __future__ import annotations

import sys
from typing import Any

from cellcolor.solvers.linear.printed import say, say_solution


def main(file: str, seconds: str, seed: str) -> None:
    """Solve a model, and print what is known as soon as it is."""
    import highspy

    highs = highspy.Highs()
    highs.silent()
    highs.setOptionValue("random_seed", int(seed))
    highs.setOptionValue("mip_rel_gap", 0.0)
    if seconds != "inf":
        highs.setOptionValue("time_limit", float(seconds))
    if highs.readModel(file) == highspy.HighsStatus.kError:
        raise SystemExit(f"cannot read {file}")
    names = [f"x{number}" for number in range(1, highs.getNumCol() + 1)]

    def improved(event: Any) -> None:
        say_solution(names, event.data_out.mip_solution)

    def logged(event: Any) -> None:
        say(f"bound {event.data_out.mip_dual_bound}")

    highs.cbMipImprovingSolution.subscribe(improved)
    highs.cbMipLogging.subscribe(logged)
    highs.run()
    if highs.getModelStatus() == highspy.HighsModelStatus.kOptimal:
        say_solution(names, highs.getSolution().col_value)
        say("done")
    else:
        say(f"bound {highs.getInfo().mip_dual_bound}")


if __name__ == "__main__":
    main(*sys.argv[1:])
