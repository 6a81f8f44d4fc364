"""Finer meshes until minimum and graph stay the same: the meshes, the comparison, and every end."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import relabelled
from commands import json_lines, run
from shipped import shipped, wok_file

import cellcolor
from cellcolor import memory
from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.deadline import NEVER, OutOfTime
from cellcolor.decomposition.isomorphic import isomorphic, without_short_edges
from cellcolor.questions.refinement import RefinedStep, Refinement, refined_until_stable
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options

pytestmark = pytest.mark.second


@pytest.fixture(scope="module")
def refined() -> cellcolor.Result:
    """A coarse square before the arm."""
    return cellcolor.solve(shipped("square", 60), refine_until_stable=True, workers=1)


@pytest.mark.second
def test_meshes_get_finer_and_keep_their_vertices(refined: cellcolor.Result) -> None:
    assert refined.refinement is not None
    steps = refined.refinement.steps
    for before, after in pairwise(steps):
        count = len(before.surface.vertices)
        assert np.array_equal(after.surface.vertices[:count], before.surface.vertices)
        assert after.mesh_edge_m == before.mesh_edge_m / 2
        assert after.border_m == before.border_m / 4
    for step in steps[1:]:
        corners = step.surface.vertices[step.surface.faces]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        assert sides.max() <= step.mesh_edge_m
        at_borders = [
            np.linalg.norm(np.subtract(*step.surface.vertices[list(pair)]))
            for pair in step.surface.mesh.edges.tolist()
            if len({step.surface.vertex_colors[vertex] for vertex in pair}) == 2
        ]
        assert max(at_borders) <= step.border_m


def test_it_ends_as_soon_as_two_steps_have_changed_nothing(refined: cellcolor.Result) -> None:
    """Held against the solutions themselves, and graphs against a search of its own."""
    assert refined.refinement is not None
    steps = refined.refinement.steps
    same = []
    for before, after in pairwise(steps):
        graphs = [nameless(step.instance) for step in (before, after)]
        assert after.same_graph == relabelled.isomorphic(*graphs)
        assert after.same_minimum == (before.solution.segments == after.solution.segments)
        same.append(bool(after.same_minimum and after.same_but_crossings))
    assert refined.refinement.stable
    assert same[-2:] == [True, True]
    assert not any(a and b for a, b in pairwise(same[:-1]))
    assert refined.surface is not None
    assert len(refined.surface.vertices) == len(steps[-1].surface.vertices)
    assert any("evidence" in note for note in refined.solution.notes)
    assert cellcolor.check(refined.surface, refined.solution).valid


def nameless(instance: Instance) -> Instance:
    """Colors by their branches; on this part no branch has two."""
    names = tuple(name.rstrip("0123456789").rstrip() for name in instance.colors)
    assert len(set(names)) == len(names)
    return replace(instance, surface=None, colors=names)


def crossing(middle_touches: str, length: float) -> Instance:
    """Four quarters of a disc; a short edge in the middle joins two opposite ones."""
    # Cells 0 to 3 counter-clockwise, edges 1 to 4 at the rim, 5 to 8 between i and i + 1.
    edges = [Edge(i + 1, i, OUTSIDE, length=1.0) for i in range(4)]
    edges += [Edge(i + 5, i, (i + 1) % 4, length=1.0) for i in range(4)]
    loops = [[i + 1, i + 5, -((i - 1) % 4 + 5)] for i in range(4)]
    one, other = (0, 2) if middle_touches == "even" else (1, 3)
    edges.append(Edge(9, one, other, length=length))
    loops[one].insert(2, 9)
    loops[other].insert(2, -9)
    cells = tuple(Cell(i, (i,), (tuple(loops[i]),)) for i in range(4))
    return Instance("quarters", ("a", "b", "c", "d"), cells, tuple(edges))


def test_which_cells_touch_at_a_crossing_is_no_change_while_the_edge_is_short() -> None:
    even, odd = crossing("even", 0.1), crossing("odd", 0.1)
    assert not isomorphic(even, odd)
    assert isomorphic(without_short_edges(even, 0.2), without_short_edges(odd, 0.2))
    assert not isomorphic(without_short_edges(even, 0.05), without_short_edges(odd, 0.05))
    assert len(without_short_edges(even, 0.2).edges) == 8


def test_a_loop_of_short_edges_does_not_vanish() -> None:
    cell = Cell(0, (0,), ((1, 2),))
    edges = (Edge(1, 0, OUTSIDE, length=0.1), Edge(2, 0, OUTSIDE, length=0.1))
    tiny = Instance("tiny", ("a",), (cell,), edges)
    assert without_short_edges(tiny, 1.0) == tiny


def test_the_time_limit_leaves_the_steps_so_far() -> None:
    calls = []

    def solve(instance: Instance) -> Solution:
        calls.append(instance)
        if len(calls) == 2:
            raise OutOfTime("the time limit came first")
        return checked.solve(instance, Options(workers=1))

    built = cellcolor.build(shipped("square", 60))
    last, refinement = refined_until_stable(built, solve, NEVER)
    assert last is built
    assert len(refinement.steps) == 1
    assert not refinement.stable
    assert refinement.verdict == f"Not stable up to {len(built.surface.vertices):,} vertices: " + (
        "the time limit came first."
    )


def test_what_will_not_fit_is_not_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    built = cellcolor.build(shipped("square", 60))
    monkeypatch.setattr(memory, "machine_memory", lambda: 1_000_000)
    _, refinement = refined_until_stable(
        built, lambda instance: checked.solve(instance, Options(workers=1)), NEVER
    )
    assert len(refinement.steps) == 1
    assert "the machine has 0.0 GB" in refinement.ended_by


def test_a_change_begins_the_count_anew(refined: cellcolor.Result) -> None:
    assert refined.refinement is not None
    step = refined.refinement.steps[-1]
    other = replace(step, same_minimum=False)

    def stable(*steps: RefinedStep) -> bool:
        return Refinement(steps).stable

    assert stable(step, step, step)
    assert not stable(step, step)
    assert not stable(step, step, other)
    assert not stable(step, other, step)
    assert stable(step, other, step, step)


@pytest.mark.slow
def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = wok_file(tmp_path, target_vertices=50)
    out, picture = tmp_path / "wok.solution.json", tmp_path / "steps.png"
    options = ["--refine-until-stable", "--picture", picture, "-o", out, "--workers", 1, "--json"]
    code = run("solve", scene, *options)
    (document,) = json_lines(capsys.readouterr().out)
    steps = document["refinement"]["steps"]
    assert code == (0 if document["refinement"]["stable"] else 3)
    assert [step["vertices"] for step in steps] == sorted({step["vertices"] for step in steps})
    assert document["segments"] == steps[-1]["segments"]
    assert picture.read_bytes().startswith(b"\x89PNG")
    finer = tmp_path / "wok.solution.refined.json"
    assert len(json.loads(finer.read_text())["vertices"]) == steps[-1]["vertices"]
    assert run("check", finer, out) == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["wok.json", "--refine-until-stable"], "takes a whole scene"),
        (["wok.surface.json", "--refine-until-stable"], "takes a whole scene"),
        (["wok", "--refine-until-stable", "--cover", "0.9"], "of a single mesh"),
        (["wok", "--refine-until-stable", "--all"], "of a single mesh"),
        (["wok", "--refine-until-stable", "--picture", "steps.pdf"], "must end in .html"),
    ],
)
def test_bad_input(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("solve", *arguments) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert "Traceback" not in captured.err
