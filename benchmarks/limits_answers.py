"""What is wrong in what a command left when its time limit came (``benchmarks/limits.py``)."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from cellcolor.checker.color_regions import regions_on_surface
from cellcolor.checker.division import check_solution
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.door.plan_files import KINDS
from cellcolor.errors import InputError


def wrong_in_answer(said: str, subject: Instance | LabelledSurface) -> str:
    """What contradicts itself in an answer, or what the checker says against its solution."""
    try:
        answer = json.loads(said.splitlines()[0])
        if "valid" in answer:
            least, own = answer["lower_bound"], answer["segments"]
            return "" if answer["valid"] and least <= own else f"at least {least}, with {own}"
        if answer.get("segments") is None:
            return ""
        if "error" in answer:
            return str(answer["error"])
        members = {name: value for name, value in answer.items() if name != "file"}
        solution = Solution.from_document(members)
    except (IndexError, InputError, TypeError, ValueError) as error:
        return f"no answer: {error!r}"
    if isinstance(subject, LabelledSurface):
        decomposition = decomposition_of(subject)
        regions = regions_on_surface(subject, decomposition.vertex_cell)
        report = check_solution(decomposition.instance, solution, regions)
    else:
        report = check_solution(subject, solution)
    return "; ".join(report.problems)


def wrong_in_plan(exit_code: int, folder: Path) -> str:
    """What must not be in a plan's folder, or its exit code for a scene that can be planned."""
    if exit_code not in (0, 3):
        return f"exit code {exit_code}"
    names = {path.name for path in folder.glob("*")}
    if exit_code == 0 and names != set(KINDS):
        return f"done, with {len(names)} files of {len(KINDS)}"
    if names - set(KINDS):
        return f"left behind: {', '.join(sorted(names - set(KINDS)))}"
    if names & {"trajectory.json", "joints.csv", "joint_trajectory.yaml"}:
        try:
            valid = json.loads((folder / "verdict.json").read_text(encoding="utf-8"))["valid"]
        except (OSError, ValueError, KeyError) as error:
            return f"a motion without its verdict: {error!r}"
        if valid is not True:
            return "a motion that is not valid"
    return not_whole(folder)


def not_whole(folder: Path) -> str:
    """The file in a folder that is cut off, if there is one."""
    for path in folder.glob("*"):
        try:
            if path.suffix == ".npz":
                np.load(path).close()
            elif path.suffix == ".html":
                assert path.read_text(encoding="utf-8").rstrip().endswith("</html>")
            elif path.suffix in ("", ".json"):
                json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError, AssertionError) as error:
            return f"{path.name} is not whole: {error!r}"
    return ""
