"""Tables of runs: what is counted, against numbers worked out by hand; files that were cut off."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.instance import Instance
from cellcolor.errors import InputError
from cellcolor.lab.runs.pairs import paired
from cellcolor.lab.runs.summary import (
    contestants_of,
    median_seconds,
    par2,
    summary_of_runs,
)
from cellcolor.lab.runs.sweep import FAMILIES, families, taking_turns
from cellcolor.lab.runs.table import Row, compared, continued, disagreements, read_table

ROW = Row(
    family="f",
    seed=3,
    instance="one",
    sha256="a" * 64,
    cells=4,
    edges=3,
    colors=2,
    live_darts=2,
    live_loops=1,
    search_space="paper",
    solver="cp-sat",
    solver_version="OR-Tools 9",
    workers=None,
    limit=10.0,
    repetition=0,
    status="optimal",
    segments=2,
    lower_bound=2,
    proved_for_surface=True,
    seconds=1.0,
    cpu_seconds=2.0,
    process_seconds=3.0,
    peak_mb=100.0,
    error=None,
    cores=2,
    memory_mb=1024,
    cpu="a processor",
    python="3.11",
    cellcolor="0.1",
    load=0.5,
    date="2026-11-22T00:00:00+00:00",
    command="cellcolor bench run f",
)
OPEN = replace(ROW, status="feasible", segments=3, lower_bound=2, seconds=10.0)


def times(solver: str, *seconds: float | None, cells: Sequence[int] = ()) -> list[Row]:
    """A run on each of instances 0, 1, 2, …; None for one that proves nothing."""
    rows = []
    for number, spent in enumerate(seconds):
        row = OPEN if spent is None else replace(ROW, seconds=spent)
        size = cells[number] if cells else 4
        rows.append(replace(row, solver=solver, sha256=f"{number:064}", cells=size))
    return rows


class TestStatistics:
    def test_par2(self) -> None:
        """Two seconds, four seconds, and twice the limit of ten: 26 by three."""
        assert par2(times("x", 2.0, 4.0, None)) == pytest.approx(26 / 3)

    def test_what_is_late_does_not_count(self) -> None:
        """The limit of 10 s is kept within two seconds, until 12 s."""
        assert [replace(ROW, seconds=s).solved for s in (11.9, 12.1)] == [True, False]
        assert par2([replace(ROW, seconds=12.1)]) == 20.0

    def test_medians(self) -> None:
        assert median_seconds(times("x", 1.0, 3.0, None)) == 3.0
        assert median_seconds(times("x", 1.0, None, None)) == math.inf

    def test_contestants(self) -> None:
        rows = [*times("b", 1.0), *times("cp-sat", 1.0), replace(times("b", 1.0)[0], workers=2)]
        assert contestants_of(rows) == ["cp-sat", "b", "b@2"]


class TestAgreement:
    def test_nobody_beats_a_bound(self) -> None:
        worse = replace(ROW, solver="x", segments=4, lower_bound=1, status="feasible")
        assert disagreements([ROW, worse]) == []
        beaten = replace(ROW, solver="x", segments=3, lower_bound=3)
        (line,) = disagreements([ROW, beaten])
        assert line.startswith("f, seed 3 (paper, aaaaaaaaaaaa): cp-sat has 2 segments, x a lower")

    def test_other_instances_and_search_spaces_are_no_contradiction(self) -> None:
        other = replace(ROW, solver="x", segments=3, lower_bound=3)
        assert disagreements([ROW, replace(other, sha256="b" * 64)]) == []
        assert disagreements([ROW, replace(other, search_space="surface")]) == []

    def test_what_the_checker_refuses_is_named(self) -> None:
        none = {"segments": None, "lower_bound": None, "seconds": None}
        refused = replace(ROW, status="refused", error="no division", **none)  # type: ignore[arg-type]
        assert disagreements([ROW, refused]) == ["f, seed 3: cp-sat: no division"]

    def test_compared(self) -> None:
        assert compared(times("a", 1.0, 1.0, None) + times("b", 1.0, None, None)) == 1

    def test_a_solver_with_other_workers_is_no_other_solver(self) -> None:
        assert compared([replace(ROW, workers=1), replace(ROW, workers=2)]) == 0


class TestSummary:
    def text(self, rows: Sequence[Row]) -> str:
        return "\n".join(summary_of_runs(rows))

    def test_counts(self) -> None:
        text = self.text(times("cp-sat", 1.0, 3.0, None) + times("x", 2.0, None, None))
        assert "| Minima proved, of runs | cp-sat | x |" in text and "| f | 2/3 | 1/3 |" in text
        assert "| f | 3.0 | > 10 |" in text  # medians
        assert "| f | 8.0 | 14.0 |" in text  # 24 and 42 by three
        assert "Open: 1 instance" in text and "| f, seed 3 | 4 | 3 (cp-sat) | 2 (cp-sat) |" in text

    def test_contradictions_come_first(self) -> None:
        text = self.text([ROW, replace(ROW, solver="x", segments=3, lower_bound=3)])
        assert "**1 contradiction:**" in text.partition("##")[0]


def in_pairs(rows: Sequence[Row]) -> str:
    return "\n".join(paired(rows, "a", "b"))


class TestPairs:
    def test_what_one_alone_proves_is_held_against_a_fair_coin(self) -> None:
        """Five to none: both tails of five heads in a row are 2/32. Six scores that are all smaller
        are one end of the 2**6 choices of signs, and the other end is as rare: 2/64."""
        found = in_pairs(times("a", *[1.0] * 6) + times("b", 2.0, *[None] * 5))
        assert "| of 6 instances | a | b |" in found
        assert "| proved | 6 | 1 |" in found and "| proved by this one alone | 5 | 0 |" in found
        assert "p = 0.062 (exact McNemar test)" in found
        assert "p = 0.031 (Wilcoxon's signed-rank test)" in found
        assert "| PAR2, seconds | 1 | 17 |" in found  # (2 + 5 · 20) / 6
        assert "PAR2 of a less that of b: -16 s" in found

    def test_an_interval_holds_the_mean_and_no_more_than_the_extremes(self) -> None:
        found = in_pairs(times("a", 1.0, 2.0, 3.0, 4.0) + times("b", 2.0, 4.0, 6.0, 8.0))
        low, high = map(float, re.findall(r"less that.*interval (\S+) to ([^)]+)\)", found)[0])
        assert -4 <= low < -2.5 < high <= -1
        assert "took 0.5 times as long (geometric mean, 95 % interval 0.5 to 0.5)" in found

    def test_equal_ones_are_not_told_apart(self) -> None:
        found = in_pairs(times("a", 1.0, None) + times("b", 1.0, None))
        assert "McNemar" not in found and "Wilcoxon" not in found
        assert "PAR2 of a less that of b: 0 s (95 % interval 0 to 0)." in found

    def test_runs_of_one_instance_are_one_observation(self) -> None:
        """Proved in one of two runs is not proved, and counts (1 + 20) / 2 seconds."""
        rows = [*times("a", 1.0), replace(OPEN, solver="a", repetition=1, sha256=f"{0:064}")]
        found = in_pairs([*rows, *times("b", 3.0)])
        assert "| of 1 instance | a | b |" in found and "| proved | 0 | 1 |" in found
        assert "| PAR2, seconds | 10.5 | 3 |" in found
        assert "one instance has no interval" in found

    @pytest.mark.parametrize(
        ("rows", "message"),
        [
            (times("a", 1.0), "there are no runs of b, only of a"),
            ([*times("a", 1.0), replace(ROW, solver="b", sha256="b" * 64)], "not run on the same"),
        ],
    )
    def test_what_cannot_be_compared_is_said(self, rows: list[Row], message: str) -> None:
        with pytest.raises(InputError, match=message):
            in_pairs(rows)


ROWS = st.builds(
    Row,
    **{
        field.name: {
            "str": st.text(st.characters(exclude_categories=("Cs", "Cc", "Z")), min_size=1),
            "int": st.integers(0, 10**9),
            "float": st.floats(0, 1e6),
            "int | None": st.none() | st.integers(0, 10**9),
            "float | None": st.none() | st.floats(0, 1e6),
            "str | None": st.none() | st.just('a "quoted", line'),
            "bool | None": st.sampled_from([None, False, True]),
            "SearchSpace": st.sampled_from(["paper", "surface"]),
            "Status": st.sampled_from(["optimal", "crashed"]),
        }[str(field.type)]
        for field in fields(Row)
    },
)


class TestFile:
    @given(st.lists(ROWS, max_size=4), st.integers(0, 400))
    def test_what_is_cut_off_anywhere_is_continued(
        self, tmp_path_factory: pytest.TempPathFactory, rows: list[Row], cut: int
    ) -> None:
        path = tmp_path_factory.mktemp("table") / "t.csv"
        with continued(path) as table:
            for row in rows:
                table.append(row)
        assert read_table(path) == rows
        content = path.read_bytes()
        kept = content[: max(0, len(content) - cut)]
        path.write_bytes(kept)
        whole = max(0, kept.count(b"\n") - 1)
        with continued(path) as table:
            assert table.rows == rows[:whole]
            for row in rows[whole:]:
                table.append(row)
        assert path.read_bytes() == content

    def test_names_with_line_ends_stay_in_their_line(self, tmp_path: Path) -> None:
        path = tmp_path / "t.csv"
        with continued(path) as table:
            table.append(replace(ROW, instance="a\nb\u2028c\ud800"))
        (row,) = read_table(path)
        assert row.instance == "a b c\\ud800"

    def test_two_at_a_time(self, tmp_path: Path) -> None:
        path = tmp_path / "t.csv"
        with (
            continued(path),
            pytest.raises(InputError, match="is being written by another process"),
            continued(path),
        ):
            pass

    @pytest.mark.parametrize(
        ("before", "after", "message"),
        [
            (",optimal,", ",best,", "line 2: status: "),
            (",4,3,", ",four,3,", "line 2: cells: "),
            (",optimal,", ",", "line 2: has 31 cells, the header 32"),
            ("family,", "", "line 1: is not the header"),
        ],
    )
    def test_what_is_wrong_is_named(
        self, tmp_path: Path, before: str, after: str, message: str
    ) -> None:
        path = tmp_path / "t.csv"
        with continued(path) as table:
            table.append(ROW)
        text = path.read_text().replace(before, after, 1)
        path.write_text(text)
        for use in (lambda: read_table(path), continued(path).__enter__):
            with pytest.raises(InputError, match=message):
                use()
        assert path.read_text() == text


class TestSubjects:
    def test_names(self) -> None:
        def meant(pattern: str) -> list[str]:
            return [one.family for (one,) in families(pattern, (0,))]

        assert "medium/thin" in FAMILIES
        assert meant("medium") == meant("medium/*") == [n for n in FAMILIES if "medium" in n]
        assert meant("medium/thi?") == ["medium/thin"]
        assert meant("thin") == meant("medium/nothing") == []

    def test_turns(self) -> None:
        groups = [*families("small/hubs", (0, 1)), *families("small/graphs", (5,))]
        assert [(s.family, s.seed) for s in taking_turns(groups)] == [
            ("small/hubs", 0),
            ("small/graphs", 5),
            ("small/hubs", 1),
        ]
        made = groups[0][1].make()
        assert isinstance(made, Instance) and made.sha256 == groups[0][1].make().sha256
