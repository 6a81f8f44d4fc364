"""The JSON Schemas: as the classes have it, and never stricter than the reader."""

from __future__ import annotations

import copy
import importlib.util
import json
import sys
import tomllib
from collections.abc import Callable
from contextlib import redirect_stdout
from dataclasses import replace
from functools import cache
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from commands import run
from documents import TOOL_PATHS, TRAJECTORY, VERDICT
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER

from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution, scheme_line
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.verdicts import CheckError, PlanVerdict, SolutionVerdict
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.solvers.checked import enumerate_schemes, solve
from cellcolor.solvers.interface import Options
from examples import examples

jsonschema = pytest.importorskip("jsonschema")

FOLDER = Path(__file__).parents[2] / "docs" / "schemas"
SPEC = importlib.util.spec_from_file_location("write_schemas", FOLDER / "write.py")
assert SPEC is not None and SPEC.loader is not None
WRITE = importlib.util.module_from_spec(SPEC)
sys.modules[SPEC.name] = WRITE  # where its dataclasses look for themselves
SPEC.loader.exec_module(WRITE)
FILES = sorted(WRITE.FORMATS)
TABLES = {
    "scene": sorted(INSTANCES.rglob("*.toml")),
    "setup": sorted((INSTANCES.parent / "models").rglob("*.toml")),
}
LARGE = 30_000  # bytes; the validator takes a second for each million
SHIPPED = sorted(path for path in INSTANCES.rglob("*.json") if path.parent.name != "solutions")

Document = dict[str, Any]


@cache
def validator(file: str) -> Any:
    text = (FOLDER / f"{file}.schema.json").read_text(encoding="utf-8")
    return jsonschema.Draft202012Validator(json.loads(text))


def schema_of(document: Document) -> Any:
    """The schema for a document's format, whatever the document says of its version."""
    name = str(document["format"]).removeprefix("cellcolor/")
    return validator(next(file for file in FILES if file.rpartition("-")[0] == name))


def checked(subject: Path, claim: Path) -> Document:
    """What ``check`` says."""
    with redirect_stdout(StringIO()) as out:
        run("check", subject, claim, "--json")
    return dict(json.loads(out.getvalue()))


def verdicts() -> list[Document]:
    """On a plan that can be beaten, one that is not valid, what is none, and a solution."""
    subject = PAPER / "parallel-corridors.surface.json"
    colors = [own[-1] if own else None for own in LabelledSurface.read(subject).vertex_colors]
    with TemporaryDirectory() as folder:
        plans = []
        for number, entries in enumerate((colors, [7, *colors[1:]], ["x", *colors[1:]])):
            plans.append(Path(folder) / f"{number}.json")
            document = {"format": "cellcolor/plan", "version": 1, "vertex_colors": entries}
            plans[-1].write_text(json.dumps(document), encoding="utf-8")
        said = [checked(subject, plan) for plan in plans]
    solution = INSTANCES / "solutions" / "ring.solution.json"
    said.append(checked(PAPER / "ring.json", solution))
    assert said[0]["improvement"] is not None and said[1]["violations"]
    return said


def written() -> list[Document]:
    """One document of each format, as this package writes it, with the optional members."""
    instance = Instance.read(PAPER / "split-cell.json")
    surface = LabelledSurface.read(PAPER / "crack-partial.surface.json")
    paper = replace(
        solve(instance, Options(), "cp-sat-model"), cutting_paths=0, cutting_paths_lower_bound=0
    )
    strands = solve(Instance.read(PAPER / "annulus.json"), Options("surface"))
    schemes = enumerate_schemes(instance, Options(), "dfs", paper.segments or 0)
    plan = Plan(tuple(min(colors, default=None) for colors in surface.vertex_colors))
    texts = [surface.to_json(), decompose(surface, "x.json").to_json(), instance.to_json()]
    texts += [paper.to_json(), strands.to_json(), scheme_line(next(schemes)), plan.to_json()]
    index = LibraryIndex.read(INSTANCES / "index.json")
    few = LibraryIndex((index["cardoor"], index["ring"])).to_json()
    documents = [json.loads(text) for text in [*texts, few]]
    return [*documents, TOOL_PATHS, TRAJECTORY, VERDICT, *verdicts()]


WRITTEN = written()


def test_there_is_no_other_schema() -> None:
    stored = sorted(path.name.removesuffix(".schema.json") for path in FOLDER.glob("*.json"))
    assert stored == sorted([*FILES, *TABLES])
    page = (FOLDER.parent / "formats.md").read_text(encoding="utf-8")
    assert all(f"(schemas/{file}.schema.json)" in page for file in stored)


@pytest.mark.parametrize("file", [*FILES, *TABLES])
def test_stored_as_generated(file: str) -> None:
    stored = json.loads((FOLDER / f"{file}.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(stored)
    generated = json.loads(WRITE.schema_text(file))
    assert stored == generated, "out of date: run  python docs/schemas/write.py"


@pytest.mark.parametrize("document", WRITTEN, ids=lambda document: document["format"])
def test_what_is_written_is_valid(document: Document) -> None:
    schema_of(document).validate(document)


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.slow if path.stat().st_size > LARGE else ())
        for path in SHIPPED
    ],
    ids=lambda path: path.name,
)
def test_shipped_instances_are_valid(path: Path) -> None:
    document = json.loads(path.read_text(encoding="utf-8"))
    schema_of(document).validate(document)


@pytest.mark.parametrize(
    ("file", "path"), [(file, path) for file, paths in TABLES.items() for path in paths]
)
def test_shipped_tables_are_valid(file: str, path: Path) -> None:
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    validator(file).validate(table)
    assert not validator(file).is_valid(table | {"other": 1})
    if file == "scene":
        for kind, valid in (("torus", True), ("pipe", False), ("rectangle", False)):
            changed = table | {"object": {"kind": kind, "tube_m": 0.1}}
            assert validator(file).is_valid(changed) == valid


def read(document: Document) -> None:
    """Read one document as its file would be."""
    readers: dict[str, Callable[[Document], object]] = {
        "cellcolor/labelled-surface": LabelledSurface.from_document,
        "cellcolor/instance": Instance.from_document,
        "cellcolor/solution": Solution.from_document,
        "cellcolor/plan": Plan.from_document,
        "cellcolor/library": LibraryIndex.from_document,
        "cellcolor/tool-paths": ToolPaths.from_document,
        "cellcolor/trajectory": Trajectory.from_document,
        "cellcolor/trajectory-verdict": TrajectoryVerdict.from_document,
        "cellcolor/plan-verdict": PlanVerdict.from_document,
        "cellcolor/solution-verdict": SolutionVerdict.from_document,
        "cellcolor/check-error": CheckError.from_document,
    }
    readers[document["format"]](document)


def places(value: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The place of everything in a document."""
    found = []
    for key in value if isinstance(value, dict) else range(len(value)):
        found.append((*place, key))
        if isinstance(value[key], dict | list):
            found += places(value[key], (*place, key))
    return found


@st.composite
def changed(draw: st.DrawFn) -> Document:
    """A document that is written here with one member changed, added or left out."""
    whole = [document for document in WRITTEN if document["format"] != "cellcolor/scheme"]
    document = copy.deepcopy(draw(st.sampled_from(whole)))
    *outer, last = draw(st.sampled_from([p for p in places(document) if p != ("format",)]))
    holder = document
    for key in outer:
        holder = holder[key]
    values = [None, -1, 0, 1, 2, 0.5, True, "", "x", [], [0], [1, 1], [[0]], {}, {"x": 1}]
    change = draw(st.sampled_from(["value", "less", "more"]))
    if change == "value":
        holder[last] = copy.deepcopy(draw(st.sampled_from(values)))
    elif change == "less":
        del holder[last]
    elif isinstance(holder, dict):
        holder["other"] = draw(st.sampled_from(values))
    else:
        holder.append(copy.deepcopy(draw(st.sampled_from(values))))
    return document


@examples(40)
@given(changed())
def test_never_stricter_than_the_reader(document: Document) -> None:
    try:
        read(copy.deepcopy(document))
    except InputError:
        return
    newest = next(own["version"] for own in WRITTEN if own["format"] == document["format"])
    if document["version"] < newest:
        return  # read still, and not what the schemas are of
    schema_of(document).validate(document)


@pytest.mark.parametrize("document", WRITTEN, ids=lambda document: document["format"])
def test_what_both_refuse(document: Document) -> None:
    """Unknown members, another version, a missing member, a name that is a number."""
    schema = schema_of(document)
    faulty = [document | {"other": 1}, document | {"format": "cellcolor/x"}]
    if "version" in document:
        faulty += [document | {"version": 4}, {k: v for k, v in document.items() if k != "version"}]
    if "name" in document:
        faulty.append(document | {"name": 7})
    for one in faulty:
        assert not schema.is_valid(one)
