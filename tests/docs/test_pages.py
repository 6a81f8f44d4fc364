"""The pages lead to what there is, on GitHub too, and their figures are what the scripts draw."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import cellcolor

ROOT = Path(__file__).resolve().parents[2]
FIGURES = ROOT / "docs" / "figures"
FENCED = re.compile(r"^( *)(`{3,}).*?^\1\2$", re.MULTILINE | re.DOTALL)
PAGES = sorted(
    [*ROOT.glob("*.md"), *(p for p in ROOT.glob("docs/**/*.md") if "_build" not in p.parts)]
)
TERMS = ["point", "color", "crack", "cell", "edge", "dart", "cutting-path", "sub-cell"]
TERMS += ["scheme", "strand", "seam", "hub", "petal", "segment"]


def links(page: Path) -> list[str]:
    """What a page links to or shows, without other sites."""
    text = re.sub(r"`[^`\n]*`", "", FENCED.sub("", page.read_text(encoding="utf-8")))
    found = re.findall(r"\]\(\s*([^)\s]+)\s*\)", text)
    return [link for link in found if not re.match(r"[a-z]+:", link)]


def anchors(page: Path) -> set[str]:
    """The anchors that GitHub makes of a page's headings."""
    text = FENCED.sub("", page.read_text(encoding="utf-8"))
    headings = re.findall(r"^#+ +(.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_lead_somewhere() -> None:
    there = {page: anchors(page) for page in PAGES}
    for page in PAGES:
        for link in links(page):
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            assert target.exists(), f"{page.name} links to {link}"
            if anchor and target.suffix == ".md":
                assert anchor in there[target], f"{page.name} links to {link}"


def test_each_term_has_a_figure_and_each_figure_a_page() -> None:
    concepts = ROOT / "docs" / "concepts.md"
    shown = {Path(link).stem for link in links(concepts) if link.startswith("figures/")}
    assert shown == set(TERMS)
    used = {Path(link).name for page in PAGES for link in links(page) if "figures/" in link}
    assert {path.name for path in FIGURES.glob("*.png")} == used


@pytest.mark.second
@pytest.mark.parametrize(
    "terms", [["cell", "hub"], pytest.param([], marks=pytest.mark.slow)], ids=["two", "all"]
)
def test_figures_of_the_concepts_are_what_the_script_draws(
    tmp_path: Path, terms: list[str]
) -> None:
    """Named terms only, or all of them."""
    subprocess.run(
        [sys.executable, FIGURES / "draw.py", tmp_path, *terms],
        check=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )
    expected = terms or TERMS
    assert {path.stem for path in tmp_path.iterdir()} == set(expected)
    for name in expected:
        drawn, stored = (
            np.asarray(Image.open(folder / f"{name}.png").convert("RGB"), dtype=float)
            for folder in (tmp_path, FIGURES)
        )
        assert drawn.shape == stored.shape, name
        # Other versions of Matplotlib and FreeType draw edges and letters a little differently.
        different = (np.abs(drawn - stored).max(axis=2) > 64).mean()
        assert different < 0.02, f"{name}: out of date, run  python docs/figures/draw.py"


PAGE = Path(__file__).resolve().parents[2] / "docs" / "formats" / "surfaces-and-instances.md"


def test_the_instance_by_hand(tmp_path: Path) -> None:
    text = PAGE.read_text(encoding="utf-8")
    (example,) = re.findall(r"^```json\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    (segments,) = re.findall(r"^cellcolor solve strip.json +# (\d) segments", text, re.MULTILINE)
    (tmp_path / "strip.json").write_text(example, encoding="utf-8")
    for solver in ("cp-sat", "dfs"):
        found = cellcolor.solve(tmp_path / "strip.json", solver=solver, time_limit=60)
        assert found.optimal and found.segments == int(segments)
