"""Arrays that values hold: their shape, their kind, and that nobody can change them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cellcolor.data.value import integers, numbers, rows_of, rows_of_three, truths
from cellcolor.errors import InputError


def test_lists_and_arrays_become_copies_of_one_kind() -> None:
    given = np.array([[1, 2, 3]])
    rows = rows_of_three(given, "m")
    given[:] = 0
    assert rows.dtype == np.float64 and rows.tolist() == [[1.0, 2.0, 3.0]]
    assert rows_of([[1, 2]], 2, "m").shape == (1, 2)
    assert numbers([1, 2.5], "m").tolist() == [1.0, 2.5]
    assert integers((1, 2), "m").dtype == np.int64
    assert truths([True, False], "m").dtype == np.bool_
    for array in (rows, numbers([1.0], "m"), integers([1], "m"), truths([True], "m")):
        assert not array.flags.writeable


def test_nothing_has_the_right_shape() -> None:
    assert rows_of_three([], "m").shape == (0, 3)
    assert rows_of([], 6, "m").shape == (0, 6)
    assert len(numbers([], "m")) == len(integers([], "m")) == len(truths([], "m")) == 0


BAD: list[tuple[Any, Any, str]] = [
    (rows_of_three, [[1, 2]], "m: each entry needs 3 numbers"),
    (rows_of_three, [1, 2, 3], "m: each entry needs 3 numbers"),
    (rows_of_three, [[1, 2, 3], [1, 2]], "m: must be rows of numbers of one length"),
    (rows_of_three, [[1, 2, float("nan")]], r"m\[0\]\[2\]: is not a finite number"),
    (rows_of_three, [["a", "b", "c"]], "m: must be numbers"),
    (rows_of_three, [[True, True, True]], "m: must be numbers"),
    (numbers, [[1.0]], "m: must be one row"),
    (numbers, [0.0, float("inf")], r"m\[1\]: is not a finite number"),
    (integers, [1.0], "m: must be integers"),
    (integers, [True], "m: must be integers"),
    (truths, [1], "m: must be true or false"),
]


@pytest.mark.parametrize(("make", "content", "complaint"), BAD)
def test_anything_else_is_refused_by_name(make: Any, content: Any, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        make(content, "m")
