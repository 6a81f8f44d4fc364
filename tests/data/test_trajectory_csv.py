"""Tables of trajectories: read back as written, refused with line and column."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.data.trajectory import read_trajectory_csv
from cellcolor.errors import InputError
from examples import examples

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)


@examples(25)
@given(data=st.data())
def test_what_is_written_is_read(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Columns in any order, each with a value of its own; what is left out is None."""
    joints = [f"q{k + 1}" for k in range(data.draw(st.integers(1, 12)))]
    columns = ["contact", *joints]
    columns += ["time_s"] * data.draw(st.booleans()) + ["segment"] * data.draw(st.booleans())
    columns += ["x", "y", "z", "nx", "ny", "nz"] * data.draw(st.booleans())
    columns = data.draw(st.permutations(columns))
    rows = []
    for _ in range(data.draw(st.integers(0, 4))):
        row = {column: data.draw(NUMBERS) for column in columns}
        row["contact"] = data.draw(st.sampled_from([0, 1]))
        row["segment"] = data.draw(st.integers(-5, 5))
        rows.append({column: row[column] for column in columns})
    path = tmp_path_factory.mktemp("table") / "mine.csv"
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(
            stream, columns, lineterminator=data.draw(st.sampled_from(["\n", "\r\n"]))
        )
        writer.writeheader()
        writer.writerows(rows)
    table = read_trajectory_csv(path)

    def written(*names: str) -> list[list[float]]:
        return [[row[name] for name in names] for row in rows]

    assert table.name == "mine"
    assert table.joints.tolist() == written(*joints)
    assert table.marked("contact").tolist() == [row["contact"] == 1 for row in rows]
    for found, names in (
        (table.columns.get("time_s"), ["time_s"]),
        (table.columns.get("segment"), ["segment"]),
        (table.poses, ["x", "y", "z", "nx", "ny", "nz"]),
    ):
        if names[0] not in columns:
            assert found is None
        else:
            assert found is not None
            assert found.reshape(len(rows), len(names)).tolist() == written(*names)


BAD = {
    "nothing": ("", "line 1", "no column contact"),
    "no contact": ("q1,q2\n0,0\n", "line 1", "no column contact"),
    "no joints": ("contact\n1\n", "line 1", "no column q1"),
    "a joint missing": ("contact,q1,q3\n1,0,0\n", "line 1", "no column q2"),
    "half a pose": ("contact,q1,x,y,z\n1,0,0,0,0\n", "line 1", "no column nx"),
    "unknown column": ("contact,q1,speed\n1,0,0\n", "line 1, column 3", "'speed' is not a known"),
    "column twice": ("contact,q1,q1\n1,0,0\n", "line 1, column 3", "'q1' appears twice"),
    "too few cells": ("contact,q1\n1,0\n1\n", "line 3", "1 cells, the header has 2"),
    "text": ("contact,q1\n1,0\n1,left\n", "line 3, column q1", "is not a number: 'left'"),
    "empty cell": ("contact,q1\n1,\n", "line 2, column q1", "is not a number: ''"),
    "infinity": ("contact,q1\n1,inf\n", "line 2, column q1", "not a finite number"),
    "too large": ("contact,q1\n1,1e999\n", "line 2, column q1", "not a finite number"),
    "contact of two": ("contact,q1\n2,0\n", "line 2, column contact", "must be 0 or 1"),
    "half a segment": ("contact,segment,q1\n1,0.5,0\n", "line 2, column segment", "an integer"),
    "open quotes": ('contact,q1\n1,"0\n', "line 2", "is not CSV"),
}


@pytest.mark.parametrize(("text", "field", "message"), BAD.values(), ids=BAD.keys())
def test_refused(text: str, field: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        read_trajectory_csv(path)
    assert (refusal.value.file, refusal.value.field) == (str(path), field)
    assert message in refusal.value.message


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_trajectory_csv(tmp_path / "none.csv")
    (tmp_path / "latin.csv").write_bytes(b"contact,q1\n1,\xe9\n")
    with pytest.raises(InputError, match="not UTF-8"):
        read_trajectory_csv(tmp_path / "latin.csv")


def test_marks_and_empty_lines_that_spreadsheets_leave(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes("\ufeffcontact, q1\r\n1, 0.5\r\n\r\n".encode())
    assert np.array_equal(read_trajectory_csv(path).joints, [[0.5]])
