"""The page ``report.html`` on the wok, as in docs/plan.md: ``python docs/figures/report_page.py``.

Needs the extras ``motion`` and ``test``, and a Chromium.
"""

from __future__ import annotations

import io
import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import cellcolor

HERE = Path(__file__).parent
MOMENT = 0.36  # of the whole time


def main(page_file: Path | None) -> None:
    """Draw the page in a file, or of a motion that is planned for it."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        if page_file is None:
            page_file = Path(folder) / "report.html"
            page_file.write_bytes(cellcolor.plan("wok").page())
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        page.goto(page_file.resolve().as_uri())
        page.evaluate(
            "at => { const s = document.getElementById('time'); s.value = at * s.max;"
            " s.dispatchEvent(new Event('input')); }",
            MOMENT,
        )
        page.wait_for_timeout(1000)
        picture = Image.open(io.BytesIO(page.screenshot(full_page=True)))
        browser.close()
    few = picture.convert("RGB").quantize(128, dither=Image.Dither.NONE)
    few.save(HERE / "report-page.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
