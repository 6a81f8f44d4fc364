"""``check`` and ``show`` on whatever was solved; ``solve`` against what is said to be known."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import json_lines, run
from library import PAPER
from pages import small_wok

Capture = pytest.CaptureFixture[str]

RING = PAPER / "ring.json"
SPLIT = PAPER / "split-cell.json"
ZEROS = PAPER / "crossing-zeros.json"
SURFACE = ["--search-space", "surface"]
FEW = ["--all", "--limit", "2"]
CORRIDORS = PAPER / "parallel-corridors.json"


class TestWhatWasSolved:
    """A solution goes with the instance, the surface and the scene alike."""

    def test_surface(self, tmp_path: Path, capsys: Capture) -> None:
        surface, instance = tmp_path / "a.surface.json", tmp_path / "sub" / "a.json"
        instance.parent.mkdir()
        surface.write_text((PAPER / "split-cell.surface.json").read_text("utf-8"), "utf-8")
        assert run("build", surface, "-o", instance) == 0
        for number, solved in enumerate((surface, instance)):
            solution = tmp_path / f"{number}.json"
            assert run("solve", solved, "-o", solution) == 0
            for subject in (surface, instance):
                assert run("check", subject, solution) == 0, capsys.readouterr()
                assert run("show", subject, solution, "-o", tmp_path / "x.html") == 0
        schemes = tmp_path / "all.jsonl"
        assert run("solve", surface, "--all", "-o", schemes) == 0
        assert run("check", surface, schemes) == 0
        assert "1 scheme\n" in capsys.readouterr().out
        assert run("check", PAPER / "ring.surface.json", schemes) == 1
        assert "instance.sha256" in capsys.readouterr().out

    def test_scene(self, tmp_path: Path, capsys: Capture) -> None:
        scene = small_wok(tmp_path)
        built, solution = tmp_path / "wok.json", tmp_path / "solution.json"
        assert run("solve", scene, "-o", solution) == 0
        # Built again, its timings are other ones; the solution still fits.
        assert run("build", scene, "-o", built) == 0
        for subject in (scene, built, tmp_path / "wok.surface.json"):
            assert run("check", subject, solution) == 0, capsys.readouterr()
            assert run("show", subject, solution, "-o", tmp_path / "x.html") == 0
        plan = tmp_path / "plan.json"
        plan.write_text(json.dumps({"format": "cellcolor/plan", "version": 1, "vertex_colors": []}))
        capsys.readouterr()
        assert run("check", scene, plan) == 1
        assert "0 entries" in capsys.readouterr().out

    def test_claims_are_called_claims(self, tmp_path: Path, capsys: Capture) -> None:
        """A bound without a certificate is a claim, and so is all that hangs on it."""
        solution = tmp_path / "solution.json"
        assert run("solve", RING, "-o", solution) == 0
        bare = json.loads(solution.read_text())
        for bound in bare["bounds"]:
            del bound["certificate"]
        solution.write_text(json.dumps(bare))
        capsys.readouterr()
        assert run("check", RING, solution) == 0
        (line,) = [x for x in capsys.readouterr().out.splitlines() if "not verified" in x]
        assert line.strip() == (
            'claimed, not verified: lower_bound 2, surface_lower_bound 2, status "optimal", '
            "proved_for_surface true"
        )
        assert run("check", RING, solution, "--json") == 0
        (document,) = json_lines(capsys.readouterr().out)
        assert document["claimed"] == {
            "lower_bound": 2,
            "surface_lower_bound": 2,
            "status": "optimal",
            "proved_for_surface": True,
        }

    def test_what_is_verified_is_said(self, tmp_path: Path, capsys: Capture) -> None:
        solution = tmp_path / "solution.json"
        assert run("solve", RING, "-o", solution) == 0
        capsys.readouterr()
        assert run("check", RING, solution) == 0
        out = capsys.readouterr().out
        assert "at least 2 by cover: verified, 0 of 200000 choices tried" in out
        assert "claimed" not in out and "by CP-SAT" not in out
        assert run("check", RING, solution, "--json") == 0
        (document,) = json_lines(capsys.readouterr().out)
        assert document["claimed"] == {}
        (bound,) = document["bounds"]
        assert (bound["kind"], bound["value"], bound["outcome"]) == ("cover", 2, "verified")
        assert (bound["tried"], bound["budget"]) == (0, 200_000)
        assert (document["bounds_by_solver"], document["solver"]) == (0, "cp-sat")

    @pytest.mark.parametrize(("solver", "name"), [("cp-sat", "CP-SAT"), ("dfs-cover", "dfs-cover")])
    def test_what_rests_on_a_solver_is_said_and_counted(
        self, solver: str, name: str, tmp_path: Path, capsys: Capture
    ) -> None:
        """The paper's space needs a segment more here than the surface, which nothing verifies."""
        solution = tmp_path / "solution.json"
        assert run("solve", CORRIDORS, "-o", solution, "--solver", solver) == 0
        capsys.readouterr()
        assert run("check", CORRIDORS, solution) == 0
        lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
        unverified = [line for line in lines if line.endswith(f": no certificate, by {name}")]
        (counted,) = [line for line in lines if line.endswith(f"bounds by {name}")]
        assert counted.startswith(f"{len(unverified)} of ") and unverified
        assert run("check", CORRIDORS, solution, "--json") == 0
        (document,) = json_lines(capsys.readouterr().out)
        assert document["bounds_by_solver"] == len(unverified)
        assert {b["outcome"] for b in document["bounds"]} <= {"verified", "no certificate"}

    def test_a_forged_certificate_makes_a_solution_invalid(
        self, tmp_path: Path, capsys: Capture
    ) -> None:
        solution = tmp_path / "solution.json"
        assert run("solve", RING, "-o", solution) == 0
        forged = json.loads(solution.read_text())
        forged["bounds"][0]["certificate"]["cells"] = [0, 0]
        solution.write_text(json.dumps(forged))
        capsys.readouterr()
        assert run("check", RING, solution) == 1
        out = capsys.readouterr().out
        assert "bounds[0].certificate: fewer than 2 color regions" in out
        assert "at least 2 by cover: refused, fewer than 2 color regions" in out


class TestKnown:
    @pytest.mark.parametrize(
        ("path", "known", "options", "expected"),
        [
            (SPLIT, {"paper": {"segments": 3}}, [], "the division found has 2"),
            (SPLIT, {"paper": {"segments": 1}}, [], "the lower bound found is 2"),
            (SPLIT, {"surface": {"segments": 3}}, [], "the division found has 2"),
            (SPLIT, {"surface": {"segments": 1}}, [], "the lower bound found is 2"),
            (SPLIT, {"paper": {"segments": 1}}, SURFACE, "the lower bound found is 2"),
            (ZEROS, {"paper": {"segments": 2, "schemes": 4}}, ["--all"], "4 are said to be all, 3"),
            (ZEROS, {"paper": {"segments": 2, "schemes": 1}}, FEW, "1 are said to be all, 2 are"),
        ],
    )
    def test_a_contradiction_is_an_error(
        self,
        path: Path,
        known: dict[str, dict[str, int]],
        options: list[str],
        expected: str,
        tmp_path: Path,
        capsys: Capture,
    ) -> None:
        document = json.loads(path.read_text("utf-8")) | {"known": known}
        wrong, out = tmp_path / "wrong.json", tmp_path / "out.json"
        wrong.write_text(json.dumps(document), "utf-8")
        assert run("solve", wrong, *options, "-o", out) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert f"{wrong}: contradiction: known." in line and expected in line
        # What was found is right by the checker, and kept.
        assert run("check", path, out) == 0
        assert run("check", wrong, out) == 1
        capsys.readouterr()
        assert run("solve", wrong, RING, *options, "--json") == 1
        first, second = json_lines(capsys.readouterr().out)
        assert first["segments"] == 2 and "error" not in second
        assert first["error"].startswith("known.")
