"""Kept proofs that somebody has changed, or whose name belongs to something that is no file."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.door import oracle as door
from cellcolor.door.oracle import Oracle
from cellcolor.errors import InputError
from cellcolor.lab.families import voronoi
from cellcolor.oracle import Proof, ProvenRange
from examples import examples

ODD = (
    None,
    True,
    0,
    1,
    -1,
    2,
    10**30,
    0.5,
    1e300,
    float("nan"),
    "",
    "\ud800",
    [],
    {},
    [[]],
    [None],
)
CUT = ("truncated", "a bit", "a digit", "deep")
KINDS = ("values", "a member", "all bounds", "fewer segments", "another surface's", *CUT)


def oracle(folder: Path, seed: int = 0) -> Oracle:
    surface = voronoi(seed, "disc", 8, 6, 4)
    return Oracle(surface, time_limit=20.0, cache=folder)


def name_of(folder: Path) -> str:
    """The file's name; the folder is empty again."""
    assert oracle(folder).bounds.exact
    (file,) = folder.iterdir()
    file.unlink()
    return file.name


@contextmanager
def at_most(seconds: int) -> Iterator[None]:
    def late(*_: object) -> None:
        raise AssertionError("it waits")  # a TimeoutError would be one of the operating system

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    """The surface is proved anew, and the proof takes the pipe's place."""
    name = name_of(tmp_path)
    os.mkfifo(tmp_path / name)
    with at_most(30):
        assert oracle(tmp_path).bounds.exact
    assert (tmp_path / name).is_file()


def test_a_folder_is_named_and_nothing_is_left_behind(tmp_path: Path) -> None:
    name = name_of(tmp_path)
    (tmp_path / name).mkdir()
    with pytest.raises(InputError, match=name):
        assert oracle(tmp_path).bounds.exact
    assert [path.name for path in tmp_path.iterdir()] == [name]


@cache
def honest(seed: int) -> tuple[int, str, str]:
    """The minimum of a surface, and name and content of the file that its proof leaves."""
    with TemporaryDirectory() as name:
        kept = oracle(Path(name), seed)
        assert kept.bounds.exact
        (file,) = Path(name).iterdir()
        return kept.bounds.upper, file.name, file.read_text(encoding="utf-8")


def values(document: Any) -> list[tuple[Any, Any]]:
    """Where each value of any depth is: what holds it, and its key."""
    if not isinstance(document, (dict, list)):
        return []
    keys = list(document) if isinstance(document, dict) else range(len(document))
    return [(document, key) for key in keys] + [p for key in keys for p in values(document[key])]


def changed(kind: str, text: str, fewest: int, data: st.DataObject) -> bytes:
    """A file that says something else, mostly."""
    document = json.loads(text)
    places, raised = values(document), fewest + data.draw(st.integers(1, 3))
    holder, key = data.draw(st.sampled_from(places))
    at = data.draw(st.integers(0, len(text) - 1))
    if kind == "values":
        holder[key] = data.draw(st.sampled_from(ODD))
    elif kind == "a member":
        del holder[key]
    elif kind == "deep":
        holder[key] = "HERE"
        depth = data.draw(st.sampled_from([300, 5000, 200_000]))
        return json.dumps(document).replace('"HERE"', "[" * depth + "]" * depth).encode()
    elif kind == "truncated":
        return text[:at].encode()
    elif kind == "a digit":
        digits = [k for k, sign in enumerate(text) if sign.isdigit()]
        at = digits[at % len(digits)]
        return (text[:at] + str(data.draw(st.integers(0, 9))) + text[at + 1 :]).encode()
    elif kind == "a bit":
        content = bytearray(text.encode())
        content[at] ^= 1 << data.draw(st.integers(0, 7))
        return bytes(content)
    elif kind == "another surface's":
        return honest(1)[2].encode()
    for solution in document["solutions"] if kind == "all bounds" else ():
        solution |= {"lower_bound": raised, "surface_lower_bound": raised, "segments": raised}
        solution |= {"lift_offs": raised - 1}
        for bound in solution["bounds"]:
            bound["value"] = raised
    for solution in document["solutions"] if kind == "fewer segments" else ():
        solution |= {"segments": fewest - 1, "lift_offs": fewest - 2, "lower_bound": 0}
    return json.dumps(document).encode("utf-8", "surrogatepass")


@pytest.mark.parametrize("kind", KINDS)
@given(st.data())
@examples(8)
def test_nothing_is_believed_of_a_changed_proof(kind: str, data: st.DataObject) -> None:
    """Neither with time for a proof of its own nor with nothing but the file."""
    fewest, name, text = honest(0)
    content = changed(kind, text, fewest, data)
    with TemporaryDirectory() as folder:
        for hurried in (True, False):
            (Path(folder) / name).write_bytes(content)
            with pytest.MonkeyPatch.context() as patch:
                if hurried:
                    patch.setattr(door, "prove", lambda *_, **__: Proof(ProvenRange(1, 10**6)))
                found = oracle(Path(folder)).bounds
            assert found.lower <= fewest <= found.upper and (hurried or found.exact)
