"""What is a file's name, and what is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cellcolor
from cellcolor import InputError
from cellcolor.files.writing import path_of

RESULT = cellcolor.solve("ring")
FUNCTIONS: dict[str, Any] = {
    "read": cellcolor.read,
    "build": cellcolor.build,
    "check": lambda name: cellcolor.check("ring", name),
    "save": RESULT.save,
    "plot": lambda name: RESULT.plot(name),
    "drawing": lambda name: RESULT.plot().save(name),
    "Instance": cellcolor.Instance.read,
}


def test_texts_and_paths_are_names() -> None:
    assert path_of("a/b.json") == path_of(Path("a/b.json")) == Path("a", "b.json")


@pytest.mark.parametrize(
    "name", [3, True, [], b"ring.json", "", np.zeros((3, 3)), cellcolor], ids=repr
)
@pytest.mark.parametrize("function", FUNCTIONS)
def test_anything_else_is_refused_in_one_line(function: str, name: Any) -> None:
    with pytest.raises(InputError, match=r"is not a file name$") as caught:
        FUNCTIONS[function](name)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 150
