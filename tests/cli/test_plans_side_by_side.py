"""Several plans on one page: what the table and the pages say is what the folders have."""

import json
import math
from html.parser import HTMLParser
from pathlib import Path

import pytest
from commands import run
from turned_scenes import plate, setup

import cellcolor
from cellcolor.door.shipped import find_file
from cellcolor.frontend import Scene

pytestmark = pytest.mark.second


class Page(HTMLParser):
    """Cells of tables, and pages inside the page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.inside: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "tr":
            self.rows.append([])
        if tag == "iframe":
            self.inside.append(dict(attrs)["srcdoc"] or "")

    def handle_data(self, data: str) -> None:
        if self.lasttag in ("td", "th") and data.strip():
            self.rows[-1].append(data)


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    motion = Scene.read(find_file("wok")).setup.motion
    part = {"size_x_m": 0.12, "size_y_m": 0.2}
    scene = plate(setup(None).varied(motion=motion)).varied(object=part)
    made = []
    for pattern in ("contour", "back-and-forth"):
        made.append(tmp_path_factory.mktemp("plans") / pattern)
        cellcolor.plan(scene, pattern=pattern, spacing_m=0.03).save(made[-1])
    return made


def test_the_page_says_what_the_folders_have(folders: list[Path], tmp_path: Path) -> None:
    assert run("show", *folders, "-o", tmp_path / "both.html") == 0
    page = Page((tmp_path / "both.html").read_text())
    assert page.inside == [(folder / "report.html").read_text() for folder in folders]
    head, *rows = page.rows
    for folder, row in zip(folders, rows, strict=True):
        trajectory = json.loads((folder / "trajectory.json").read_text())
        told = dict(zip(head, row, strict=True))
        assert told["plan"] == folder.name
        assert told["judged"] == "valid"
        assert told["proved minimum"] == "0"
        points, touching = trajectory["points"], trajectory["contact"]
        length = sum(
            math.dist(points[k], points[k + 1])
            for k in range(len(points) - 1)
            if touching[k] and touching[k + 1]
        )
        assert told["in contact"] == f"{length:.2f} m"
        assert told["time"] == f"{trajectory['times'][-1] - trajectory['times'][0]:.1f} s"
        assert told["not planned"] == str(len(trajectory["unplanned"]))


def test_what_cannot_be_compared_is_one_line(
    folders: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    for given, page, says in (
        ([folders[0], empty], "both.html", "solution.json"),
        (folders, "both.png", "must end in .html"),
    ):
        assert run("show", *given, "-o", tmp_path / page) == 2
        said = capsys.readouterr().err.splitlines()
        assert len(said) == 1 and says in said[0]
        assert not (tmp_path / page).exists()
