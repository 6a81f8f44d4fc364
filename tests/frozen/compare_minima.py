"""Solve the shipped graphs, surfaces and scenes again and compare the answers with the frozen ones.

    python tests/frozen/compare_minima.py [PATTERN …] [--most-seconds S] [--time-limit S]

A pattern is one of files, such as ``paper/*``. ``--most-seconds`` leaves out what took more CPU
time when it was frozen. With ``--most-seconds 4 --time-limit 60`` nothing may differ. What took
longer was ended by the limit of 10 seconds, and such answers depend on the load of the machine. Run
it in the root of the checkout to be compared, with the Python in which that is installed. It prints
a line for each answer that is another: better, worse, both in parts, proved otherwise, or in
contradiction to the frozen one. Then the exit code is 1, unless all that differ are better.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections import Counter
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, Literal

import cellcolor

FROZEN = Path(__file__).with_name("frozen_minima.json")
Space = Literal["paper", "surface"]
SPACES: tuple[Space, ...] = ("paper", "surface")
STATUSES = ("unknown", "feasible", "optimal")
MEMBERS = ("status", "segments", "lower_bound", "surface_lower_bound", "proved_for_surface")


def cpu_seconds() -> float:
    """Of this process and of those that it started."""
    return sum(os.times()[:4])


def warm_up() -> None:
    """Solve something small, so that no answer has to wait for imports."""
    cellcolor.solve("instances/paper/annulus.json", workers=1)


def solved(file: Path, space: Space, time_limit: float) -> dict[str, Any]:
    """All that is frozen of an answer, or why there is none."""
    begun = cpu_seconds()
    answer: dict[str, Any]
    try:
        result = cellcolor.solve(file, search_space=space, time_limit=time_limit, workers=1)
    except cellcolor.CellcolorError as error:
        answer = {"error": str(error).removeprefix(f"{file}: ")}
    else:
        solution = json.loads(result.solution.to_json())
        answer = {"graph": solution["instance"]["sha256"][:16]}
        answer |= {member: solution[member] for member in MEMBERS}
        bounds = solution.get("bounds", ())
        answer["bounds"] = sorted([b["kind"], b["value"], b["holds_for"]] for b in bounds)
    return answer | {"cpu": round(cpu_seconds() - begun, 2)}


def verdict(old: dict[str, Any], new: dict[str, Any]) -> str:
    """How an answer differs from the frozen one: ``equal``, ``better``, ``worse``, …"""
    if "error" in old or "error" in new:
        return "equal" if old.get("error") == new.get("error") else "refused otherwise"
    if old["graph"] != new["graph"]:
        return "another graph"
    if any(_fewest(one) < other["lower_bound"] for one, other in ((old, new), (new, old))):
        return "CONTRADICTION"
    merits = zip(_merits(old), _merits(new), strict=True)
    signs = {(after > before) - (after < before) for before, after in merits}
    if signs == {0}:
        return "equal" if old["bounds"] == new["bounds"] else "proved otherwise"
    return {1: "better", -1: "worse"}.get(sum(signs), "better and worse")


def _fewest(answer: dict[str, Any]) -> float:
    return float("inf") if answer["segments"] is None else answer["segments"]


def _merits(answer: dict[str, Any]) -> tuple[float, ...]:
    """What is better the larger it is."""
    status = STATUSES.index(answer["status"])
    return status, -_fewest(answer), answer["lower_bound"], answer["surface_lower_bound"]


def main() -> None:
    """Compare all answers, or those that are asked for."""
    parser = argparse.ArgumentParser()
    parser.add_argument("patterns", nargs="*", default=["*"])
    parser.add_argument("--most-seconds", type=float, default=float("inf"))
    parser.add_argument("--time-limit", type=float, help="seconds for each, instead of those then")
    asked = parser.parse_args()
    frozen = json.loads(FROZEN.read_text("utf-8"))
    time_limit = asked.time_limit or frozen["time_limit"]
    found: Counter[str] = Counter()
    before = now = 0.0
    warm_up()
    for row in frozen["rows"]:
        if not any(fnmatch(row["file"], pattern) for pattern in asked.patterns):
            continue
        for space in SPACES:
            old = row.get(space)
            if old is None or old["cpu"] > asked.most_seconds:
                continue
            new = solved(Path("instances") / row["file"], space, time_limit)
            found[said := verdict(old, new)] += 1
            before, now = before + old["cpu"], now + new["cpu"]
            if said != "equal":
                changes = [
                    f"{member} {was}, now {new.get(member)}"
                    for member, was in old.items()
                    if member != "cpu" and was != new.get(member)
                ]
                print(f"{row['file']}, {space}: {said}: {'; '.join(changes)}", flush=True)
    print(f"{dict(found)}; {before:.0f} s of CPU time then, {now:.0f} s now")
    sys.exit(not found.keys() <= {"equal", "better"})


if __name__ == "__main__":
    main()
