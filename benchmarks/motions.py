"""Plan and judge motions on scenes, a row each: ``python benchmarks/motions.py [SCENE …]``.

Without scenes: the six experiments of the paper and the parts of real shape. A scene is a file or
a shipped name. docs/plan.md has what came out.
"""

from __future__ import annotations

import argparse
import time

import cellcolor
from cellcolor.errors import InputError

SCENES = ["wok", "wok_obstacle", "half_pipe", "square", "hemisphere_flat", "hemisphere_tilted"]
PARTS = ["saddle", "perforated_sheet", "sphere", "torus", "blend", "bracket", "torus_refused"]
COLUMNS = [
    "scene",
    "lift-offs, proved",
    "judged",
    "extra, by reason",
    "within 15 mm",
    "within 7.5 mm",
    "rightly left out",
    "visits, mean",
    "most",
    "again, stated",
    "faults",
    "CPU s",
]


def row(scene: str) -> list[str]:
    """The figures of one scene, in the order of ``COLUMNS``."""
    begun = time.process_time()
    try:
        planned = cellcolor.plan(scene)
    except InputError as error:
        return [scene, "refused", str(error).rpartition(": ")[2], *[""] * (len(COLUMNS) - 3)]
    seconds = time.process_time() - begun
    verdict, trajectory = planned.verdict, planned.trajectory
    area = verdict.covered
    assert area is not None
    reasons = [extra.reason for extra in trajectory.extra_lift_offs]
    extra = ", ".join(f"{reasons.count(name)} {name}" for name in sorted(set(reasons)))
    faults = ", ".join(f"{number} {kind}" for kind, number in verdict.fault_counts.items())
    return [
        scene,
        str(verdict.minimum_lift_offs),
        str(verdict.lift_offs),
        extra or "none",
        f"{area.covered_share:.2%}",
        f"{area.closely_covered_share:.2%}",
        f"{area.left_out_share:.2%}",
        f"{area.mean_visits:.2f}",
        str(area.most_visits),
        f"{area.repeated_m:.2f} of {area.length_m:.2f} m, {area.stated_repeated_m:.2f}",
        faults or "none",
        f"{seconds:.1f}",
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", nargs="*", default=SCENES + PARTS)
    print("| " + " | ".join(COLUMNS) + " |")
    print("|---|" + "--:|" * (len(COLUMNS) - 1))
    for scene in parser.parse_args().scene:
        print("| " + " | ".join(row(scene)) + " |", flush=True)


if __name__ == "__main__":
    main()
