"""The guide for joint solutions without a robot, run to the letter."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from guides import ROOT


def reach_database(studies: list[list[tuple[list[float], list[float] | None]]]) -> str:
    """The database of a REACH study, as Boost's XML archive writes it: a matrix by columns."""

    def many(values: list[str]) -> str:
        items = "".join(f"<item>{value}</item>" for value in values)
        return f"<count>{len(values)}</count><item_version>0</item_version>{items}"

    def record(target: list[float], state: list[float] | None) -> str:
        matrix = many([str(x) for x in [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, *target, 1]])
        joints = many(
            [f"<first>j{n}</first><second>{x:.17e}</second>" for n, x in enumerate(state or [0, 0])]
        )
        states = f"<seed_state>{joints}</seed_state><goal_state>{joints}</goal_state>"
        reached = f"<reached>{int(state is not None)}</reached>"
        return f"{reached}<goal><matrix>{matrix}</matrix></goal>{states}<score>1</score>"

    results = many([many([record(*own) for own in study]) for study in studies])
    return f"<boost_serialization><db><results>{results}</results></db></boost_serialization>"


def test_every_recipe_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All in one namespace, as a reader would paste them."""
    monkeypatch.chdir(tmp_path)
    first = [([0.3, 0.0, 0.1], [0.1, 0.2]), ([0.4, 0.0, 0.1], None)]
    further = [([0.3, 0.0, 0.1], [0.1, 0.2]), ([0.4, 0.0, 0.1], [0.3, 0.4])]
    Path("reach.db.xml").write_text(reach_database([first, further]), "utf-8")
    text = (ROOT / "docs" / "how-to" / "your-ik.md").read_text("utf-8")
    recipes = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(recipes) == 7
    known: dict[str, Any] = {}
    for recipe in recipes:
        exec(recipe, known)
    assert known["found"].surface.colors == ("color 1", "color 2")
    assert 0 < known["found"].doubtful_share < 0.01  # where the arm is nearly stretched
    assert not known["settled"].doubtful
    # Both elbows cover the whole plate, so one segment is enough.
    import cellcolor

    assert cellcolor.solve(known["found"].surface).solution.segments == 1
    assert all(len(own) == 2 for own in known["configurations"])
    assert known["targets"].tolist() == [[0.3, 0.0, 0.1], [0.4, 0.0, 0.1]]
    assert known["states"] == [[[0.1, 0.2], [0.1, 0.2]], [[0.3, 0.4]]]
