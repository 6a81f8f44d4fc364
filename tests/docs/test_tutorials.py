"""The code of the tutorials runs, and so do the plans whose reports the front page shows.

The site runs both as well, except where it is built with ``-D nb_execution_mode=off``.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from guides import ROOT

sys.path.append(str(ROOT / "docs"))
import reports

FOLDER = ROOT / "docs" / "tutorials"
QUICK = {"own-planner", "reading-a-proof"}
OTHERS = {page.stem for page in FOLDER.glob("*.md")} - QUICK - {"index"}
CELL = re.compile(r"^```\{code-cell\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def runs(name: str) -> None:
    """Run the code of a page from top to bottom."""
    code = "".join(CELL.findall((FOLDER / f"{name}.md").read_text(encoding="utf-8")))
    assert "cellcolor" in code
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.second
@pytest.mark.parametrize("name", sorted(QUICK))
def test_a_quick_tutorial_runs(name: str) -> None:
    runs(name)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(OTHERS))
def test_every_other_tutorial_runs(name: str) -> None:
    runs(name)


@pytest.mark.slow
def test_the_front_page_has_the_reports_that_it_leads_to(tmp_path: Path) -> None:
    reports.write_reports(tmp_path)
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    named = set(re.findall(r'(?:src|href)="(report-.*?\.html)"', index))
    assert named == {page.name for page in tmp_path.iterdir()}
