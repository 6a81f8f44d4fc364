"""The report pages of docs/index.md, of the wok and two parts: made while the site is built.

    python docs/reports.py

writes them into ``docs/_reports``, as ``docs/conf.py`` does.
"""

from __future__ import annotations

from pathlib import Path

import cellcolor

PARTS = Path(__file__).parents[1] / "instances" / "parts"
FOLDER = Path(__file__).parent / "_reports"
SCENES = ("wok", "saddle", "sphere")  # ten seconds each


def write_reports(folder: Path, scenes: tuple[str, ...] = SCENES) -> None:
    """Plan the scenes whose pages are not there yet."""
    folder.mkdir(exist_ok=True)
    for name in scenes:
        page = folder / f"report-{name}.html"
        if not page.exists():
            part = PARTS / f"{name}.toml"
            page.write_bytes(cellcolor.plan(part if part.exists() else name).page())


if __name__ == "__main__":
    write_reports(FOLDER)
