"""The instance by hand in docs/formats/surfaces-and-instances.md is one, and has that minimum."""

from __future__ import annotations

import re
from pathlib import Path

import cellcolor

PAGE = Path(__file__).resolve().parents[2] / "docs" / "formats" / "surfaces-and-instances.md"


def test_the_instance_by_hand(tmp_path: Path) -> None:
    text = PAGE.read_text(encoding="utf-8")
    (example,) = re.findall(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    (segments,) = re.findall(r"^cellcolor solve strip.json +# (\d) segments", text, re.MULTILINE)
    (tmp_path / "strip.json").write_text(example, encoding="utf-8")
    for solver in ("cp-sat", "dfs"):
        found = cellcolor.solve(tmp_path / "strip.json", solver=solver, time_limit=60)
        assert found.optimal and found.segments == int(segments)
