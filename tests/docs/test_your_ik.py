"""The guide for joint solutions without a robot, run to the letter."""

from __future__ import annotations

import re
from typing import Any

from guides import ROOT


def test_every_recipe_runs() -> None:
    """All in one namespace, as a reader would paste them."""
    text = (ROOT / "docs" / "how-to" / "your-ik.md").read_text("utf-8")
    recipes = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(recipes) == 6
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
