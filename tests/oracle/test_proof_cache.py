"""Where the name of a kept proof belongs to something that is no file."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cellcolor.door.oracle import KeepingOracle
from cellcolor.errors import InputError
from cellcolor.lab.families import voronoi


def oracle(folder: Path) -> KeepingOracle:
    return KeepingOracle(voronoi(0, "disc", 8, 6, 4), 20.0, folder)


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
