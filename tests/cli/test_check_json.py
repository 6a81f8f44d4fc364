"""``check`` for programs in other languages: one JSON object, standard input, exit codes."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from commands import run
from documents import Document
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import drawn, surfaces

import cellcolor.door.oracle
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import CheckError, PlanVerdict, SolutionVerdict
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.oracle import Proof, ProvenRange
from cellcolor.testing.strategies import broken_plans, valid_plans
from examples import examples

RED, BLUE = 0, 1
# Red reaches everything, so one segment is the minimum.
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
BEST = [RED] * 18
WORSE = [RED, RED, BLUE, BLUE, RED, RED] * 3
WRONG = [BLUE] + [RED] * 17
RING = PAPER / "ring.json"

Capture = pytest.CaptureFixture[str]
Pipe = Callable[[str | bytes], None]


@pytest.fixture
def row(tmp_path: Path) -> Path:
    path = tmp_path / "row.surface.json"
    path.write_text(ROW.to_json(), encoding="utf-8")
    return path


@pytest.fixture
def pipe(monkeypatch: pytest.MonkeyPatch) -> Pipe:
    """Puts something into standard input."""

    def put(content: str | bytes) -> None:
        raw = content if isinstance(content, bytes) else content.encode()
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(raw)))

    return put


def text(colors: list[int]) -> str:
    return Plan(tuple(colors)).to_json()


def printed(capsys: Capture) -> Document:
    """The one object on standard output."""
    (line,) = capsys.readouterr().out.splitlines()
    document: Document = json.loads(line)
    return document


def test_a_plan_from_standard_input(row: Path, pipe: Pipe, capsys: Capture) -> None:
    pipe(text(WORSE))
    assert run("check", row, "-", "--json") == 0
    verdict = PlanVerdict.from_document(printed(capsys))
    assert (verdict.file, verdict.valid, verdict.optimal) == ("-", True, False)
    assert (verdict.segments, verdict.lower_bound, verdict.upper_bound) == (3, 1, 1)
    assert (verdict.beatable_by, verdict.gap) == (2, 2)
    assert verdict.improvement is not None
    one, other = verdict.improvement.joined
    places = verdict.improvement.places
    # Segments are numbered by their first vertices: red on the left, blue, red on the right.
    assert [WORSE[place] for place in places] == [(RED, BLUE, RED)[one], (RED, BLUE, RED)[other]]
    # The better plan is one on the same mesh, and the oracle says so.
    better = verdict.improvement.vertex_colors
    assert better is not None
    pipe(Plan(better).to_json())
    assert run("check", row, "-", "--json") == 0
    again = PlanVerdict.from_document(printed(capsys))
    assert (again.segments, again.optimal, again.improvement) == (1, True, None)


@examples(12)
@given(surfaces(), st.data())
def test_the_object_says_what_the_verdict_says(
    surface: LabelledSurface, data: st.DataObject
) -> None:
    """Of any plan, and the better plan in it is one: it has as many segments as it says."""
    plan = data.draw(valid_plans(surface) | broken_plans(surface))
    verdict = cellcolor.judge(surface, plan)
    with TemporaryDirectory() as folder:
        files = Path(folder, "surface.json"), Path(folder, "plan.json")
        for file, value in zip(files, (surface, plan), strict=True):
            file.write_text(value.to_json(), encoding="utf-8")
        with redirect_stdout(io.StringIO()) as out:
            code = run("check", *files, "--json")
    assert code == (0 if verdict.valid else 1)
    document = json.loads(out.getvalue())
    said = PlanVerdict.from_document(document)
    assert json.loads(json.dumps(said.to_document())) == document
    for name in ("valid", "problems", "segments", "lift_offs", "optimal", "beatable_by", "why"):
        assert getattr(said, name) == getattr(verdict, name), name
    bounds = None if verdict.bounds is None else (verdict.bounds.lower, verdict.bounds.upper)
    assert bounds == (None if said.lower_bound is None else (said.lower_bound, said.upper_bound))
    assert said.text == str(verdict)
    assert [found.vertex for found in said.violations] == [v.vertex for v in verdict.violations]
    assert (said.improvement is None) == (verdict.improvement is None)
    if said.improvement is not None and said.improvement.vertex_colors is not None:
        better = check_plan(surface, Plan(said.improvement.vertex_colors))
        assert better.segments == said.improvement.segments_on_mesh
        assert said.segments is not None and better.segments < said.segments


def test_a_surface_from_standard_input(pipe: Pipe, tmp_path: Path, capsys: Capture) -> None:
    plan = tmp_path / "plan.json"
    plan.write_text(text(BEST), encoding="utf-8")
    pipe(ROW.to_json())
    assert run("check", "-", plan, "--json") == 0
    verdict = PlanVerdict.from_document(printed(capsys))
    assert (verdict.file, verdict.optimal) == (str(plan), True)


def test_a_solution_with_its_schemes_from_standard_input(
    pipe: Pipe, tmp_path: Path, capsys: Capture
) -> None:
    schemes = tmp_path / "all.jsonl"
    assert run("solve", RING, "--all", "-o", schemes) == 0
    capsys.readouterr()
    pipe(schemes.read_bytes())
    assert run("check", RING, "-", "--json") == 0
    from_pipe = SolutionVerdict.from_document(printed(capsys))
    assert run("check", RING, schemes, "--json") == 0
    from_file = SolutionVerdict.from_document(printed(capsys))
    assert from_file.schemes == len(schemes.read_text(encoding="utf-8").splitlines()) - 1
    assert (from_pipe.schemes, from_pipe.bounds) == (from_file.schemes, from_file.bounds)
    pipe(RING.read_bytes())
    assert run("check", "-", schemes, "--json") == 0
    assert SolutionVerdict.from_document(printed(capsys)) == from_file


def test_a_file_of_that_name(
    row: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    (tmp_path / "-").write_text(text(BEST), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert run("check", row, "./-", "--json") == 0
    assert printed(capsys)["file"] == "./-"


def test_a_plan_that_is_not_valid(row: Path, pipe: Pipe, capsys: Capture) -> None:
    pipe(text(WRONG))
    assert run("check", row, "-", "--json") == 1
    verdict = PlanVerdict.from_document(printed(capsys))
    assert (verdict.valid, verdict.segments, verdict.gap) == (False, None, None)
    (violation,) = verdict.violations
    assert (violation.vertex, violation.color, verdict.violation_count) == (0, BLUE, 1)
    assert list(violation.place) == ROW.vertices[0].tolist()
    pipe(text(WRONG))
    assert run("check", row, "-") == 1
    x, y, z = ROW.vertices[0]
    place = f"at ({x:.3f}, {y:.3f}, {z:.3f}) m"
    assert f"  vertex_colors[0]: {violation.reason} {place}\n" in capsys.readouterr().out


def test_the_first_hundred_violations(pipe: Pipe, tmp_path: Path, capsys: Capture) -> None:
    wide = drawn(" ".join(["A" * 15] * 10), {"A": [RED]})
    surface = tmp_path / "wide.surface.json"
    surface.write_text(wide.to_json(), encoding="utf-8")
    pipe(text([7] * 150))
    assert run("check", surface, "-", "--json") == 1
    verdict = PlanVerdict.from_document(printed(capsys))
    assert (verdict.violation_count, len(verdict.problems)) == (150, 150)
    assert [found.vertex for found in verdict.violations] == list(range(100))
    pipe(text([7] * 150))
    assert run("check", surface, "-") == 1
    assert "  140 more\n" in capsys.readouterr().out


def test_a_better_painting_is_written(row: Path, pipe: Pipe, tmp_path: Path) -> None:
    better = tmp_path / "better.surface.json"
    pipe(text(BEST))
    assert run("check", row, "-", "--better", better) == 0
    assert not better.exists()  # there is none
    pipe(text(WORSE))
    assert run("check", row, "-", "--better", better) == 0
    surface = LabelledSurface.read(better)
    plan = Plan.read(tmp_path / "better.plan.json")
    verdict = cellcolor.judge(surface, plan)
    assert (verdict.segments, verdict.optimal) == (1, True)


def test_a_better_painting_does_not_replace_the_surface(
    row: Path, pipe: Pipe, capsys: Capture
) -> None:
    before = row.read_bytes()
    pipe(text(WORSE))
    assert run("check", row, "-", "--better", row) == 2
    assert "is an input" in capsys.readouterr().err
    assert row.read_bytes() == before


def test_the_proof_is_kept_for_the_next_process(
    row: Path, pipe: Pipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Proving fails from the second plan on; even where a plan can be beaten is known."""
    cache = tmp_path / "made" / "proofs"
    pipe(text(BEST))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    first = printed(capsys)
    assert len(list(cache.iterdir())) == 1
    monkeypatch.setattr(cellcolor.door.oracle, "prove", None)
    pipe(text(BEST))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    assert printed(capsys) == first
    pipe(text(WORSE))
    assert run("check", row, "-", "--json", "--cache", cache) == 0
    assert printed(capsys)["improvement"]["segments"] == 1


def test_a_cache_that_is_no_folder(row: Path, pipe: Pipe, capsys: Capture) -> None:
    pipe(text(BEST))
    assert run("check", row, "-", "--cache", row) == 2
    assert capsys.readouterr().err == f"cellcolor: {row}: must be a folder\n"


def test_an_optimal_plan_is_required(
    row: Path, pipe: Pipe, monkeypatch: pytest.MonkeyPatch
) -> None:
    """0 optimal, 1 not valid or beatable, 3 open."""
    for colors, code in ((BEST, 0), (WORSE, 1), (WRONG, 1)):
        pipe(text(colors))
        assert run("check", row, "-", "--require-optimal") == code

    def out_of_time(*_: object, **__: object) -> None:
        raise OutOfTime

    monkeypatch.setattr("cellcolor.oracle.ranges.decomposition_of", out_of_time)
    pipe(text(WORSE))
    assert run("check", row, "-", "--require-optimal") == 3
    pipe(text(WORSE))
    assert run("check", row, "-") == 0


@pytest.mark.parametrize(
    "option", [["--require-optimal"], ["--cache", "c"], ["--better", "b.surface.json"]]
)
def test_options_of_plans(
    option: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("solve", RING, "-o", "s.json") == 0
    capsys.readouterr()
    assert run("check", RING, "s.json", *option) == 2
    assert capsys.readouterr().err == f"cellcolor: {option[0]}: goes with a plan; s.json is none\n"
    assert [path.name for path in tmp_path.iterdir()] == ["s.json"]


@pytest.mark.parametrize(
    ("content", "field", "message"),
    [
        ("", None, "not JSON"),
        (b"\xff", None, "not UTF-8 text"),
        ('{"format": "cellcolor/plan", "version": 2}', "version", "must be 1"),
        ('{"format": "cellcolor/plan", "version": 1, "vertex_colors": [0.5]}', None, ""),
    ],
)
def test_bad_standard_input(
    content: str | bytes, field: str | None, message: str, row: Path, pipe: Pipe, capsys: Capture
) -> None:
    pipe(content)
    assert run("check", row, "-", "--json") == 2
    out, err = capsys.readouterr()
    error = CheckError.from_document(json.loads(out))
    assert (error.file, error.at_file, error.exit_code) == ("-", "standard input", 2)
    assert err == f"cellcolor: {error.error}\n"
    assert message in error.error
    if field is not None:
        assert error.at_field == field


def test_errors_name_the_file_at_fault(row: Path, pipe: Pipe, capsys: Capture) -> None:
    pipe(text(BEST))
    assert run("check", "no-such-thing", "-", "--json") == 2
    error = CheckError.from_document(printed(capsys))
    assert (error.file, error.at_file) == ("-", "no-such-thing")
    pipe(json.dumps(json.loads(ROW.to_json()) | {"faces": [[0, 1, 1]]}))
    assert run("check", "-", row, "--json") == 2
    error = CheckError.from_document(printed(capsys))
    assert (error.at_file, error.at_field) == ("standard input", "faces[0]")


def test_an_instance_from_standard_input_lies_beside_no_surface(
    pipe: Pipe, tmp_path: Path, capsys: Capture
) -> None:
    plan = tmp_path / "plan.json"
    plan.write_text(text(BEST), encoding="utf-8")
    pipe((INSTANCES / "scenes" / "wok.json").read_bytes())  # names wok.surface.json
    assert run("check", "-", plan, "--json") == 2
    error = CheckError.from_document(printed(capsys))
    assert (error.at_file, error.at_field) == ("standard input", "surface")
    assert "give the file, or the surface" in error.error


def kept_for_the_row(row: Path, pipe: Pipe, folder: Path, capsys: Capture) -> Path:
    pipe(text(BEST))
    assert run("check", row, "-", "--cache", folder) == 0
    capsys.readouterr()
    (kept,) = folder.iterdir()
    return kept


@pytest.mark.parametrize(
    "tampered",
    [
        {"lower": 2, "upper": 2},
        {"lower": 3, "upper": 3, "solutions": []},
        {"solutions": [[]]},
        {"seconds": "long"},
    ],
)
def test_numbers_in_a_kept_file_are_not_believed(
    row: Path, pipe: Pipe, tmp_path: Path, capsys: Capture, tampered: dict[str, Any]
) -> None:
    """The row can be painted in one color; somebody has written other things into the file."""
    kept = kept_for_the_row(row, pipe, tmp_path / "c", capsys)
    document = json.loads(kept.read_text(encoding="utf-8"))
    kept.write_text(json.dumps(document | tampered), encoding="utf-8")
    pipe(text(WORSE))
    assert run("check", row, "-", "--cache", tmp_path / "c", "--json") == 0
    verdict = PlanVerdict.from_document(printed(capsys))
    assert (verdict.lower_bound, verdict.upper_bound, verdict.optimal) == (1, 1, False)


@pytest.mark.parametrize("content", ["", "{", "[" * 100_000, '{"a":' * 2_000 + "1" + "}" * 2_000])
def test_a_kept_file_that_cannot_be_read_is_proved_anew(
    row: Path, pipe: Pipe, tmp_path: Path, capsys: Capture, content: str
) -> None:
    kept_for_the_row(row, pipe, tmp_path / "c", capsys).write_text(content)
    pipe(text(BEST))
    assert run("check", row, "-", "--cache", tmp_path / "c", "--require-optimal") == 0


# Two arms in red and two in blue at a bar in both: two segments if the bar is divided, else three.
BAR = drawn(
    "AA.AA AA.AA MMMMM MMMMM BB.BB BB.BB", {"A": [RED], "M": [RED, BLUE], "B": [BLUE], ".": []}
)
BAR_RED = [*[RED, RED, None, RED, RED] * 2, *[RED] * 10, *[BLUE, BLUE, None, BLUE, BLUE] * 2]


def whole_cells_of_the_bar(solution: Document) -> Document:
    """The bar in red as a whole, which is legal, and a bound that says that it is the best."""
    forged: Document = json.loads(json.dumps(solution))
    for cell in forged["cells"]:
        cell["subcells"] = (
            cell["subcells"][:1]
            if len(cell["subcells"]) == 1
            else [sub for sub in cell["subcells"] if sub["color"] == RED]
        )
        if cell["subcells"][0]["color"] == BLUE:
            cell["subcells"][0]["darts"] = []
    numbers: dict[object, int] = {}
    for cell in forged["cells"]:
        (sub,) = cell["subcells"]
        own = "red" if sub["color"] == RED else cell["id"]
        sub["segment"] = numbers.setdefault(own, len(numbers))
    forged |= {"segments": 3, "lift_offs": 2, "lower_bound": 3, "surface_lower_bound": 3}
    forged["bounds"] = [{"kind": "search", "value": 3, "holds_for": "surface"}]
    return forged


def test_a_kept_bound_without_certificate_makes_nothing_optimal(
    tmp_path: Path, pipe: Pipe, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    bar = tmp_path / "bar.surface.json"
    bar.write_text(BAR.to_json(), encoding="utf-8")
    plan = Plan(tuple(BAR_RED)).to_json()
    asked = ("check", bar, "-", "--cache", tmp_path / "c", "--json", "--require-optimal")
    pipe(plan)
    assert run(*asked) == 1
    assert printed(capsys)["lower_bound"] == 2
    (kept,) = (tmp_path / "c").iterdir()
    document = json.loads(kept.read_text(encoding="utf-8"))
    forged = whole_cells_of_the_bar(document["solutions"][0])
    kept.write_text(json.dumps(document | {"solutions": [forged]}), encoding="utf-8")
    # Without time to prove it anew the bound is told, and nothing rests on it.
    with monkeypatch.context() as hurried:
        nothing = Proof(ProvenRange(1, 26))
        hurried.setattr(cellcolor.door.oracle, "prove", lambda *_, **__: nothing)
        pipe(plan)
        assert run(*asked) == 3
    verdict = PlanVerdict.from_document(printed(capsys))
    assert verdict.optimal is None and verdict.lower_bound == 1
    assert verdict.kept_lower_bound == 3 and "kept, not verified: at least 3" in verdict.text
    # With time it is refuted, and the verdict is the first one again.
    pipe(plan)
    assert run(*asked) == 1
    verdict = PlanVerdict.from_document(printed(capsys))
    assert verdict.upper_bound == 2 and verdict.optimal is False


def test_out_of_time_is_an_error_of_its_own_code(
    row: Path, pipe: Pipe, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def out_of_time(_path: Path, _deadline: Deadline, _tolerance: None) -> None:
        raise OutOfTime

    monkeypatch.setattr("cellcolor.cli.checking.read_subject", out_of_time)
    pipe(text(BEST))
    assert run("check", row, "-", "--json") == 3
    error = CheckError.from_document(printed(capsys))
    assert (error.exit_code, error.at_file) == (3, str(row))


def test_standard_input_is_one_of_the_two(capsys: Capture) -> None:
    assert run("check", "-", "-") == 2
    assert "only one of the two" in capsys.readouterr().err


@pytest.mark.parametrize("at_hand", [True, False])
def test_an_edited_graph_is_held_against_its_surface(
    at_hand: bool, tmp_path: Path, capsys: Capture
) -> None:
    """The edge along a crack is dead; the edited graph has it joined."""
    surface = LabelledSurface.read(PAPER / "crack-separates.surface.json")
    made = decomposition_of(surface, "part.surface.json").instance
    instance = json.loads(made.to_json())
    (dead,) = (edge for edge in instance["edges"] if edge.get("colors") == [])
    del dead["colors"]
    graph, solution = tmp_path / "part.json", tmp_path / "solution.json"
    graph.write_text(json.dumps(instance), encoding="utf-8")
    run("solve", graph, "-o", solution)
    if at_hand:
        (tmp_path / "part.surface.json").write_text(surface.to_json(), encoding="utf-8")
    capsys.readouterr()
    code = run("check", graph, solution, "--json")
    said = json.loads(capsys.readouterr().out)
    if at_hand:
        assert code == 2
        assert "not those on the surface" in said["error"]
    else:
        assert code == 0
        assert said["claimed"]["instance.surface"] == "part.surface.json"
