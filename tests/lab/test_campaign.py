"""The campaign: it finds solvers that are wrong, and makes what it finds small."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import replace
from itertools import islice
from pathlib import Path

import pytest
from library import PAPER
from odd_jobs import HereWorkers
from vertex_minima import vertex_minimum

from cellcolor.cli import main
from cellcolor.data.bounds import Bound, greatest
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import Disagreement, RefusedResult
from cellcolor.lab.campaign.agreement import (
    Finding,
    MeshFinding,
    compare_on_mesh,
    compare_solvers,
    fewest_by_vertices,
)
from cellcolor.lab.campaign.pool import (
    KINDS,
    Outcome,
    Summary,
    Wrong,
    draw_case,
    examine,
    outcomes_of_campaign,
)
from cellcolor.lab.campaign.shrink import shrink_instance, shrink_surface
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.lab.workers import Task
from cellcolor.processes import Ended
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.dfs import ReferenceSolver
from cellcolor.solvers.interface import Answer, OnProgress, Options

pytestmark = pytest.mark.slow

RING = Instance.read(PAPER / "ring.json")
EVERY_KIND = len(KINDS)


def has_busy_cell(instance: Instance) -> bool:
    return instance.most_live_darts >= 3


def boast(
    self: CpSatSolver, instance: Instance, options: Options, progress: OnProgress | None = None
) -> Answer:
    """Wrong on purpose: where a cell has three live darts, one segment more is claimed."""
    answer = right_minimize(self, instance, options, progress)
    if options.search_space == "surface" or not has_busy_cell(instance):
        return answer
    return replace(
        answer, division=None, bounds=(Bound("model", answer.lower_bound + 1, "strands"),)
    )


def believe_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the checker believe bounds that a painting of whole cells would refute at once."""
    monkeypatch.setattr("cellcolor.checker.claimed_numbers.segments_of_whole_cells", lambda _: 1000)


right_minimize = CpSatSolver.minimize
right_schemes = ReferenceSolver.optimal_schemes


def test_solvers_agree_on_every_kind() -> None:
    outcomes = list(outcomes_of_campaign(2 * EVERY_KIND, 7, 20.0, HereWorkers()))
    assert [outcome.number for outcome in outcomes] == list(range(2 * EVERY_KIND))
    for outcome in outcomes:
        assert not outcome.wrong, (outcome.kind, outcome.wrong)
        assert outcome.finding is not None and outcome.finding.minimum is not None
    summary = Summary()
    for outcome in outcomes:
        summary.add(outcome)
    assert summary.total.scheme_sets >= EVERY_KIND and summary.total.meshes >= 5
    assert all(kind.instances == 2 for kind in summary.kinds.values())


def test_instances_are_a_function_of_seed_and_number() -> None:
    for number in range(EVERY_KIND):
        one, again, other = draw_case(3, number), draw_case(3, number), draw_case(4, number)
        assert one.instance.to_json() == again.instance.to_json() != other.instance.to_json()
        assert one.kind == KINDS[number]
        several = one.kind == "islands, holes"
        assert (one.instance.most_live_loops > 1) == several


def test_the_command_on_two_processes() -> None:
    command = [sys.executable, "-m", "cellcolor", "bench", "campaign"]
    command += ["--count", "4", "--jobs", "2"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    expected = Summary()
    for outcome in outcomes_of_campaign(4, 0, 20.0, HereWorkers()):
        expected.add(outcome)
    for name, bins in expected.histograms().items():
        assert f"{name}: " + ", ".join(f"{v}: {n}" for v, n in bins) in done.stdout.splitlines()


def test_a_wrong_minimum_is_noticed_and_made_small(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    believe_bounds(monkeypatch)
    monkeypatch.setattr(CpSatSolver, "minimize", boast)
    monkeypatch.setattr("cellcolor.cli.campaign.workers_for", lambda *_: HereWorkers())
    kept = tmp_path / "kept"
    number = next(n for n in range(9) if has_busy_cell(draw_case(0, n).instance))
    assert main(["bench", "campaign", "--count", str(number + 1), "-o", str(kept)]) == 1
    file = kept / f"campaign_0_{number}.json"
    assert f"{file}: dfs-cover has" in capsys.readouterr().err
    small = Instance.read(file)
    assert small.meta is not None and small.meta["campaign"]["number"] == number
    # Three live darts in one cell, each joinable in one color, are all that it takes.
    assert all(len(small.joinable(edge.id)) == 1 for edge in small.edges)
    assert len(small.edges) <= 3 and small.most_live_darts == 3
    with pytest.raises(Disagreement):
        compare_solvers(small, 10.0)
    monkeypatch.undo()
    compare_solvers(small, 10.0)


def test_a_lost_scheme_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def without_the_first(
        self: ReferenceSolver, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        yield from islice(right_schemes(self, instance, options, segments), 1, None)

    figure = Instance.read(PAPER / "split-cell.json")  # its only optimum has a cutting path
    assert compare_solvers(figure, 10.0).always_cut
    monkeypatch.setattr(ReferenceSolver, "optimal_schemes", without_the_first)
    with pytest.raises(RefusedResult, match="dfs-cover found no scheme with 2 segments"):
        compare_solvers(figure, 10.0)
    figure = Instance.read(PAPER / "crossing-zeros.json")  # three optimal schemes
    with pytest.raises(
        Disagreement, match="cp-sat lists 1 optimal schemes that dfs-cover does not, dfs-cover 0"
    ):
        compare_solvers(figure, 10.0)


def test_a_scheme_listed_twice_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def twice(
        self: ReferenceSolver, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        for division in right_schemes(self, instance, options, segments):
            yield division
            yield division

    monkeypatch.setattr(ReferenceSolver, "optimal_schemes", twice)
    with pytest.raises(Disagreement, match="dfs-cover lists a scheme twice"):
        compare_solvers(RING, 10.0)


def test_a_bound_above_a_coloring_of_the_vertices_is_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def boastful(
        self: CpSatSolver, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        answer = right_minimize(self, instance, options, progress)
        if options.search_space == "paper":
            return answer
        bound = Bound("crossings", greatest(answer.bounds, "surface") + 1, "surface")
        return replace(answer, division=None, bounds=(bound,))

    number = KINDS.index("thin blobs")
    fine = examine(0, 20.0, number)
    assert not fine.wrong and fine.mesh is not None
    believe_bounds(monkeypatch)
    monkeypatch.setattr(CpSatSolver, "minimize", boastful)
    monkeypatch.setattr("cellcolor.lab.campaign.pool.SHRINK_SECONDS", 3.0)
    (wrong,) = examine(0, 20.0, number).wrong
    assert "a coloring of the vertices has" in wrong.message
    surface = draw_case(0, number).surface
    assert surface is not None
    small = LabelledSurface.from_document(json.loads(wrong.document))
    assert sum(map(len, small.vertex_colors)) < sum(map(len, surface.vertex_colors))


def test_a_solver_that_breaks_down_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> Answer:
        raise RuntimeError("no idea")

    monkeypatch.setattr(CpSatSolver, "minimize", broken)
    (wrong,) = examine(0, 20.0, KINDS.index("hubs")).wrong
    assert wrong.message == "RuntimeError: no idea"


def test_what_ends_its_process_is_a_disagreement_and_loses_no_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As if number 1 killed its process, alone or together with others."""

    class Deadly(HereWorkers):
        def submit(self, task: Task, /) -> Future[Ended]:
            if 1 not in task.arguments[2]:
                return super().submit(task)
            future: Future[Ended] = Future()
            future.set_result(Ended("crashed", error="ended by SIGSEGV", seconds=1.0))
            return future

    monkeypatch.setattr("cellcolor.lab.campaign.pool._TOGETHER", 2)
    outcomes = list(outcomes_of_campaign(4, 0, 20.0, Deadly()))
    assert sorted(outcome.number for outcome in outcomes) == [0, 1, 2, 3]
    (lost,) = [outcome for outcome in outcomes if outcome.wrong]
    assert lost.number == 1 and "crashed, ended by SIGSEGV" in lost.wrong[0].message
    found = Instance.from_document(json.loads(lost.wrong[0].document))
    assert found.sha256 == draw_case(0, 1).instance.sha256


@pytest.mark.parametrize("seed", range(6))
def test_shrinking_an_instance_leaves_nothing_out_that_is_needed(seed: int) -> None:
    instance = planar_graph(seed, 6, 11, 3, self_edges=True)
    small = shrink_instance(instance, has_busy_cell, 30.0)
    assert has_busy_cell(small)
    assert all(len(cell.colors) == 1 for cell in small.cells)
    assert all(len(small.joinable(edge.id)) == 1 for edge in small.edges)
    # Three live darts: three edges, or two of which one has the cell on both sides.
    self_edges = sum(edge.left == edge.right for edge in small.edges)
    assert len(small.edges) + self_edges in (3, 4) and len(small.cells) <= 4


def test_shrinking_ends_in_time() -> None:
    instance = planar_graph(0, 6, 11, 3)
    assert shrink_instance(instance, has_busy_cell, 0.0) == replace(instance, meta=None)


def test_shrinking_a_surface() -> None:
    def wrong(surface: LabelledSurface) -> bool:
        instance = decompose(surface)
        return any(len(cell.colors) == 2 for cell in instance.cells) and bool(surface.cracks)

    surface = blobs(4, 6, 3, coverage=(0.8, 1.0), cracks=2)
    assert wrong(surface)
    small = shrink_surface(surface, wrong, 30.0)
    # A crack needs two points with a color in common, and one point another color beside it.
    assert sorted(map(len, filter(None, small.vertex_colors))) in ([1, 2], [2, 2], [1, 1, 2])
    assert len(small.cracks) == 1 and wrong(small)


@pytest.mark.parametrize("path", sorted(PAPER.glob("*.surface.json")), ids=lambda path: path.stem)
def test_vertex_search_against_brute_force_on_figures(path: Path) -> None:
    surface = LabelledSurface.read(path)
    found = fewest_by_vertices(surface, 2_000)
    if found is not None:
        assert found == vertex_minimum(surface)


def test_vertex_search_against_brute_force() -> None:
    for seed in range(12):
        surface = blobs(seed, 6, 2 + seed % 2, waves=0.6, cracks=seed % 3, islands=seed % 2)
        assert fewest_by_vertices(surface, 10**6) == vertex_minimum(surface)


def test_vertex_search_gives_up() -> None:
    assert fewest_by_vertices(blobs(0, 6, 3, coverage=(1.0, 1.0)), 10) is None


def test_two_strands_too_few_are_no_disagreement(monkeypatch: pytest.MonkeyPatch) -> None:
    """With one strand these corridors cannot be had; then more are tried."""
    surface = LabelledSurface.read(PAPER / "parallel-corridors.surface.json")
    instance = decompose(surface)
    monkeypatch.setattr("cellcolor.lab.campaign.agreement._STRANDS", (1, 2))
    assert compare_on_mesh(surface, instance, 20.0) == MeshFinding(2, 2)
    monkeypatch.setattr("cellcolor.lab.campaign.agreement._STRANDS", (1,))
    with pytest.raises(Disagreement, match="has 2 segments, cp-sat finds 3 with 1 strands"):
        compare_on_mesh(surface, instance, 20.0)


@pytest.mark.parametrize("ending", ["interrupted", "not proved", "done"])
def test_exit_code_says_whether_everything_was_compared(
    ending: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def some(*_: object) -> Iterator[Outcome]:
        minimum = None if ending == "not proved" else 2
        yield Outcome(0, "hubs", 5, 4, Finding(minimum, None, None), None, (), 0.1)
        if ending == "interrupted":
            raise KeyboardInterrupt

    monkeypatch.setattr("cellcolor.cli.campaign.outcomes_of_campaign", some)
    assert main(["bench", "campaign", "--count", "9"]) == (0 if ending == "done" else 3)
    printed = capsys.readouterr()
    assert "seed 0, 1 instances" in printed.out
    assert ("interrupted" in printed.err) == (ending == "interrupted")


def test_summary_counts() -> None:
    summary = Summary()
    common = {"darts": 4, "seconds": 0.5}
    agreed = Outcome(0, "a", 5, finding=Finding(2, 3, True), mesh=None, wrong=(), **common)
    loops = Outcome(
        1, "b", 7, finding=Finding(3, None, None), mesh=MeshFinding(4, 3), wrong=(), **common
    )
    wrong = Outcome(
        2, "b", 5, finding=None, mesh=MeshFinding(2, 2), wrong=(Wrong("!", "{}"),), **common
    )
    for outcome in (agreed, loops, wrong):
        summary.add(outcome)
    total = summary.total
    assert (total.instances, total.proved, total.scheme_sets, total.always_cut) == (3, 2, 1, 1)
    assert (total.meshes, total.meshes_alike, total.disagreements) == (2, 1, 1)
    assert summary.kinds["b"].instances == 2 and total.seconds == 1.5
    histograms = summary.histograms()
    assert histograms["cells"] == [("5-6", 2), ("7-9", 1)]
    assert histograms["most live darts of a cell"] == [("3-4", 3)]
    assert histograms["fewest segments"] == [("2", 1), ("3-4", 1)]
    assert histograms["optimal schemes"] == [("3-4", 1)]
