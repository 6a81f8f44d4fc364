"""``cellcolor plan``: the folder, its files, what is said, and how it ends."""

from __future__ import annotations

import html
import json
import os
import re
import signal
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import trimesh
from commands import run
from shipped import edited, wok_file
from stand_in import stand_in

import cellcolor
import cellcolor.door.planning
import cellcolor.motion.plan
import cellcolor.motion.scene_painting
import cellcolor.trajectory_checker.check
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.deadline import OutOfTime
from cellcolor.door.planned import KINDS
from cellcolor.errors import InputError
from cellcolor.exports.registry import EXPORTS
from cellcolor.frontend.scene import Scene
from cellcolor.questions.answers import Explanation, RelaxedMinimum
from cellcolor.questions.placements import PlacedMinimum, Placements

OTHER_ARMS = {name for name in KINDS if name.endswith((".mod", ".src", ".ls"))}
Capture = pytest.CaptureFixture[str]
FILES = {
    "instance.json": Instance,
    "instance.surface.json": LabelledSurface,
    "solution.json": Solution,
    "painted.surface.json": LabelledSurface,
    "painted.plan.json": Plan,
    "paths.json": ToolPaths,
    "trajectory.json": Trajectory,
    "verdict.json": TrajectoryVerdict,
}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "scene").mkdir()
    return wok_file(tmp_path / "scene", target_vertices=200)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Motion and verdict are taken from a stand-in; what was asked for is kept."""
    made, seen = stand_in(), {"verdict": None, "unplanned": ()}

    def motion(built: Any, *_: Any, **options: Any) -> Any:
        seen.update(options, motion=built.prepared.setup.motion, built=built)
        trajectory = replace(made.trajectory, unplanned=seen["unplanned"], extra_lift_offs=())
        return SimpleNamespace(paths=made.paths, trajectory=trajectory, cut_off=())

    def verdict(*_: Any, **options: Any) -> TrajectoryVerdict:
        seen.update(options)
        whole = replace(made.verdict, valid=True, faults=(), fault_counts={})
        return seen["verdict"] or whole

    monkeypatch.setattr(cellcolor.motion.plan, "plan_motion", motion)
    monkeypatch.setattr(cellcolor.trajectory_checker.check, "check_trajectory", verdict)
    return seen


def test_all_files_are_there_and_belong_together(
    scene: Path, tmp_path: Path, asked: dict[str, Any], capsys: Capture
) -> None:
    folder = tmp_path / "new" / "folder"
    assert run("plan", scene, "-o", folder) == 0
    assert {file.name for file in folder.iterdir()} == set(KINDS) - OTHER_ARMS
    read = {name: kind.read(folder / name) for name, kind in FILES.items()}
    assert read["paths.json"].surface_sha256 == read["painted.surface.json"].sha256
    assert run("check", folder / "instance.json", folder / "solution.json") == 0
    painted = [folder / "painted.surface.json", folder / "painted.plan.json"]
    assert run("check", *painted) == 0
    assert asked["minimum_lift_offs"] == read["solution.json"].lift_offs == 1
    # The instance is what `build` would have made, its surface and side file beside it.
    reasons = ["--view", "reasons", "-o", tmp_path / "reach.html"]
    assert run("show", folder / "instance.json", *reasons) == 0
    said = capsys.readouterr()
    assert "2 segments, 1 lift-off, optimal" in said.out
    assert f"wrote {len(list(folder.iterdir()))} files to {folder}" in said.out
    assert "report.html" in said.out
    page = (folder / "report.html").read_text("utf-8")
    assert "cellcolor.script and cellcolor_linear.script: joint moves" in page
    assert "No parser of the maker" in page
    assert "warning: the object's edges are up to" in said.err  # what `build` warns of


def test_keys_of_the_setup_are_replaced(scene: Path, tmp_path: Path, asked: dict[str, Any]) -> None:
    options = ["--spacing-m", "0.02", "--speed-m-per-s", "0.1", "--home-rad", "0,-1,1,-1,-1,0"]
    options += ["--even-feed", "--least-feed", "0.5"]
    assert run("plan", scene, "-o", tmp_path / "a", "--pattern", "contour", *options) == 0
    motion = asked["motion"]
    assert (motion.spacing_m, motion.speed_m_per_s) == (0.02, 0.1)
    assert motion.home_rad == (0, -1, 1, -1, -1, 0)
    assert (motion.even_feed, motion.least_feed) == (True, 0.5)
    assert motion.tool_radius_m == 0.015  # of the setup
    assert asked["pattern"] == "contour"
    # What the surface is does not depend on how the arm moves later.
    surface = LabelledSurface.read(tmp_path / "a" / "instance.surface.json")
    built = cellcolor.build(scene).surface
    assert surface.sha256 == built.sha256
    for key in ("scene", "setup"):
        assert surface.meta[key] == built.meta[key]


def without_motion(scene: Path) -> Path:
    setup = scene.parent / "ur5_polishing.toml"
    setup.write_text(re.sub(r"\[motion\].*", "", setup.read_text(), flags=re.DOTALL))
    return scene


def test_without_a_table_the_needed_key_is_named(
    scene: Path, tmp_path: Path, asked: dict[str, Any], capsys: Capture
) -> None:
    without_motion(scene)
    assert run("plan", scene, "-o", tmp_path / "a") == 2
    assert "ur5_polishing.toml: motion: " in capsys.readouterr().err
    assert run("plan", scene, "-o", tmp_path / "a", "--spacing-m", "0.02") == 2
    assert "motion.joint_accelerations_rad_per_s2" in capsys.readouterr().err
    assert not (tmp_path / "a").exists()
    needed = ["--joint-accelerations-rad-per-s2", "8,8,8,8,8,8"]
    assert run("plan", scene, "-o", tmp_path / "a", *needed) == 0
    assert asked["motion"].spacing_m == 0.01


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["--spacing-m", "0"], "motion.spacing_m"),
        (["--spacing-m", "wide"], "--spacing-m"),
        (["--home-rad", "0,1"], "motion.home_rad"),
        (["--home-rad", "0,1,x,0,0,0"], "--home-rad"),
        (["--pattern", "zigzag"], "pattern"),
        (["--pattern", "back-and-forth:x"], "pattern"),
        (["--time-limit", "-1"], "time_limit"),
    ],
)
def test_bad_options_are_one_line(
    options: list[str], named: str, scene: Path, tmp_path: Path, capsys: Capture
) -> None:
    assert run("plan", scene, "-o", tmp_path / "a", *options) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert named in line
    assert not (tmp_path / "a").exists()


@pytest.mark.usefixtures("asked")
def test_what_is_no_plan_of_ours_is_kept(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "joints.csv").write_text("a,b\n1,2\n")
    assert run("plan", scene, "-o", folder) == 2
    assert "joints.csv" in capsys.readouterr().err
    assert [file.name for file in folder.iterdir()] == ["joints.csv"]
    (folder / "joints.csv").unlink()
    assert run("plan", scene, "-o", folder / "scene.txt" / "deeper") == 0
    assert run("plan", scene, "-o", scene) == 2
    surface = folder / "scene.txt" / "deeper" / "painted.surface.json"
    assert run("plan", surface, "-o", folder) == 2
    assert "is no scene" in capsys.readouterr().err


def test_how_it_ends_is_what_the_judge_says(
    scene: Path, tmp_path: Path, asked: dict[str, Any], capsys: Capture
) -> None:
    folder = tmp_path / "a"
    found = stand_in().verdict
    fault = found.faults[0]
    unplanned = replace(fault, kind="unplanned", text="a move was not planned")
    asked["unplanned"] = (3,)
    asked["verdict"] = replace(
        found, valid=False, faults=(unplanned,), fault_counts={"unplanned": 1}
    )
    assert run("plan", scene, "-o", folder) == 3
    assert "must not drive" in capsys.readouterr().out
    jump = replace(fault, kind="jump", text="turns by 360 degrees")
    asked["verdict"] = replace(found, faults=(jump,), fault_counts={"jump": 1, "unplanned": 1})
    assert run("plan", scene, "-o", folder) == 1
    assert "turns by 360 degrees" in capsys.readouterr().out
    assert json.loads((folder / "verdict.json").read_text())["valid"] is False
    assert "must not drive" in (folder / "report.html").read_text(encoding="utf-8")


def out_of_time(laid: bool) -> Any:
    """A planner whose time is up after the tool paths were laid, or before."""
    made = stand_in()

    def motion(*_: Any, on_paths: Any, **__: Any) -> None:
        if laid:
            on_paths(made.paths)
        raise OutOfTime("the time limit came first")

    return motion


def test_a_time_limit_leaves_what_there_is(
    scene: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Never a trajectory that no judge has seen."""
    motion, folder = {"trajectory.json", "verdict.json", *EXPORTS}, tmp_path / "a"
    for laid, missing in (
        (False, "the tool paths were laid out"),
        (True, "motion on the tool paths"),
    ):
        monkeypatch.setattr(cellcolor.motion.plan, "plan_motion", out_of_time(laid))
        assert run("plan", scene, "-o", folder) == 3
        there = {file.name for file in folder.iterdir()}
        assert there == set(KINDS) - motion - (set() if laid else {"paths.json"})
        said = capsys.readouterr()
        assert missing in said.err
        assert "2 segments, 1 lift-off, optimal" in said.out
        page = (folder / "report.html").read_text(encoding="utf-8")
        assert "What is missing" in page
        assert missing in page
    assert run("check", folder / "instance.json", folder / "solution.json") == 0
    assert run("check", folder / "painted.surface.json", folder / "painted.plan.json") == 0
    # A run that gets less far does not mix its files with these.
    kept = {file: file.read_bytes() for file in folder.iterdir()}
    monkeypatch.setattr(cellcolor.motion.plan, "plan_motion", out_of_time(laid=False))
    capsys.readouterr()
    assert run("plan", scene, "-o", folder) == 3
    assert "paths.json: belongs to a plan that got further" in capsys.readouterr().err
    assert {file: file.read_bytes() for file in folder.iterdir()} == kept


def test_a_time_limit_before_the_painting_leaves_the_number(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def painting(*_: Any, **__: Any) -> None:
        raise OutOfTime("the time limit came first")

    monkeypatch.setattr(cellcolor.motion.scene_painting, "paint_scene", painting)
    cut = "before the segments were painted"
    with pytest.raises(cellcolor.PlanOutOfTime, match=cut) as stopped:
        cellcolor.plan(scene)
    assert stopped.value.unfinished.solution.lift_offs == 1
    written = stopped.value.unfinished.save(tmp_path / "a")
    assert {file.name for file in (tmp_path / "a").iterdir()} == set(written)
    assert {"instance.json", "solution.json", "report.html"} <= set(written)
    assert not [name for name in written if "painted" in name]


@pytest.mark.second
@pytest.mark.usefixtures("asked")
def test_a_question_without_an_answer_is_said_with_the_reason(
    scene: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the terminal and on the page, with exit code 3; the others are answered."""
    asked: list[str] = []

    def question(name: str, end: Exception | Any) -> None:
        def answer(*_: Any, **__: Any) -> Any:
            asked.append(name)
            if isinstance(end, Exception):
                raise end
            return end

        monkeypatch.setattr(cellcolor.door.planning, name, answer)

    minimum = RelaxedMinimum((), (), 2, 2, 1.0, 1.0, True)
    here = PlacedMinimum((0.5, 0, 0, 0, 0, 0), 2, 1.0, True, 200)
    question("tradeoff", OutOfTime("the time limit came first"))
    question("explain", Explanation("wok", minimum, (), complete=False))
    question("place", Placements("wok", 1.0, here, (), ()))
    options = ["--ask", "place", "--ask", "tradeoff", "--ask", "explain"]
    assert run("plan", scene, "-o", tmp_path / "a", *options) == 3
    assert asked == ["tradeoff", "explain", "place"]
    said, page = capsys.readouterr().out, (tmp_path / "a" / "report.html").read_text("utf-8")
    for line in (
        "tradeoff: not answered, the time limit came first",
        "explain: answered in part, the time limit came first",
    ):
        assert line in said.splitlines() and line in page
    assert "place: not" not in said
    question("tradeoff", cellcolor.tradeoff(stand_in().built))
    assert run("plan", scene, "-o", tmp_path / "b", "--ask", "tradeoff") == 0
    # A question that cannot be asked does not cost the plan.
    question("place", InputError(None, "x", "the range is empty"))
    assert run("plan", scene, "-o", tmp_path / "c", "--ask", "place") == 3
    assert "place: not answered: x: the range is empty" in capsys.readouterr().out
    assert (tmp_path / "c" / "trajectory.json").exists()


def test_questions_after_a_plan_that_is_not_ready_are_said(
    scene: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cellcolor.motion.plan, "plan_motion", out_of_time(laid=False))
    assert run("plan", scene, "-o", tmp_path / "a", "--ask", "place") == 3
    line = "place: not asked, the time limit came first"
    assert line in capsys.readouterr().err
    assert line in (tmp_path / "a" / "report.html").read_text("utf-8")


@pytest.mark.usefixtures("asked")
@pytest.mark.parametrize(("table", "code"), [("", 0), ('[controller]\nlanguage = "urscript"', 3)])
def test_a_program_that_is_not_written_is_said_with_the_reason(
    table: str, code: int, scene: Path, tmp_path: Path, capsys: Capture
) -> None:
    """With exit code 3 if the setup asks for it by naming the controller."""
    setup = scene.parent / "ur5_polishing.toml"
    setup.write_text(f"{setup.read_text()}\n{table}\n")
    urdf = next(scene.parent.glob("**/ur5.urdf"))
    turned = urdf.read_text().replace("wrist_3_joint", "hand_joint")
    urdf.write_text(turned)
    folder = tmp_path / "a"
    assert run("plan", scene, "-o", folder) == code
    said, page = capsys.readouterr().out, (folder / "report.html").read_text("utf-8")
    reason = "named as those of Universal Robots" if table else "the setup names no controller"
    (line,) = [one for one in said.splitlines() if one.startswith("program for a controller: not")]
    assert reason in line and line in html.unescape(page)
    written = list(folder.iterdir())
    assert f"wrote {len(written)} files" in said
    assert not [file for file in written if file.name.startswith("cellcolor")]


@pytest.mark.usefixtures("asked")
def test_a_base_link_that_is_not_there_is_refused_at_once(
    scene: Path, tmp_path: Path, capsys: Capture
) -> None:
    setup = scene.parent / "ur5_polishing.toml"
    table = '[controller]\nlanguage = "urscript"\nbase_link = "pedestal"\n'
    setup.write_text(f"{setup.read_text()}\n{table}")
    assert run("plan", scene, "-o", tmp_path / "a") == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "controller.base_link: no link 'pedestal'" in line


def test_a_signal_on_the_way_leaves_nothing(
    scene: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: Any, **__: Any) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        raise OutOfTime("the time limit came first")

    monkeypatch.setattr(cellcolor.motion.plan, "plan_motion", stopped)
    assert run("plan", scene, "-o", tmp_path / "a") == 3
    assert not (tmp_path / "a").exists()
    said = capsys.readouterr()
    assert said.out == ""
    assert "interrupted" in said.err


@pytest.mark.parametrize(
    ("place", "reason", "remedy"),
    [
        ("[9.0, 0.0, 0.0]", "no solution", "move the part nearer"),
        ("[0.6, 0.0, -0.6]", "tip blocked", "below the ground"),
        ("turned inside out", "warning", "reverse its faces"),
    ],
)
def test_where_nothing_can_be_covered_it_says_what_build_says(
    place: str, reason: str, remedy: str, scene: Path, tmp_path: Path, capsys: Capture
) -> None:
    if place.startswith("["):
        text = edited(scene.read_text(), position_m=place)
    else:
        wok = Scene.read(scene).object.surface(scene.parent)
        trimesh.Trimesh(wok.vertices, wok.faces[:, ::-1], process=False).export(
            scene.parent / "wok.ply"
        )
        part = '[object]\nkind = "mesh"\nfile = "wok.ply"\nmeters_per_unit = 1.0\n\n[placement]'
        text = re.sub(r"\[object\].*\[placement\]", part, scene.read_text(), flags=re.DOTALL)
    scene.write_text(text)
    assert run("build", scene, "-o", tmp_path / "i.json") == 3
    built = capsys.readouterr().out.splitlines()
    assert run("plan", scene, "-o", tmp_path / "a") == 2
    planned = capsys.readouterr()
    seen = [line for line in planned.out.splitlines() if not line.startswith("seconds")]
    assert set(seen) <= set(built)
    assert any(line.strip().startswith(reason) for line in seen)
    (line,) = planned.err.splitlines()
    assert remedy in line
    assert any(remedy in line for line in built)
    assert not (tmp_path / "a").exists()


def test_a_time_limit_too_short_for_anything(scene: Path, tmp_path: Path, capsys: Capture) -> None:
    assert run("plan", scene, "-o", tmp_path / "a", "--time-limit", "0.001") == 3
    assert "time limit" in capsys.readouterr().err
    assert not (tmp_path / "a").exists()
