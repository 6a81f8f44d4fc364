"""What the library's stored solutions say of how their bounds were proved."""

from __future__ import annotations

from pathlib import Path

import pytest
from library import INSTANCES

from cellcolor.data.solution import Solution

STORED = sorted((INSTANCES / "solutions").glob("*.json"))


@pytest.mark.parametrize("path", STORED, ids=lambda path: path.stem)
def test_no_bound_says_model_where_none_was_built(path: Path) -> None:
    solution = Solution.read(path)
    kinds = {bound.kind for bound in solution.bounds or ()}
    if kinds & {"model", "crossings"}:
        assert solution.model is not None
        assert solution.model.variables > 0
        assert solution.model.constraints > 0
