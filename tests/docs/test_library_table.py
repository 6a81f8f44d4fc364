"""The table of the library's page, as the site is built with it."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

from library import INSTANCES

from cellcolor.data.library_index import LibraryIndex

SCRIPT = Path(__file__).parents[2] / "docs" / "library_table.py"
SPEC = importlib.util.spec_from_file_location("library_table", SCRIPT)
assert SPEC is not None and SPEC.loader is not None
TABLE = importlib.util.module_from_spec(SPEC)
sys.modules[SPEC.name] = TABLE
SPEC.loader.exec_module(TABLE)


def test_the_table_has_every_graph_with_its_picture(tmp_path: Path) -> None:
    library, folder = tmp_path / "instances", tmp_path / "_library"
    index = LibraryIndex.read(INSTANCES / "index.json")
    few = [index["annulus"], index["cardoor"], index["parallel-corridors"]]
    library.mkdir()
    (library / "paper").symlink_to(INSTANCES / "paper")
    (library / "index.json").write_text(LibraryIndex(tuple(few)).to_json(), encoding="utf-8")
    TABLE.write_table(library, folder)
    text = (folder / "table.txt").read_text(encoding="utf-8")
    head, rule, *rows = text.splitlines()
    assert head.count("|") == rule.count("|") == 12
    for row, entry in zip(rows, few, strict=True):
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        assert cells[1:4] == [f"`{entry.name}`", entry.family, str(entry.cells)]
        if entry.file is None:
            assert cells[0] == ""
        else:
            link = cells[0].removeprefix("![](").removesuffix(")")
            assert (tmp_path / link).read_text(encoding="utf-8").startswith("<svg ")
    assert [cell.strip() for cell in rows[2].split("|")][8:10] == ["3", "2"]
    before = (folder / "table.txt").stat().st_mtime_ns
    TABLE.write_table(library, folder)
    assert (folder / "table.txt").stat().st_mtime_ns == before  # else Sphinx reads the page anew
