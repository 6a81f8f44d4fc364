"""The model: what each group of constraints is for, what it is read from, in hand and exported."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Collection
from pathlib import Path

import pytest
from exhaustive_minima import minimum, optimal_schemes
from holes import can_be_drawn, set_partitions
from hypothesis import example, given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from ortools.sat.python import cp_model
from rooms import RED, hub, petal_cells
from rooms import graph as cells_of

import cellcolor
from cellcolor.checker.division import check_division, check_solution
from cellcolor.cli import main
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families import SMALL, planar_graph
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CompleteModel
from cellcolor.solvers.cpsat.constraints import DEFINING, REDUNDANT
from cellcolor.solvers.cpsat.dart_graph import complete_graph
from cellcolor.solvers.cpsat.painting import Block, Painting
from cellcolor.solvers.cpsat.sectors import painting_of_sectors, sector_colors, sector_graph
from cellcolor.solvers.interface import Options
from examples import examples

BLUE = 1
SEEDS = st.integers(0, 10**6)
SCENES = (
    "half_pipe",
    "hemisphere_flat",
    "hemisphere_tilted",
    "square",
    "wok",
    "wok_obstacle",
)


def model_minimum(instance: Instance, groups: Collection[str] | None = None) -> int:
    """What the model says, without its hint."""
    built = CompleteModel(instance, groups=groups)
    built.model.clear_hints()
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    assert solver.solve(built.model) == cp_model.OPTIMAL
    return round(solver.objective_value)


def small(family: str, seed: int) -> Instance:
    made = SMALL[family](seed)
    return made if isinstance(made, Instance) else decompose(made)


TRIPLE = Instance.read(PAPER / "triple-junction.json")


@pytest.mark.parametrize(
    ("group", "instance", "segments"),
    [
        # In both colors, the cell in the middle would connect both red and both blue ones.
        ("one color", hub(RED, BLUE, RED, BLUE), 3),
        # Without a parent nothing needs a root.
        ("parent or root", hub(RED, BLUE), 2),
        # A parent of another color makes one segment of two colors.
        ("parent of one color", hub(RED, BLUE), 2),
        # Three cells around a corner: each could be the parent of the next.
        ("no circles", TRIPLE, 1),
    ],
)
def test_every_defining_group_is_needed(
    group: str, instance: Instance, segments: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert model_minimum(instance, ()) == model_minimum(instance) == segments
    monkeypatch.delitem(DEFINING, group)  # type: ignore[arg-type]
    assert model_minimum(instance, ()) < segments


@pytest.mark.parametrize("group", REDUNDANT)
def test_a_redundant_group_changes_no_minimum(group: str) -> None:
    """Alone, and switched off where all others are there."""
    rest = [name for name in REDUNDANT if name != group]
    for seed in range(3):
        instance = planar_graph(seed, 5, 7, 3)
        assert model_minimum(instance, [group]) == minimum(instance)
        assert model_minimum(instance, rest) == minimum(instance)
    for seed in range(3):
        instance = small("islands, holes", seed)
        assert model_minimum(instance, rest) == solve(instance, Options(), "dfs").segments


@examples(6)
@given(
    shape=st.sampled_from([(2, 2, 2), (3, 2, 2)]),
    colors=st.lists(st.integers(0, 2), min_size=8, max_size=8),
)
# Between darts 1 and 2, where the seams begin, a sub-cell is in their way to both holes.
@example(shape=(4, 2, 2), colors=[0, 0, 1, 1, 1, 1, 1, 1])
def test_seams_to_several_loops_lose_nothing(shape: tuple[int, ...], colors: list[int]) -> None:
    seams_lose_nothing(shape, colors)


def seams_lose_nothing(shape: tuple[int, ...], colors: list[int]) -> None:
    """A cell with leaf cells around it and in its holes. Each segment is a sub-cell with leaf cells
    of one color, so the fewest are those of any grouping that can be drawn."""
    first = [sum(shape[:number]) + 1 for number in range(len(shape))]
    loops = tuple(tuple(range(d, d + size)) for d, size in zip(first, shape, strict=True))
    colors = colors[: sum(shape)]
    groupings = set_partitions(range(1, sum(shape) + 1))
    fewest = min(
        len(groups)
        for groups in groupings
        if all(len({colors[dart - 1] for dart in group}) == 1 for group in groups)
        and can_be_drawn(loops, frozenset(map(frozenset, groups)))
    )
    model = CompleteModel(cells_of(((0, 1, 2), *loops), *petal_cells(*colors)))
    model.model.add(model.segments <= fewest)
    solver = cp_model.CpSolver()
    assert solver.solve(model.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)
    assert solver.objective_value == fewest


@examples(15)
@given(seed=SEEDS, groups=st.sets(st.sampled_from(sorted(REDUNDANT))))
def test_any_choice_of_redundant_groups_has_the_same_minimum(seed: int, groups: set[str]) -> None:
    instance = planar_graph(seed, 5, 8, 3, self_edges=seed % 2 == 0)
    assert model_minimum(instance, groups) == minimum(instance)


def drawn(instance: Instance, painting: Painting) -> tuple[Painting, Painting]:
    """A scheme, and what is read from its drawing on sectors."""
    graph = complete_graph(instance, dict.fromkeys(instance.live_edges, 1))
    own = [
        [Block(color, {graph.number_of[dart, 1] for dart in darts}) for color, darts in blocks]
        for blocks in painting
    ]
    sectors = sector_graph(graph)
    return own, painting_of_sectors(sectors, sector_colors(sectors, own))


def blocks_of(painting: Painting) -> list[set[tuple[int, frozenset[int]]]]:
    return [{(block.color, frozenset(block.darts)) for block in cell} for cell in painting]


@examples(40)
@given(seed=SEEDS, cells=st.integers(2, 6), colors=st.integers(2, 4))
def test_every_scheme_has_room_on_the_sectors(seed: int, cells: int, colors: int) -> None:
    """Rings are as many as needed: all optimal schemes are drawn, and read as they were.

    A zero that shows a joinable color on both sides is joined when it is read. So the sub-cells
    drawn are those of the scheme or have more darts, and there are no more of them.
    """
    instance = planar_graph(seed, cells, cells + 4, colors)
    _, schemes = optimal_schemes(instance)
    for scheme in schemes:
        painting = [sorted((c, sorted(darts)) for c, darts in cell) for cell in scheme]
        own, read = drawn(instance, painting)  # type: ignore[arg-type]
        for before, after in zip(own, read, strict=True):
            assert len(before) == len(after)
            for block in before:
                assert any(b.color == block.color and block.darts <= b.darts for b in after)


@pytest.mark.parametrize("count", [4, 6, 8, 10])
def test_one_ring_fewer_has_no_room(count: int) -> None:
    """Nested chords around a cell: as many colors as chords, each color on two opposite darts."""
    chain = [*range(count // 2), *reversed(range(count // 2))]
    instance = hub(*chain)
    graph = complete_graph(instance, dict.fromkeys(instance.live_edges, 1))
    darts = graph.lists[0]
    nested = [
        [
            Block(c, {darts[place], darts[-1 - place]})
            for place, c in enumerate(chain[: count // 2])
        ],
        *([Block(c, {graph.darts[d].twin})] for c, d in zip(chain, darts, strict=True)),
    ]
    sectors = sector_graph(graph)
    assert sectors.rings[0] == count // 4
    assert blocks_of(painting_of_sectors(sectors, sector_colors(sectors, nested))) == blocks_of(
        nested
    )
    fewer = sector_graph(graph, count // 4 - 1)
    assert blocks_of(painting_of_sectors(fewer, sector_colors(fewer, nested))) != blocks_of(nested)
    assert model_minimum(instance) == count // 2


@examples(15)
@given(seed=SEEDS)
def test_a_hint_says_everything(seed: int) -> None:
    """With its variables fixed to the hint, the model has the hinted division's segments."""
    instance = planar_graph(seed, 6, 10, 3)
    best = solve(instance, Options())
    assert best.cells is not None
    built = CompleteModel(instance)
    built.model.clear_hints()
    graph = built.sectors.graph
    built.hint(
        [
            [Block(s.color, {graph.number_of[d, 1] for d in s.darts}) for s in cell.subcells]
            for cell in best.cells  # type: ignore[misc]
        ]
    )
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.fix_variables_to_their_hinted_value = True
    assert solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)
    assert round(solver.objective_value) == best.segments


def test_a_torus_of_four_cells() -> None:
    """Euler's formula with a handle: two by two cells, each color in a band around the torus."""
    cells = (
        Cell(0, (RED,), ((1, 2, -3, -4),)),
        Cell(1, (BLUE,), ((3, 5, -1, -6),)),
        Cell(2, (RED,), ((7, 4, -8, -2),)),
        Cell(3, (BLUE,), ((8, 6, -7, -5),)),
    )
    edges = (
        Edge(1, 0, 1), Edge(2, 0, 2), Edge(3, 1, 0), Edge(4, 2, 0),
        Edge(5, 1, 3), Edge(6, 3, 1), Edge(7, 2, 3), Edge(8, 3, 2),
    )  # fmt: skip
    instance = Instance("torus", ("red", "blue"), cells, edges)
    assert model_minimum(instance) == model_minimum(instance, ()) == 2


def test_own_constraints_are_kept_and_the_result_is_checked() -> None:
    """All three cells can be red. If one has to be blue, there are two segments."""
    cells = tuple(Cell(c.id, (RED, BLUE), c.loops) for c in TRIPLE.cells)
    instance = Instance("triple", ("red", "blue"), cells, TRIPLE.edges)
    model = cellcolor.formulation(instance)
    v = model.variables
    model.model.add(v.color[model.sectors.nodes[0][-1], BLUE] == 1)
    model.model.add(v.color[model.sectors.nodes[1][-1], RED] == 1)
    solver = cp_model.CpSolver()
    with pytest.raises((InputError, RuntimeError)):
        model.division(solver)
    assert solver.solve(model.model) == cp_model.OPTIMAL
    found = model.division(solver)
    assert found.segments == 2 == round(solver.objective_value)
    assert found.lower_bound == 0 and found.status == "feasible"
    assert not check_solution(instance, found).problems
    assert found.cells is not None
    assert found.cells[0].subcells[0].color == BLUE


def test_a_wrong_group_is_named() -> None:
    with pytest.raises(InputError, match=r"groups.*'eulers'"):
        cellcolor.formulation("wok", groups=["eulers"])


BARE = """
import sys
from ortools.sat.python import cp_model
model = cp_model.CpModel()
assert model.proto.parse_text_format(open(sys.argv[1]).read())
solver = cp_model.CpSolver()
solver.parameters.num_workers = 1
status = solver.solve(model)
assert not any(name.startswith("cellcolor") for name in sys.modules)
print(solver.status_name(status), round(solver.objective_value))
"""


def exported_minimum(instance: Instance, folder: Path) -> str:
    """What bare OR-Tools says of the exported model, in a process that imports nothing else."""
    file = folder / "instance.json"
    file.write_text(instance.to_json())
    assert main(["export", str(file), "-o", str(folder / "m.pbtxt")]) == 0
    command = [sys.executable, "-c", BARE, str(folder / "m.pbtxt")]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


@pytest.mark.parametrize("name", SCENES)
def test_bare_ortools_solves_the_exported_scenes(name: str, tmp_path: Path) -> None:
    instance = Instance.read(INSTANCES / "scenes" / f"{name}.json")
    known = solve(instance, Options())
    assert known.status == "optimal"
    assert exported_minimum(instance, tmp_path) == f"OPTIMAL {known.segments}"


def test_both_forms_of_an_export_are_one_model(tmp_path: Path) -> None:
    file = INSTANCES / "scenes" / "wok.json"
    for ending in ("pb", "pbtxt", "pb", "pbtxt"):  # what was exported may be overwritten
        assert main(["export", str(file), "-o", str(tmp_path / f"m.{ending}")]) == 0
    from ortools.sat import cp_model_pb2

    binary = cp_model_pb2.CpModelProto.FromString((tmp_path / "m.pb").read_bytes())
    built = CompleteModel(Instance.read(file))
    assert len(binary.variables) == built.size.variables
    assert len(binary.constraints) == built.size.constraints
    (tmp_path / "m.pb").write_bytes(b"somebody else's")
    assert main(["export", str(file), "-o", str(tmp_path / "m.pb")]) == 2


def test_every_solution_read_is_legal() -> None:
    """Not only the best: the first that is found, without an objective."""
    for seed in range(12):
        for family in ("islands, holes", "smooth blobs"):
            instance = small(family, seed)
            built = CompleteModel(instance, groups=())
            built.model.clear_objective()
            built.model.clear_hints()
            solver = cp_model.CpSolver()
            solver.parameters.num_workers = 1
            solver.parameters.random_seed = seed
            assert solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)
            division, seams = built.read(solver)
            report = check_division(instance, division, seams)
            assert report.valid, report.problems


def test_the_numbers_of_constraints_are_those_of_the_page() -> None:
    """Each group's docstring begins with its number, in the order of the page."""
    numbers = [
        group.__doc__.split()[0] for group in {**DEFINING, **REDUNDANT}.values() if group.__doc__
    ]
    assert numbers == [f"({n})" for n in range(1, len(DEFINING) + len(REDUNDANT) + 1)]
