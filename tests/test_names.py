"""What the package is called where it is installed, imported and started."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import cellcolor
from cellcolor.door import installed

ROOT = Path(__file__).parents[1]
TEXTS = [
    ROOT / "pyproject.toml",
    *ROOT.glob("*.md"),
    *(ROOT / "docs").rglob("*.md"),
    *(ROOT / "cellcolor").rglob("*.py"),
    *(ROOT / "benchmarks").rglob("*.py"),
    *(ROOT / "models").rglob("*.toml"),
]
DISTRIBUTION = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["name"]


def test_the_distribution_is_not_somebody_elses() -> None:
    assert DISTRIBUTION == installed.DISTRIBUTION != "cellcolor"


def found_in(pattern: str, texts: list[Path]) -> list[tuple[Path, str]]:
    """Where a pattern is in texts, and what of it."""
    read = ((path, path.read_text("utf-8")) for path in texts)
    return [(path, hit[0]) for path, text in read for hit in re.finditer(pattern, text)]


def test_nothing_says_to_install_somebody_elses() -> None:
    """Neither ``pip install cellcolor`` nor an extra of it, however it is quoted."""
    # What comes after ``&&`` is a command of its own.
    assert found_in(r"install\s[^\n&]*(?<![-\w/.])cellcolor\b", TEXTS) == []
    assert found_in(r"\bcellcolor\[", TEXTS) == []


def test_no_page_installs_what_no_index_has() -> None:
    """Until it is published: a name that an index lacks can become anybody's.

    Messages may name it: they are printed where it is installed, and pip asks no index then.
    """
    pages = [path for path in TEXTS if path.suffix == ".md"]
    assert found_in(rf"pip\s+install\s+\S*\b{DISTRIBUTION}\b", pages) == []


def test_the_readme_installs_what_its_commands_need() -> None:
    """The site's reference imports the test helpers, its tutorials the front end and pictures."""
    text = (ROOT / "README.md").read_text("utf-8")
    (site,) = re.findall(r"pip install -e '\.\[(.*?)\]' && sphinx-build", text)
    assert set(site.split(",")) == {"all", "test", "docs"}
    before, _, _ = text.partition("def test_my_planner")
    assert "pip install pytest" in before


def test_messages_name_it(tmp_path: Path) -> None:
    for package, extra in (("matplotlib", "viz"), ("pinocchio", "frontend")):
        with pytest.raises(Exception, match=f"pip install '{re.escape(DISTRIBUTION)}.{extra}.'"):  # noqa: SIM117
            with installed.extras_for(tmp_path):
                raise ModuleNotFoundError(name=f"{package}.part")


def test_extras_that_messages_name_exist() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert set(installed._EXTRAS.values()) <= set(project["optional-dependencies"])


def test_as_a_module() -> None:
    command = [sys.executable, "-m", "cellcolor", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == f"cellcolor {cellcolor.__version__}\n"
