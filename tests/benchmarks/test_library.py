"""The index of the instance library is true, and a stale one is found."""

from __future__ import annotations

import csv
import json
import runpy
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from library import INSTANCES

from cellcolor.data.bounds import Bound, Extent
from cellcolor.data.library_index import LibraryEntry, LibraryIndex
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab import families

sys.path.append(str(INSTANCES.parent / "benchmarks"))
import library_archive
from library_entries import INDEX, SOLUTIONS, problems

LIBRARY = LibraryIndex.read(INSTANCES / INDEX)


@pytest.mark.second
def test_the_index_is_true() -> None:
    """Hashes, counts, and all bounds, with every solution and certificate checked."""
    assert problems(INSTANCES) == []


HARD = [
    entry.name
    for entry in LIBRARY.entries
    if (entry.file or "").startswith("hard/") and entry.source.startswith("cellcolor.lab.")
]


@pytest.mark.second
@pytest.mark.parametrize(
    "name", ["hub_60", "hub_loops_3x3", "planar_0", "rim_26", "thin_11", *HARD]
)
def test_random_graphs_are_made_again(name: str) -> None:
    """Those of the hard set all that are random, so that each has its surface if it had one."""
    entry = LIBRARY[name]
    recipe = entry.source.removeprefix("cellcolor.lab.families.")
    made = eval(recipe, vars(families))
    graph = decompose(made) if isinstance(made, LabelledSurface) else made
    assert graph.sha256 == entry.fingerprint


def test_no_bound_is_lost_when_a_graph_is_solved_again() -> None:
    """A weaker bound that can be verified stays beside a greater one that cannot."""
    needed = runpy.run_path(str(INSTANCES.parent / "benchmarks" / "library.py"))["needed"]
    ring = Solution.read(INSTANCES / SOLUTIONS / "ring.solution.json")
    certificate = next(b.certificate for b in ring.bounds or () if b.certificate is not None)

    def bound(value: int, certified: bool, extent: Extent = "surface") -> Bound:
        return Bound("cover", value, extent, certificate if certified else None)

    weak, strong = bound(4, True), bound(7, False)
    assert needed([strong, weak]) == (weak, strong)
    assert needed([weak, strong, bound(7, True), bound(3, True)]) == (bound(7, True),)
    assert needed([strong, bound(6, False)]) == (strong,)
    strands = bound(8, False, "strands")
    assert needed([strands, weak, strong]) == (weak, strong, strands)
    assert needed([bound(7, False, "strands"), strong]) == (strong,)
    assert needed([]) == ()
    gone = Bound("hubs", 7, "surface")
    assert needed([gone, strong]) == (strong,)
    assert needed([gone, weak, bound(6, False)]) == (weak, bound(6, False), gone)
    assert needed([gone, bound(7, False, "strands")]) == (gone, bound(7, False, "strands"))


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A library of two graphs."""
    few = [LIBRARY["parallel-corridors"], LIBRARY["ring"]]
    for entry in few:
        assert entry.file is not None
        for file in [entry.file, *(f"{SOLUTIONS}/{path.name}" for path in solutions(entry))]:
            (tmp_path / file).parent.mkdir(exist_ok=True)
            shutil.copy(INSTANCES / file, tmp_path / file)
    write(tmp_path, *few)
    return tmp_path


def solutions(entry: LibraryEntry) -> list[Path]:
    return sorted((INSTANCES / SOLUTIONS).glob(f"{entry.name}.*json"))


def write(folder: Path, *entries: LibraryEntry) -> None:
    (folder / INDEX).write_text(LibraryIndex(entries).to_json(), encoding="utf-8")


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def _of_no_entry(copy: Path) -> None:
    shutil.copy(INSTANCES / "paper/annulus.json", copy / "paper")
    shutil.copy(INSTANCES / SOLUTIONS / "annulus.solution.json", copy / SOLUTIONS)


STALE: dict[str, tuple[Callable[[Path], object], list[str]]] = {
    "nothing": (lambda _: None, []),
    "a changed byte": (
        lambda copy: edit(copy / "paper/ring.json", "blue", "blub"),
        ["paper/ring.json: sha256 is not that of the index"],
    ),
    "a missing file": (
        lambda copy: (copy / "paper/ring.json").unlink(),
        ["paper/ring.json: No such file or directory"],
    ),
    "files without an entry": (
        _of_no_entry,
        [
            "paper/annulus.json: is not in the index",
            "solutions/annulus.solution.json: is of no graph here",
        ],
    ),
    "entries out of order": (
        lambda copy: write(copy, LIBRARY["ring"], LIBRARY["parallel-corridors"]),
        ["index.json: the entries are not in the order of their names"],
    ),
    # The division of the search space surface has one segment fewer.
    "the best division missing": (
        lambda copy: (copy / SOLUTIONS / "parallel-corridors.surface.solution.json").unlink(),
        ["paper/parallel-corridors.json: surface.upper is "],
    ),
    "another number": (
        lambda copy: edit(
            copy / SOLUTIONS / "ring.solution.json", '"segments": 2', '"segments": 3'
        ),
        ["solutions/ring.solution.json: is not valid"],
    ),
}


@pytest.mark.parametrize(("change", "said"), STALE.values(), ids=STALE.keys())
def test_what_is_stale_is_found(
    change: Callable[[Path], object], said: list[str], copy: Path
) -> None:
    change(copy)
    found = problems(copy)
    assert len(found) >= len(said) and bool(found) is bool(said)
    assert all(line.startswith(begin) for begin, line in zip(said, found, strict=False))


@pytest.mark.parametrize("member", ["cells", "edges", "darts", "loops", "colors", "holes"])
def test_a_wrong_count_is_found(copy: Path, member: str) -> None:
    ring = LIBRARY["ring"]
    wrong = replace(ring, **{member: getattr(ring, member) + 1})
    write(copy, LIBRARY["parallel-corridors"], wrong)
    assert problems(copy) == [f"paper/ring.json: {member} is not that of the index"]


class TestReading:
    def document(self) -> dict[str, Any]:
        index = LibraryIndex((LIBRARY["cardoor"], LIBRARY["ring"]))
        document: dict[str, Any] = json.loads(index.to_json())
        return document

    def test_written_and_read(self) -> None:
        index = LibraryIndex((LIBRARY["cardoor"], LIBRARY["ring"]))
        assert LibraryIndex.from_document(json.loads(index.to_json())) == index
        with pytest.raises(KeyError):
            index["wok"]

    @pytest.mark.parametrize(
        ("members", "text"),
        [
            ({"name": "cardoor"}, "entries[0].name: 'cardoor' appears twice"),
            ({"sha256": "0"}, "entries[1].sha256"),
            ({"file": None}, "file: is either here or outside, one of the two"),
            ({"cells": -1}, "entries[1].cells"),
            ({"paper": None}, "entries[1].paper"),
            ({"other": 1}, "entries[1].other"),
        ],
    )
    def test_refused(self, members: dict[str, Any], text: str) -> None:
        document = self.document()
        document["entries"][1] |= members
        with pytest.raises(InputError) as caught:
            LibraryIndex.from_document(document)
        assert text in str(caught.value)

    @pytest.mark.parametrize(
        ("space", "end", "value", "text"),
        [
            ("paper", "lower", 3, "is 3, above that of a division, 2"),
            ("surface", "upper", 3, "a division of the search space paper is one of the surface"),
            ("paper", "lower", 1, "what holds for any division holds in the search space paper"),
        ],
    )
    def test_ranges_that_contradict_each_other(
        self, space: str, end: str, value: int, text: str
    ) -> None:
        document = self.document()
        document["entries"][1][space][end]["value"] = value
        with pytest.raises(InputError) as caught:
            LibraryIndex.from_document(document)
        assert text in str(caught.value)


@pytest.mark.second
def test_the_archive_is_checked_with_python_alone(tmp_path: Path) -> None:
    """Unpacked in an empty folder: its solutions of its graphs, judged without the package."""
    archive = tmp_path / "library.zip"
    table = library_archive.as_csv(library_archive.measured(None))
    library_archive.pack(archive, table)
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path)
    (top,) = tmp_path.glob("cellcolor-library-*")
    for name in ("annulus", "hub_60", "wok"):
        files = (f"graphs/{name}.json", f"solutions/{name}.solution.json")
        command = [sys.executable, "-I", "-S", "check_solution.py", *files]
        done = subprocess.run(command, cwd=top, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    rows = {row["name"]: row for row in csv.DictReader((top / "features.csv").open())}
    assert {entry.name for entry in LIBRARY.entries if entry.file} == set(rows)
    # A hub with its leaf cells is a star, and all of a hub's darts are on one loop.
    assert rows["hub_60"]["treewidth_at_most"] == "1"
    assert (rows["hub_60"]["cells"], rows["hub_60"]["most_darts"]) == ("61", "60")
    assert rows["annulus"]["most_loops"] == "2"
