"""Edges between equal colors are joined: what the checker refused is right then."""

from __future__ import annotations

import random

from hypothesis import given
from hypothesis import strategies as st

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.data.solution import count_segments, number_segments
from cellcolor.decomposition import decompose
from cellcolor.lab.families.registry import SMALL
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.painting import joined
from cellcolor.solvers.interface import Options
from examples import examples


@examples(60)
@given(family=st.sampled_from(sorted(SMALL)), seed=st.integers(0, 30), cuts=st.integers(0, 4))
def test_joins_that_were_taken_out_come_back(family: str, seed: int, cuts: int) -> None:
    made = SMALL[family](seed)
    instance = made if isinstance(made, Instance) else decompose(made)
    solution = solve(instance, Options())
    assert solution.cells is not None
    rng = random.Random(seed)
    darts = [dart for cell in solution.cells for sub in cell.subcells for dart in sub.darts]
    gone = set()
    for dart in rng.sample(darts, min(cuts, len(darts))):
        other = -dart if isinstance(dart, int) else (-dart[0], dart[1])
        gone |= {dart, other}
    cut = number_segments(
        [
            [
                (sub.color, kept)
                for sub in cell.subcells
                if (kept := tuple(d for d in sub.darts if d not in gone)) or len(cell.subcells) == 1
            ]
            or [(cell.subcells[0].color, ())]
            for cell in solution.cells
        ]
    )
    mended = joined(instance, cut, solution.seams)
    report = check_division(instance, mended, solution.seams)
    assert report.problems == ()
    assert count_segments(mended) <= count_segments(cut)


@examples(40)
@given(family=st.sampled_from(sorted(SMALL)), seed=st.integers(0, 10**6))
def test_cells_painted_whole_become_a_legal_division(family: str, seed: int) -> None:
    made = SMALL[family](seed % 30)
    instance = made if isinstance(made, Instance) else decompose(made)
    if instance.most_live_loops > 1:
        return
    rng = random.Random(seed)
    colors = [rng.choice(cell.colors) for cell in instance.cells]
    mended = joined(instance, number_segments([[(color, ())] for color in colors]))
    assert check_division(instance, mended).problems == ()
    assert [cell.subcells[0].color for cell in mended] == colors
