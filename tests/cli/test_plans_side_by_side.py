"""Several plans on one page: the reports that their folders have."""

import html
import re
from pathlib import Path

import pytest
from commands import run
from turned_scenes import plate, setup

import cellcolor
from cellcolor.door.shipped import find_file
from cellcolor.frontend import Scene

pytestmark = pytest.mark.second


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


def test_the_page_has_the_reports_of_the_folders(folders: list[Path], tmp_path: Path) -> None:
    assert run("show", *folders, "-o", tmp_path / "both.html") == 0
    page = (tmp_path / "both.html").read_text()
    inside = re.findall(r'<iframe title="(.*?)" srcdoc="(.*?)"></iframe>', page, re.DOTALL)
    assert [(name, html.unescape(report)) for name, report in inside] == [
        (folder.name, (folder / "report.html").read_text()) for folder in folders
    ]


def test_what_cannot_be_compared_is_one_line(
    folders: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    for given, page, says in (
        ([folders[0], empty], "both.html", "report.html"),
        (folders, "both.png", "must end in .html"),
    ):
        assert run("show", *given, "-o", tmp_path / page) == 2
        said = capsys.readouterr().err.splitlines()
        assert len(said) == 1 and says in said[0]
        assert not (tmp_path / page).exists()
