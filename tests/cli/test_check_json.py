"""``check`` for programs in other languages: one JSON object, standard input, exit codes."""

from __future__ import annotations

import io
import json
from contextlib import redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from commands import run
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import drawn, surfaces
from piped import BEST, BLUE, RED, ROW, WORSE, Capture, Pipe, printed, text

import cellcolor
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.verdicts import CheckError, PlanVerdict, SolutionVerdict
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.testing.strategies import broken_plans, valid_plans
from examples import examples

WRONG = [BLUE] + [RED] * 17
RING = PAPER / "ring.json"


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


@pytest.mark.parametrize("option", [["--require-optimal"], ["--cache", "c"]])
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
